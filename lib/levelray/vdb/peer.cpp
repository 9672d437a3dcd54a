#include "levelray/vdb/peer.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/vdb/describe_grid.hpp"
#include "levelray/vdb/from_openvdb.hpp"
#include "levelray/vdb/to_openvdb.hpp"

#include <chrono>
#include <ctime>
#include <limits>
#include <openvdb/tools/Diagnostics.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/RayIntersector.h>

namespace levelray {

namespace {

class Timer {
 public:
  PeerTime elapsed() const {
    return {std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall_).count(),
            cpu_ms() - cpu_};
  }

 private:
  static double cpu_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
  }
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = cpu_ms();
};

openvdb::Vec3d to_vdb(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

} // namespace

struct OpenVdbLevelSet::Impl {
  openvdb::FloatGrid::Ptr grid;
};

OpenVdbLevelSet::OpenVdbLevelSet(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OpenVdbLevelSet::OpenVdbLevelSet(OpenVdbLevelSet&&) noexcept = default;
OpenVdbLevelSet& OpenVdbLevelSet::operator=(OpenVdbLevelSet&&) noexcept = default;
OpenVdbLevelSet::~OpenVdbLevelSet() = default;

OpenVdbLevelSet OpenVdbLevelSet::from_mesh(const TriangleMesh& mesh, double voxel_size,
                                           double half_width_voxels, const Vec3d& origin, PeerTime* time) {
  initialize_openvdb();
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) points.emplace_back(to_vdb(v));
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  try {
    openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(voxel_size);
    transform->postTranslate(to_vdb(origin));
    const Timer timer;
    openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
        *transform, points, triangles, static_cast<float>(half_width_voxels));
    if (time) *time = timer.elapsed();
    return OpenVdbLevelSet(std::make_unique<Impl>(Impl{grid}));
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorKind::failed, "OpenVDB cannot convert the mesh: " + printable(error.what(), 200));
  }
}

OpenVdbLevelSet OpenVdbLevelSet::from_grid(const BlockGrid& grid) {
  initialize_openvdb();
  return OpenVdbLevelSet(std::make_unique<Impl>(Impl{to_openvdb(grid)}));
}

OpenVdbLevelSet OpenVdbLevelSet::from_file(const std::string& path) {
  initialize_openvdb();
  try {
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(file.beginName().gridName()));
    if (!grid) throw Error(ErrorKind::bad_input, path + ": the first grid is not of float type");
    return OpenVdbLevelSet(std::make_unique<Impl>(Impl{grid}));
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorKind::bad_input, path + ": " + printable(error.what(), 200));
  }
}

BlockGrid OpenVdbLevelSet::to_grid() const {
  const std::string place = "OpenVDB's level set";
  std::vector<std::string> warnings;
  constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
  BlockGrid grid = from_openvdb(*impl_->grid, uniform_transform(impl_->grid->transform(), place), place,
                                no_limit, warnings);
  complete_blocks(grid, no_limit);
  return grid;
}

std::string OpenVdbLevelSet::check(int checks) const {
  return openvdb::tools::checkLevelSet(*impl_->grid, static_cast<std::size_t>(checks));
}

PeerTime OpenVdbLevelSet::trace(const std::vector<WorldRay>& rays, std::vector<PeerHit>& hits) const {
  using Intersector = openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid>;
  constexpr std::size_t tile = 1024;
  const Timer timer;
  const Intersector shared(*impl_->grid);
  parallel_for(rays.size(), tile, [&](std::size_t begin, std::size_t end) {
    const Intersector own(shared); // its stencil and accessor are mutable
    for (std::size_t i = begin; i < end; ++i) {
      const double length = rays[i].direction.length(); // OpenVDB's times are world distances
      const Intersector::RayType ray(to_vdb(rays[i].origin), to_vdb(rays[i].direction / length),
                                     std::max(rays[i].t_min * length, openvdb::math::Delta<double>::value()),
                                     std::min(rays[i].t_max * length, std::numeric_limits<double>::max()));
      openvdb::Vec3d point, normal;
      double distance = 0;
      PeerHit& hit = hits[i];
      hit.hit = own.intersectsWS(ray, point, normal, distance);
      if (!hit.hit) continue;
      hit.t = distance / length;
      hit.normal = Vec3d(normal.x(), normal.y(), normal.z());
    }
  });
  return timer.elapsed();
}

std::size_t OpenVdbLevelSet::bytes() const {
  return impl_->grid->memUsage();
}

std::size_t OpenVdbLevelSet::active_sample_count() const {
  return impl_->grid->activeVoxelCount();
}

} // namespace levelray
