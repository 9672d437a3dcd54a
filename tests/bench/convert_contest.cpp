#include "bench/convert_contest.hpp"

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/vdb/peer.hpp"
#include "support/mesh_truth.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace levelray::bench {

namespace {

// Both grids must be answers to the same question before anyone is timed.
nlohmann::json verify(const PreparedMesh& prepared, const BlockGrid& ours, const BlockGrid& theirs,
                      int resolution) {
  const test::Comparison comparison = test::compare_grids(ours, theirs, 0.01);
  const test::MeshTruth truth(prepared);
  const std::vector<char> right = test::ours_right(truth, ours, comparison.differences);
  const auto wrong = std::count(right.begin(), right.end(), 0);
  const std::uint64_t alone = comparison.in_either - comparison.in_both;
  const double share = static_cast<double>(alone) / static_cast<double>(comparison.in_either);
  fmt::print("  verified: {} active samples, {:.2g} of them in one grid only; {} differ by more than 0.01 "
             "voxel, ours right in "
             "{} of them by brute force; the others by at most {:.5f}\n",
             comparison.in_either, share, right.size(), static_cast<std::int64_t>(right.size()) - wrong,
             comparison.largest_alike);
  // OpenVDB fills the rim of the band with distances passed on from neighbours, which miss the nearest
  // triangle the more often the fewer voxels a feature has.
  if (!(share <= 1e-3 * std::max(1.0, 256.0 / resolution)))
    throw std::runtime_error("the two conversions have different bands");
  if (wrong > 0) throw std::runtime_error(fmt::format("{} of our samples are wrong", wrong));
  return {{"active_in_either", comparison.in_either},
          {"active_in_one_only", alone},
          {"different", right.size()},
          {"ours_wrong", wrong},
          {"largest_other_difference_voxels", comparison.largest_alike}};
}

} // namespace

nlohmann::json convert_contest(const TriangleMesh& mesh, const ConvertSetup& setup) {
  fmt::print("convert, N = {}, half-width {}, {} thread{}, {} repetitions\n", setup.resolution,
             setup.half_width_voxels, setup.threads, setup.threads > 1 ? "s" : "", setup.repetitions);
  ConvertOptions options;
  options.resolution = setup.resolution;
  options.half_width_voxels = setup.half_width_voxels;
  const PreparedMesh prepared = prepare_mesh(mesh);
  const BlockGrid ours = mesh_to_grid(prepared, options).grid;
  const auto convert_with_openvdb = [&](PeerTime* time) {
    return OpenVdbLevelSet::from_mesh(mesh, ours.transform.voxel_size, setup.half_width_voxels,
                                      ours.transform.origin, time);
  };
  nlohmann::json checked = verify(prepared, ours, convert_with_openvdb(nullptr).to_grid(), setup.resolution);

  std::vector<Contestant> contestants{{"levelray mesh_to_grid",
                                       [&] {
                                         const Stopwatch watch;
                                         const ConvertedGrid converted = mesh_to_grid(prepared, options);
                                         const Time time = watch.elapsed();
                                         if (converted.grid.block_count() != ours.block_count())
                                           throw std::runtime_error("a repeated conversion differs");
                                         return time;
                                       }},
                                      {"levelray prepare_mesh",
                                       [&] {
                                         const Stopwatch watch;
                                         const PreparedMesh again = prepare_mesh(mesh);
                                         const Time time = watch.elapsed();
                                         if (again.mesh.triangles.size() != prepared.mesh.triangles.size())
                                           throw std::runtime_error("a repeated preparation differs");
                                         return time;
                                       }},
                                      {"OpenVDB meshToLevelSet", [&] {
                                         PeerTime time;
                                         convert_with_openvdb(&time);
                                         return Time{time.wall_ms, time.cpu_ms};
                                       }}};
  compete(contestants, setup.repetitions);

  nlohmann::json rows = nlohmann::json::array();
  fmt::print("  {:<26}{:>32}{:>32}\n", "", "CPU ms: median (min-max)", "wall ms: median (min-max)");
  for (const Contestant& c : contestants) {
    const Spread p = cpu(c), w = wall(c);
    fmt::print("  {:<26}{:>14.1f} ({:.1f}-{:.1f}){:>14.1f} ({:.1f}-{:.1f})\n", c.name, p.median, p.min, p.max,
               w.median, w.min, w.max);
    rows.push_back(to_json(c));
  }
  const Contestant &convert = contestants[0], &prepare = contestants[1], &openvdb = contestants[2];
  const Spread alone = cpu_ratio({&openvdb}, {&convert}), whole = cpu_ratio({&openvdb}, {&convert, &prepare});
  const Spread alone_wall = wall_ratio({&openvdb}, {&convert});
  fmt::print("  OpenVDB / levelray, CPU: {:.2f} ({:.2f}-{:.2f}); with prepare_mesh {:.2f} ({:.2f}-{:.2f}); "
             "wall: {:.2f}\n\n",
             alone.median, alone.min, alone.max, whole.median, whole.min, whole.max, alone_wall.median);
  return {{"resolution", setup.resolution},
          {"half_width_voxels", setup.half_width_voxels},
          {"threads", setup.threads},
          {"voxel_size", ours.transform.voxel_size},
          {"triangles", mesh.triangles.size()},
          {"verified", checked},
          {"contestants", rows},
          {"cpu_ratio", to_json(alone)},
          {"cpu_ratio_with_prepare", to_json(whole)},
          {"wall_ratio", to_json(alone_wall)}};
}

} // namespace levelray::bench
