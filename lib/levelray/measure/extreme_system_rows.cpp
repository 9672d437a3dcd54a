// Machines of the suite `extremes`: threads, batches, instruction sets, and what a host does to arithmetic.
#include "levelray/convert/distance_kernel.hpp"
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/core/rounding_mode.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/measure/ray_trial.hpp"
#include "levelray/trace/certified_hit.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <thread>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace levelray {

namespace {

using Bits = std::vector<std::uint64_t>;

void append(Bits& bits, double x) {
  bits.push_back(std::bit_cast<std::uint64_t>(x));
}

// All that tracing says of some rays, `batch` of them at a time.
Bits traced(const LevelSet& level_set, const std::vector<WorldRay>& rays, std::string_view intersector,
            std::size_t batch) {
  std::vector<Hit> hits(rays.size());
  std::vector<CertifiedHit> proven(rays.size());
  parallel_for(rays.size(), batch, [&](std::size_t begin, std::size_t end) {
    closest_hits(level_set, {&rays[begin], end - begin}, intersector, {&hits[begin], end - begin});
    if (intersector == Exact::name)
      for (std::size_t i = begin; i < end; ++i) proven[i] = certify(level_set, rays[i], hits[i]);
  });
  Bits bits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    bits.push_back(static_cast<std::uint64_t>(hits[i].status) |
                   static_cast<std::uint64_t>(hits[i].from_inside) << 8 |
                   static_cast<std::uint64_t>(proven[i].proof) << 16);
    for (const double x : {hits[i].t, hits[i].t_outside, proven[i].t_lo, proven[i].t_hi, proven[i].error})
      append(bits, x);
  }
  return bits;
}

Bits samples(const BlockGrid& grid) {
  Bits bits(grid.node_table.begin(), grid.node_table.end());
  for (const float v : grid.values) bits.push_back(std::bit_cast<std::uint32_t>(v));
  bits.insert(bits.end(), grid.active.begin(), grid.active.end());
  bits.insert(bits.end(), grid.cells.begin(), grid.cells.end());
  return bits;
}

// Two tori through each other.
PreparedMesh some_mesh() {
  TriangleMesh other = turned_faces(torus_mesh(24, 16), 1); // mirrored next
  for (Vec3d& v : other.vertices) v = Vec3d(v.x + 0.9, v.z, v.y) * 0.7;
  return prepare_mesh(joined_meshes(torus_mesh(24, 16), other));
}

Bits converted(const PreparedMesh& mesh) {
  ConvertOptions options;
  options.resolution = 40;
  return samples(mesh_to_grid(mesh, options).grid);
}

std::vector<WorldRay> some_rays(RayTrial& trial, int count) {
  std::vector<WorldRay> rays;
  for (int i = 0; i < count; ++i) {
    rays.push_back(trial.random_ray());
    if (i % 4 == 0) rays.back().origin = trial.random_place();
    if (i % 5 == 0) rays.back().direction = Vec3d(i % 2 ? 1 : 0, -1, i % 3 ? 1 : 0);
  }
  return rays;
}

ExtremeOutcome threads(const ExtremeSettings& settings) {
  ExtremeTally tally;
  const PreparedMesh mesh = some_mesh();
  Bits mesh_bits;
  std::vector<Bits> first;
  const std::vector<NamedGrid> grids = study_grids();
  for (const int count : {1, 2, 3, 4, 7, 8, 16, 32, 64}) {
    const ThreadLimit limit(count);
    const auto text = [&](const std::string& what) {
      return [=] { return what + fmt::format(" differs with {} threads", count); };
    };
    const Bits bits = converted(mesh);
    if (count == 1) mesh_bits = bits;
    tally.add();
    tally.check(bits == mesh_bits, text("a mesh's conversion"));
    for (std::size_t g = 0; g < grids.size(); ++g) {
      RayTrial trial(grids[g].grid, grids[g].name, settings, tally, 1, 0);
      const Bits hits = traced(trial.level_set(), some_rays(trial, 600), settings.intersector, 37);
      if (count == 1) first.push_back(hits);
      tally.add();
      tally.check(hits == first[g], text("tracing the " + grids[g].name));
    }
    tally.add();
    tally.check(samples(study_grids()[3].grid) == samples(grids[3].grid), text("sampling the gyroid"));
  }
  return tally.outcome();
}

ExtremeOutcome batches(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally, 1, 0);
    const std::vector<WorldRay> rays = some_rays(trial, 500);
    for (const std::string& intersector : method_names<Intersectors>()) {
      const Bits alone = traced(trial.level_set(), rays, intersector, 1);
      for (const std::size_t size : {2u, 4u, 8u, 16u, 31u, 32u, 33u, 500u}) {
        tally.add();
        tally.check(traced(trial.level_set(), rays, intersector, size) == alone, [&] {
          return fmt::format("{}: {} differs in batches of {}", each.name, intersector, size);
        });
      }
    }
  }
  return tally.outcome();
}

ExtremeOutcome instruction_sets(const ExtremeSettings&) {
  ExtremeTally tally;
  const PreparedMesh mesh = some_mesh();
  const std::vector<std::string> targets = distance_kernel_targets();
  const Bits best = converted(mesh);
  for (const std::string& target : targets) {
    use_distance_kernel_target(target);
    tally.add();
    tally.check(distance_kernel_target() == target, [&] { return target + " was not chosen"; });
    tally.check(converted(mesh) == best, [&] { return "a mesh's conversion differs with " + target; });
  }
  use_distance_kernel_target("");
  return tally.outcome();
}

// The host's control word for SSE while it lives: flush-to-zero and denormals-are-zero.
class FlushToZero {
 public:
#ifdef __SSE2__
  FlushToZero() : old_(_mm_getcsr()) {
    _mm_setcsr(old_ | 0x8040u);
  }
  ~FlushToZero() {
    _mm_setcsr(old_);
  }
  static constexpr bool is_there = true;
#else
  FlushToZero() = default;
  static constexpr bool is_there = false;
#endif
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  unsigned old_ = 0;
};

ExtremeOutcome flush_to_zero(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    const std::vector<WorldRay> rays = some_rays(trial, 1500);
    for (const std::string& intersector : method_names<Intersectors>()) {
      const Bits with = traced(trial.level_set(), rays, intersector, 1500);
      const FlushToZero flush;
      tally.add();
      tally.check(traced(trial.level_set(), rays, intersector, 1500) == with,
                  [&] { return each.name + ": " + intersector + " differs where denormals are flushed"; });
    }
  }
  const PreparedMesh mesh = some_mesh();
  const Bits with = converted(mesh);
  const FlushToZero flush;
  tally.add();
  tally.check(converted(mesh) == with,
              [] { return std::string("a mesh's conversion differs where denormals are flushed"); });
  return tally.outcome();
}

// Denormal samples are 0 to such a host, so only sanity is asked for there.
ExtremeOutcome flushed_samples(const ExtremeSettings& settings) {
  ExtremeTally tally;
  const BlockGrid grid = grid_of_samples(
      Vec3i(-4, -4, -4), Vec3i(9, 9, 9),
      [](int i, int j, int k) { return static_cast<float>((i * 7 + j * 5 + k * 3) % 11 - 5) * 0x1p-140f; },
      1);
  RayTrial trial(grid, "denormal samples", settings, tally, 1, 0);
  const std::vector<WorldRay> rays = some_rays(trial, 1500);
  const FlushToZero flush;
  for (const WorldRay& ray : rays)
    for (const std::string& intersector : method_names<Intersectors>()) {
      const Hit hit = closest_hit(trial.level_set(), ray, intersector);
      tally.add();
      tally.check(any_hit(trial.level_set(), ray, intersector) == bool(hit) &&
                      (!hit || (hit.t >= ray.t_min && hit.t <= ray.t_max)),
                  [&] {
                    return trial.describe(ray) + ": " + intersector +
                           fmt::format(" hits at {:a} where denormals are flushed, any_hit disagreeing or "
                                       "beyond the interval",
                                       hit.t);
                  });
    }
  return tally.outcome();
}

// Hits, by twice the rounding, and what is proven of them.
ExtremeOutcome rounding_modes(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    for (const NamedGrid& each : study_grids()) {
      RayTrial trial(each.grid, fmt::format("{}, rounding mode {:#x}", each.name, mode), settings, tally, 2);
      const RoundingMode rounding(mode);
      trial.judge_all_kinds(60);
    }
  return tally.outcome();
}

// One thread changes a grid and builds a level set of it, again and again; others trace another.
ExtremeOutcome edit_and_trace(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally, 1, 0);
    const std::vector<WorldRay> rays = some_rays(trial, 400);
    const Bits quiet = traced(trial.level_set(), rays, settings.intersector, 64);
    BlockGrid edited = each.grid;
    std::atomic<bool> done{false};
    std::atomic<int> edits{0};
    std::thread editor([&] {
      while (!done) {
        for (float& value : edited.values) value = -value;
        update_cell_masks(edited);
        const LevelSet level_set(edited);
        closest_hit(level_set, rays[static_cast<std::size_t>(edits) % rays.size()]);
        ++edits;
      }
    });
    // Until both have had their turns.
    for (int round = 0; round < 8 || edits < 8; ++round) {
      tally.add();
      tally.check(traced(trial.level_set(), rays, settings.intersector, 64) == quiet,
                  [&] { return each.name + ": tracing differs while another grid is edited"; });
    }
    done = true;
    editor.join();
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_system_rows() {
  return {
      {"system", "threads", "1 to 64 threads: the same bits of conversion, sampling, hits and certificates.",
       threads},
      {"system", "batches", "Rays alone, and in batches of 2 to 500: the same bits, by every intersector.",
       batches},
      {"system", "instruction-sets",
       "Every instruction set that there is code for and the processor has, down to the scalar one: the same "
       "bits of conversion.",
       instruction_sets},
      {"system", "flush-to-zero",
       "A host that flushes denormals (FTZ, DAZ): the same bits of hits, certificates and conversion.",
       flush_to_zero},
      {"system", "flushed-samples",
       "Denormal samples under FTZ and DAZ, which are 0 to such a host: no NaN, nothing beyond the interval, "
       "any hit where there is a closest.",
       flushed_samples},
      {"system", "rounding-modes",
       "Hosts that round up, down or to zero: right hits, by twice the documented rounding.", rounding_modes},
      {"system", "edit-and-trace", "Tracing while another level set is edited and built: the same bits.",
       edit_and_trace},
  };
}

} // namespace levelray
