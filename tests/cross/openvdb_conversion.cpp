// Our conversion against OpenVDB's meshToLevelSet on every closed mesh of the test data. The two differ, for
// known reasons; each sample where they do must be right by brute force, and is counted under its cause.
//
// LEVELRAY_CROSS_RESOLUTION sets the voxels along the longest side (default 96).
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/vdb/peer.hpp"
#include "support/catch.hpp"
#include "support/mesh_truth.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <openvdb/tools/MeshToVolume.h>

using namespace levelray;
using namespace levelray::test;

namespace {

// What OpenVDB did to a sample, where ours is right.
enum Cause {
  filled_void,    // its flood of the outside does not get into a closed-off void: inside, walls removed
  closed_gap,     // nor through gaps where no sample is more than 0.75 voxel from the surface
  negative_space, // inside of a shell that is inside out, or where such overlap: winding number < 0
  overlap,        // where shells overlap, or one lies in another's inside: inner surfaces are removed
  renormalised,   // not so without its last step, which makes gradients unit where nearest points meet
  other_side,     // sign wrong beside the surface
  farther,        // larger than the distance: not passed the nearest triangle by its neighbours
  left_out,       // within the band, but not passed anything
  nearer,         // smaller than the distance, by nothing of the above: never seen
  cause_count
};
constexpr std::array<const char*, cause_count> cause_names{"void", "gap",     "negative", "overlap", "renorm",
                                                           "side", "farther", "left out", "nearer"};

// OpenVDB's conversion without renormalisation.
openvdb::FloatGrid::Ptr plain_openvdb(const TriangleMesh& mesh, const GridTransform& transform,
                                      double half_width_voxels) {
  std::vector<openvdb::Vec3s> points; // in voxels
  for (const Vec3d& v : mesh.vertices) {
    const Vec3d p = transform.to_voxel(v);
    points.emplace_back(openvdb::Vec3d(p.x, p.y, p.z));
  }
  std::vector<openvdb::Vec3I> triangles;
  for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(points, triangles);
  const float width = static_cast<float>(half_width_voxels);
  return openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      adapter, *openvdb::math::Transform::createLinearTransform(transform.voxel_size), width, width,
      openvdb::tools::DISABLE_RENORMALIZATION);
}

// Which outside samples of a grid can be reached from beyond it through outside samples at least `clearance`
// from the surface, by steps along the axes.
class Reached {
 public:
  Reached(const BlockGrid& grid, double clearance)
      : low_(grid.node_min * node_dim - Vec3i(1)), size_(grid.node_dims * node_dim + Vec3i(2)),
        reached_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                 static_cast<std::size_t>(size_.z)) {
    std::vector<Vec3i> front{low_}; // beyond the node table: outside
    reached_[index(low_)] = 1;
    while (!front.empty()) {
      const Vec3i s = front.back();
      front.pop_back();
      for (int a = 0; a < 3; ++a)
        for (const int step : {-1, 1}) {
          Vec3i n = s;
          n[a] += step;
          if (!holds(n) || reached_[index(n)]) continue;
          const float value = grid.value(n.x, n.y, n.z);
          if (std::signbit(value) || static_cast<double>(value) < clearance) continue;
          reached_[index(n)] = 1;
          front.push_back(n);
        }
    }
  }

  bool at(const Vec3i& s) const { return !holds(s) || reached_[index(s)]; }
  // Whether the sample or one of its 26 neighbours is reached.
  bool near(const Vec3i& s) const {
    for (int n = 0; n < 27; ++n)
      if (at(s + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1))) return true;
    return false;
  }

 private:
  bool holds(const Vec3i& s) const {
    const Vec3i p = s - low_;
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_.x && p.y < size_.y && p.z < size_.z;
  }
  std::size_t index(const Vec3i& s) const {
    const Vec3i p = s - low_;
    return static_cast<std::size_t>(p.x) +
           static_cast<std::size_t>(size_.x) *
               (static_cast<std::size_t>(p.y) +
                static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(p.z));
  }
  Vec3i low_, size_;
  std::vector<char> reached_;
};

class Causes {
 public:
  Causes(const MeshTruth& truth, const BlockGrid& ours, const BlockGrid& theirs,
         const openvdb::FloatGrid& plain)
      : truth_(truth), ours_(ours), theirs_(theirs), plain_(plain), outside_(ours, 0),
        wide_outside_(ours, 0.75 * ours.transform.voxel_size) {}

  Cause operator()(const Difference& d) const {
    const bool in = std::signbit(d.ours), their_in = std::signbit(d.theirs);
    const Vec3d p = ours_.transform.to_world(Vec3d(d.sample));
    const float before = plain_.tree().getValue(openvdb::Coord(d.sample.x, d.sample.y, d.sample.z));
    if (std::fabs(before - d.ours) <= 0.01 * ours_.transform.voxel_size) return renormalised;
    if (!in && their_in) return outside_cause(d.sample, p);
    if (in && !their_in) return truth_.winding(p) > 1.5 ? overlap : other_side;
    if (std::fabs(d.theirs) < std::fabs(d.ours)) // was that so before the last step?
      return std::signbit(before) == in && std::fabs(before) < std::fabs(d.ours) ? nearer : renormalised;
    // The same side and OpenVDB's value is larger: is the nearest surface one that it took away?
    const MeshPoint nearest = truth_.nearest(p);
    const Triangle& t = truth_.mesh().triangles[nearest.triangle];
    const auto& v = truth_.mesh().vertices;
    Vec3d n = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
    if (n.length() > 0) {
      n *= 1e-4 * ours_.transform.voxel_size / n.length();
      if (truth_.winding(nearest.point + n) > 0.5 && truth_.winding(nearest.point - n) > 0.5) return overlap;
    }
    if (in) {
      // The wall of something outside that OpenVDB counts as inside.
      const int reach = static_cast<int>(std::ceil(ours_.half_width_voxels()));
      Vec3i nearest_filled;
      int least = std::numeric_limits<int>::max();
      for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
          for (int x = -reach; x <= reach; ++x) {
            const Vec3i s = d.sample + Vec3i(x, y, z);
            if (x * x + y * y + z * z >= least || std::signbit(ours_.value(s.x, s.y, s.z)) ||
                !std::signbit(theirs_.value(s.x, s.y, s.z)))
              continue;
            least = x * x + y * y + z * z;
            nearest_filled = s;
          }
      if (least != std::numeric_limits<int>::max()) {
        const Cause cause = outside_cause(nearest_filled, ours_.transform.to_world(Vec3d(nearest_filled)));
        if (cause != other_side) return cause;
      }
    }
    return d.theirs_active ? farther : left_out;
  }

 private:
  // Why OpenVDB takes a sample for inside that is outside.
  Cause outside_cause(const Vec3i& s, const Vec3d& p) const {
    if (truth_.winding(p) < -0.5) return negative_space;
    if (!outside_.at(s)) return filled_void;
    if (!wide_outside_.near(s)) return closed_gap;
    return other_side;
  }

  const MeshTruth& truth_;
  const BlockGrid &ours_, &theirs_;
  const openvdb::FloatGrid& plain_;
  Reached outside_, wide_outside_;
};

int resolution() {
  const char* text = std::getenv("LEVELRAY_CROSS_RESOLUTION");
  return text ? std::atoi(text) : 96;
}

std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& testdata) {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"classic", "hard"})
    for (const auto& entry : std::filesystem::directory_iterator(testdata / folder)) {
      std::string extension = entry.path().extension().string();
      std::transform(extension.begin(), extension.end(), extension.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".off")
        files.push_back(entry.path());
    }
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace

TEST_CASE("where OpenVDB's conversion differs by more than 0.01 voxel, ours is right by brute force") {
  const std::filesystem::path testdata = LEVELRAY_TESTDATA;
  if (!std::filesystem::is_directory(testdata)) {
    WARN("not tested: no test data at " << testdata.string());
    return;
  }
  std::string table = fmt::format("{:<36}{:>9}{:>8}", "samples that differ, by cause", "active", "differ");
  for (const char* name : cause_names) table += fmt::format("{:>9}", name);
  table += "  side: farthest from the surface, in voxels\n";
  std::string skipped;
  int compared = 0;
  for (const std::filesystem::path& path : mesh_files(testdata)) {
    const std::string name = path.filename().string();
    CAPTURE(name);
    const MeshFile file = read_mesh(path.string());
    const PreparedMesh mesh = prepare_mesh(file.mesh);
    if (!mesh.report.closed) continue;

    ConvertOptions options;
    options.resolution = resolution();
    BlockGrid ours;
    try {
      ours = mesh_to_grid(mesh, options).grid;
    } catch (const Error& error) {
      // Closed, yet without an inside, such as two copies of each face back to back: nothing to compare.
      CHECK(error.kind() == ErrorKind::bad_input);
      skipped += fmt::format("{}: {}\n", name, error.what());
      continue;
    }
    const BlockGrid theirs = OpenVdbLevelSet::from_mesh(file.mesh, ours.transform.voxel_size,
                                                        options.half_width_voxels, ours.transform.origin)
                                 .to_grid();
    const Comparison comparison = compare_grids(ours, theirs, 0.01);
    const std::vector<Difference>& differences = comparison.differences;
    const MeshTruth truth(mesh);
    const std::vector<char> right = ours_right(truth, ours, differences);
    std::size_t unexplained = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
      if (right[i]) continue;
      const Difference& d = differences[i];
      const Vec3d p = ours.transform.to_world(Vec3d(d.sample));
      if (unexplained++ < 3)
        WARN(fmt::format("{}: sample ({},{},{}): ours {}, OpenVDB's {}, brute force {}, winding number {}",
                         name, d.sample.x, d.sample.y, d.sample.z, d.ours / ours.transform.voxel_size,
                         d.theirs / ours.transform.voxel_size,
                         std::sqrt(truth.nearest(p).distance_squared) / ours.transform.voxel_size,
                         truth.winding(p)));
    }
    CHECK(unexplained == 0);

    // Windings by crossings, as used above, are those by solid angles, whose error is a few ulp per triangle
    // (winding_number.hpp); samples on the surface have a half there.
    for (std::size_t i = 0; i < differences.size(); i += differences.size() / 20 + 1) {
      const Vec3d p = ours.transform.to_world(Vec3d(differences[i].sample));
      if (std::fabs(differences[i].ours) > 1e-3 * ours.transform.voxel_size)
        CHECK(winding_number(mesh.mesh, p) == Approx(truth.winding(p)).margin(1e-6));
    }

    std::array<std::size_t, cause_count> counts{};
    const openvdb::FloatGrid::Ptr plain = plain_openvdb(file.mesh, ours.transform, options.half_width_voxels);
    const Causes causes(truth, ours, theirs, *plain);
    std::vector<char> cause(differences.size());
    parallel_for(differences.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) cause[i] = static_cast<char>(causes(differences[i]));
    });
    double farthest_side = 0;
    for (std::size_t i = 0; i < cause.size(); ++i) {
      ++counts[static_cast<std::size_t>(cause[i])];
      if (cause[i] == other_side)
        farthest_side = std::max(farthest_side, std::fabs(differences[i].ours) / ours.transform.voxel_size);
    }
    table += fmt::format("{:<36}{:>9}{:>8}", name, comparison.in_either, differences.size());
    CHECK(counts[nearer] == 0);
    for (const std::size_t n : counts) table += fmt::format("{:>9}", n);
    table += fmt::format("  {:.2f}\n", farthest_side);
    ++compared;
  }
  // To standard output, since Catch would break the lines.
  fmt::print("{}{} closed meshes at {} voxels\n", table, compared, resolution());
  if (!skipped.empty()) fmt::print("closed, but without an inside:\n{}", skipped);
  CHECK(compared >= 20);
}
