// A mesh to a level set to a ray's hit and back from a file, all through an installed levelray.
#include <levelray/convert/mesh_to_grid.hpp>
#include <levelray/io/mesh_reader.hpp>
#include <levelray/trace/level_set.hpp>
#include <levelray/vdb/vdb_file.hpp>

#include <cmath>
#include <cstdio>
#include <string>

// Usage: consumer FOLDER    writes FOLDER/cube.vdb
int main(int count, char** arguments) {
  using namespace levelray;
  const std::string path = std::string(count == 2 ? arguments[1] : ".") + "/cube.vdb";
  const std::string cube = "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                           "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

  ConvertOptions options;
  options.voxel_size = 0.0625;
  const MeshFile file = parse_mesh(cube.data(), cube.size(), "cube.off");
  const ConvertedGrid converted = mesh_to_grid(prepare_mesh(file.mesh), options);
  write_vdb(path, converted.grid);
  const VdbFile read = read_vdb(path);

  // Samples lie on the cube's faces, so the field is linear where the ray passes and the hit exact to
  // rounding.
  WorldRay ray;
  ray.origin = Vec3d(0.5, 0.5, -2);
  const Hit hit = closest_hit(LevelSet(read.grid), ray);
  const bool good = hit && std::fabs(hit.t - 2) < 1e-6;
  std::printf("consumer: %llu samples, t = %.9g, %s\n",
              static_cast<unsigned long long>(read.grid.active_sample_count()), hit.t,
              good ? "good" : "wrong");
  return good ? 0 : 1;
}
