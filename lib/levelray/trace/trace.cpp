#include "levelray/trace/trace.hpp"

#include "levelray/accel/cell_walk.hpp"
#include "levelray/accel/occluder_walk.hpp"
#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/trace/field_probe.hpp"
#include "levelray/trace/grid_cell.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/trace/starting_side.hpp"

#include <cassert>

namespace levelray {

namespace {

template <class Work>
void for_intersector(std::string_view name, Work&& work) {
  if (visit_method<Intersectors>(canonical_intersector(name), work)) return;
  std::string names;
  for (const std::string& known : method_names<Intersectors>()) names += (names.empty() ? "" : ", ") + known;
  throw Error(ErrorKind::usage,
              "unknown intersector '" + std::string(name) + "'; legal are " + names + " and false-position");
}

} // namespace

namespace {

// In batches: frames do not depend on each other, so what computing one has to wait for is filled with
// others. work(i, frame, entered) for every ray i; it meets nothing unless it entered.
template <class Walk, class Work>
void for_each_frame(const LevelSet& level_set, std::span<const WorldRay> rays,
                    std::span<const RayBounds> bounds, Work&& work) {
  constexpr std::size_t batch = 32;
  RayFrame frames[batch];
  bool entered[batch];
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      entered[i] = enter_box(level_set.surface(), level_set.grid().transform, rays[first + i], frames[i]);
    if (!bounds.empty())
      for (std::size_t i = 0; i < count; ++i)
        entered[i] = entered[i] &&
                     narrow_frame(level_set.surface(), frames[i], static_cast<double>(bounds[first + i].near),
                                  static_cast<double>(bounds[first + i].far));
    Walk::prepare(level_set.surface(), {frames, count}, {entered, count});
    for (std::size_t i = 0; i < count; ++i) work(first + i, frames[i], entered[i]);
  }
}

struct LeapWalk {
  static constexpr bool steps_plainly = false;
  static void prepare(const SurfaceBlocks& surface, std::span<RayFrame> frames, std::span<bool> entered) {
    skip_empty_nodes(surface, frames, entered);
  }
  template <class Visit>
  static bool walk(const SurfaceBlocks& surface, const RayFrame& frame, WalkCounts& counts, Visit&& visit) {
    return walk_cells(surface, frame, counts, visit);
  }
};

struct PlainWalk {
  static constexpr bool steps_plainly = true;
  static void prepare(const SurfaceBlocks& surface, std::span<RayFrame> frames, std::span<bool> entered) {
    for (std::size_t i = 0; i < frames.size(); ++i)
      entered[i] = entered[i] && narrow_frame_to_blocks(surface, frames[i]);
  }
  template <class Visit>
  static bool walk(const SurfaceBlocks& surface, const RayFrame& frame, WalkCounts& counts, Visit&& visit) {
    return walk_cells_plainly(surface, frame, counts, visit);
  }
};

// The time of the frame's end may be rounded up beyond the interval's, and so may that of a place before its
// beginning.
Hit within(const WorldRay& ray, Hit hit) {
  hit.t = std::min(hit.t, ray.t_max);
  hit.t_outside = std::min(std::max(hit.t_outside, ray.t_min), ray.t_max);
  return hit;
}

// Where cells began in which nothing was found, the last of them. A ray that passes a zero sample by less
// than rounding finds nothing there either, so f is looked at before another ray begins at such a place.
class PassedCells {
 public:
  void add(double in) { in_[count_++ % size] = in; }

  // The last s where f is safely on that side; else the frame's beginning, or, where that is the box's hull,
  // a voxel before it.
  double outside(const LevelSet& level_set, const RayFrame& frame, double side) const {
    for (unsigned k = 1; k <= size && k <= count_; ++k) {
      const double s = in_[(count_ - k) % size];
      if (lies_on_side(level_set.grid(), place(level_set, frame, s), side)) return s;
    }
    return frame.from_outside && !lies_on_side(level_set.grid(), place(level_set, frame, 0), side) ? -1 : 0;
  }

 private:
  static constexpr unsigned size = 4;

  static Vec3d place(const LevelSet& level_set, const RayFrame& frame, double s) {
    const SurfaceBlocks& surface = level_set.surface();
    Vec3d voxel;
    for (int a = 0; a < 3; ++a) {
      const double x = frame.origin[a] + s * frame.direction[a];
      voxel[a] = node_dim * double(surface.node_min()[a]) +
                 (frame.octant >> a & 1 ? node_dim * double(surface.node_dims()[a]) - x : x);
    }
    return level_set.grid().transform.to_world(voxel);
  }

  double in_[size];
  unsigned count_ = 0;
};

RayCounts ray_counts(const WalkCounts& walked, int interpolations) {
  return {walked.steps(), walked.cells, static_cast<std::uint32_t>(interpolations), 8 * walked.cells};
}

template <class Intersector, class Walk>
[[gnu::noinline]] Hit trace_frame(const LevelSet& level_set, const RayFrame& frame) {
  Hit hit;
  StartingSide side(frame);
  WalkCounts walked;
  int interpolations = side.interpolations();
  PassedCells passed;
  Walk::walk(level_set.surface(), frame, walked, [&](const VisitedCell& cell) {
    CellRoot root;
    if (!Intersector::find(cell.segment, side.at_first(cell.segment), root,
                           [&](int n) { interpolations += n; })) {
      passed.add(cell.in);
      return false;
    }
    hit.status = HitStatus::hit;
    hit.t = frame.t(cell.in + root.at * (cell.out - cell.in));
    hit.t_outside =
        frame.t(root.outside >= 0 ? cell.in + root.outside * (cell.out - cell.in)
                                  : passed.outside(level_set, frame, side.at_first(cell.segment)));
    hit.cell = grid_cell(level_set.surface(), frame, cell.position);
    return true;
  });
  hit.from_inside = hit && side.inside();
  hit.counts = ray_counts(walked, walked.cells ? interpolations : 0);
  return hit;
}

// walk(counts, visit) shows the ray's cells.
template <class Intersector, class Walk>
[[gnu::always_inline]] inline bool any_in_walk(const RayFrame& frame, RayCounts& counts, Walk&& walk) {
  StartingSide side(frame);
  WalkCounts walked;
  int interpolations = side.interpolations();
  const bool hit = walk(walked, [&](const VisitedCell& cell) {
    return Intersector::exists(cell.segment, side.at_first(cell.segment),
                               [&](int n) { interpolations += n; });
  });
  counts = ray_counts(walked, walked.cells ? interpolations : 0);
  return hit;
}

template <class Intersector, class Walk>
[[gnu::noinline]] bool any_in_frame(const LevelSet& level_set, const RayFrame& frame, RayCounts& counts) {
  return any_in_walk<Intersector>(frame, counts, [&](WalkCounts& walked, auto&& visit) {
    return Walk::walk(level_set.surface(), frame, walked, visit);
  });
}

template <class Work>
void for_traversal(Traversal traversal, Work&& work) {
  if (traversal == Traversal::plain)
    work(PlainWalk());
  else
    work(LeapWalk());
}

} // namespace

const std::vector<std::string>& traversal_names() {
  static const std::vector<std::string> names{"leaps", "plain"};
  return names;
}

const std::vector<std::string>& shadow_scheme_names() {
  static const std::vector<std::string> names{"plain", "occluder", "boxes"};
  return names;
}

template <class Intersector>
Hit trace_closest(const LevelSet& level_set, const WorldRay& ray) {
  RayFrame frame;
  return enter_box(level_set.surface(), level_set.grid().transform, ray, frame)
             ? within(ray, trace_frame<Intersector, LeapWalk>(level_set, frame))
             : Hit{};
}

template <class Intersector>
bool trace_any(const LevelSet& level_set, const WorldRay& ray, RayCounts& counts) {
  RayFrame frame;
  if (!enter_box(level_set.surface(), level_set.grid().transform, ray, frame)) return false;
  RayCounts own;
  const bool hit = any_in_frame<Intersector, LeapWalk>(level_set, frame, own);
  counts += own;
  return hit;
}

void closest_hits(const LevelSet& level_set, std::span<const WorldRay> rays, const PrimaryOptions& options,
                  std::span<Hit> hits) {
  assert(rays.size() == hits.size() && (options.bounds.empty() || options.bounds.size() == rays.size()));
  for_intersector(options.intersector, [&]<class Intersector>(Intersector) {
    for_traversal(options.traversal, [&]<class Walk>(Walk) {
      for_each_frame<Walk>(level_set, rays, options.bounds,
                           [&](std::size_t i, const RayFrame& frame, bool entered) {
                             if (entered) {
                               hits[i] = within(rays[i], trace_frame<Intersector, Walk>(level_set, frame));
                               return;
                             }
                             hits[i] = Hit{};
                             hits[i].counts.steps = frame.skipped;
                           });
    });
  });
}

void closest_hits(const LevelSet& level_set, std::span<const WorldRay> rays, std::string_view intersector,
                  std::span<Hit> hits) {
  PrimaryOptions options;
  options.intersector = intersector;
  closest_hits(level_set, rays, options, hits);
}

Hit closest_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector) {
  Hit hit;
  closest_hits(level_set, {&ray, 1}, intersector, {&hit, 1});
  return hit;
}

namespace {

// The paper's scheme: looks ahead for the inside; returns what is known then, or walks.
template <class Intersector, class Walk>
bool any_behind(const LevelSet& level_set, const RayFrame& frame, const Occluders& occluders, int most_steps,
                RayCounts& counts) {
  const SurfaceBlocks& surface = level_set.surface();
  walk::BlockSteps steps(surface, frame);
  bool begun = false;
  std::uint32_t looked_at = 0;
  const Ahead ahead = look_ahead(occluders, most_steps, steps, begun, looked_at);
  bool hit = ahead == Ahead::inside && occluders.begins_outside(surface, frame);
  if (!hit && ahead != Ahead::nothing) {
    // Who began inside has to look at everything.
    if (Walk::steps_plainly && ahead == Ahead::unknown)
      hit = any_in_walk<Intersector>(frame, counts, [&](WalkCounts& walked, auto&& visit) {
        return walk_cells_plainly_from(steps, begun, surface, frame, walked, visit);
      });
    else
      hit = any_in_frame<Intersector, Walk>(level_set, frame, counts);
  }
  counts.steps += looked_at;
  return hit;
}

// Tries boxes of the inside. Rays that follow each other tend to meet the same: the one that was met last is
// tried first, and after a ray that met nothing at all, it alone.
class BoxTrials {
 public:
  explicit BoxTrials(const ShadowOptions& options) {
    if (!options.occluders || options.scheme != ShadowScheme::boxes || !options.occluders->consistent())
      return;
    occluders_ = options.occluders;
    count_ = occluders_->boxes().size();
    for (std::size_t i = 0; i < count_; ++i) order_[i] = i;
  }
  bool meet(const SurfaceBlocks& surface, const RayFrame& frame) {
    const std::size_t trials = last_hit_ ? count_ : std::min<std::size_t>(count_, 1);
    for (std::size_t i = 0; i < trials; ++i) {
      if (!meets(surface, frame, occluders_->boxes()[order_[i]])) continue;
      if (!occluders_->begins_outside(surface, frame)) return false;
      std::swap(order_[0], order_[i]);
      return true;
    }
    return false;
  }
  void tell(bool hit) { last_hit_ = hit; }

 private:
  const Occluders* occluders_ = nullptr;
  std::size_t count_ = 0, order_[Occluders::most_boxes];
  bool last_hit_ = true;
};

// add(i, counts) for every ray i.
template <class Add>
void find_any(const LevelSet& level_set, std::span<const WorldRay> rays, const ShadowOptions& options,
              std::span<bool> hits, Add&& add) {
  assert(rays.size() == hits.size());
  const bool looks_ahead =
      options.scheme == ShadowScheme::occluder && options.occluders && options.occluders->consistent();
  BoxTrials boxes(options);
  for_intersector(options.intersector, [&]<class Intersector>(Intersector) {
    for_traversal(options.traversal, [&]<class Walk>(Walk) {
      const auto decide = [&](const RayFrame& frame, RayCounts& counts) {
        if (looks_ahead)
          return any_behind<Intersector, Walk>(level_set, frame, *options.occluders, options.occluder_steps,
                                               counts);
        if (boxes.meet(level_set.surface(), frame)) return true;
        const bool hit = any_in_frame<Intersector, Walk>(level_set, frame, counts);
        boxes.tell(hit);
        return hit;
      };
      for_each_frame<Walk>(level_set, rays, {}, [&](std::size_t i, const RayFrame& frame, bool entered) {
        RayCounts counts;
        counts.steps = frame.skipped;
        hits[i] = entered && decide(frame, counts);
        add(i, counts);
      });
    });
  });
}

} // namespace

void any_hits(const LevelSet& level_set, std::span<const WorldRay> rays, const ShadowOptions& options,
              std::span<bool> hits, std::span<RayCounts> counts) {
  assert(counts.empty() || counts.size() == rays.size());
  find_any(level_set, rays, options, hits, [&](std::size_t i, const RayCounts& own) {
    if (!counts.empty()) counts[i] = own;
  });
}

void any_hits(const LevelSet& level_set, std::span<const WorldRay> rays, std::string_view intersector,
              std::span<bool> hits, RayCounts* counts) {
  ShadowOptions options;
  options.intersector = intersector;
  RayCounts sum;
  find_any(level_set, rays, options, hits, [&](std::size_t, const RayCounts& own) { sum += own; });
  if (counts) *counts += sum;
}

bool any_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector,
             RayCounts* counts) {
  bool hit = false;
  any_hits(level_set, {&ray, 1}, intersector, {&hit, 1}, counts);
  return hit;
}

namespace {

// Instantiates both for every entry of the list.
template <class... I>
constexpr auto instantiate(std::tuple<I...>*) {
  return std::tuple{&trace_closest<I>..., &trace_any<I>...};
}
[[gnu::used]] constexpr auto instances = instantiate(static_cast<Intersectors*>(nullptr));

} // namespace

} // namespace levelray
