#include "levelray/trace/all_hits.hpp"

#include "levelray/accel/cell_walk.hpp"
#include "levelray/intersect/exact.hpp"
#include "levelray/trace/field_probe.hpp"
#include "levelray/trace/grid_cell.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

Bernstein<double> times(const Bernstein<double>& f, double sign) {
  return {f.start * sign, f.sum1 * sign, f.sum2 * sign, f.end * sign};
}

// The root of f, which is positive at `low` and negative at `high`, to 2^-45 of the segment.
double bisect(const Bernstein<double>& f, double low, double high) {
  while (high - low > 0x1p-45) {
    const double middle = 0.5 * (low + high);
    (Exact::evaluate(f, middle) > 0 ? low : high) = middle;
  }
  return high;
}

// Follows the sign of f along a ray, cell by cell.
template <class Emit>
class SignWalk {
 public:
  SignWalk(const SurfaceBlocks& surface, const RayFrame& frame, double t_max, Emit& emit)
      : surface_(surface), frame_(frame), emit_(emit), t_max_(t_max), side_(frame.from_outside ? 1 : 0),
        first_(side_) {}

  void visit(const VisitedCell& cell) {
    cell_ = &cell;
    const Bernstein<double> f = bernstein_along<double>(cell.segment);
    double at = 0;
    if (side_ == 0 && !at_zero_) first_ = side_ = sign_of(f.start);
    if (side_ != 0 && !at_zero_ && side_ * f.start > 0) {
      // Off the surface: go to the first root, just as `exact` does.
      const Bernstein<double> oriented = times(f, side_);
      const double last = Exact::last_of_bracket(oriented);
      if (last < 0) return;
      CellRoot root;
      Exact::polish(oriented, last, safety_margin(cell.segment), root);
      come_to_zero(root.at);
      at = last;
    }
    double value = at == 0 ? f.start : at == 1 ? f.end : Exact::evaluate(f, at);
    if (at > 0 && side_ * value > 0) value = 0; // decided otherwise just now
    pass(at, value, at, f);
    if (at == 1) return;
    // The extrema behind, then the end; f is monotone from each to the next.
    double extrema[2] = {Exact::local_minimum(f), Exact::local_minimum(times(f, -1))};
    if (extrema[0] > extrema[1]) std::swap(extrema[0], extrema[1]);
    for (const double extremum : extrema)
      if (extremum > at) {
        pass(extremum, Exact::evaluate(f, extremum), at, f);
        at = extremum;
      }
    pass(1, f.end, at, f);
  }

  // At the ray's end; the side there.
  EndSides finish() {
    if (at_zero_) tell(PlaceKind::touch, zero_t_, zero_cell_);
    return {first_, at_zero_ ? 0 : side_};
  }
  bool knows_side() const { return side_ != 0 || at_zero_; }

 private:
  // f has this value at `at`, and is monotone from `before` to there.
  void pass(double at, double value, double before, const Bernstein<double>& f) {
    const int sign = sign_of(value);
    if (sign == 0) {
      if (!at_zero_) come_to_zero(at);
      return;
    }
    if (side_ == 0) {
      if (at_zero_) tell(PlaceKind::touch, zero_t_, zero_cell_);
      first_ = sign;
    } else if (sign != side_) {
      if (!at_zero_) come_to_zero(at == before ? at : bisect(times(f, side_), before, at));
      tell(sign < 0 ? PlaceKind::enters : PlaceKind::leaves, zero_t_, zero_cell_);
    } else if (at_zero_) {
      tell(PlaceKind::touch, zero_t_, zero_cell_);
    }
    side_ = sign;
    at_zero_ = false;
  }
  void come_to_zero(double at) {
    at_zero_ = true;
    zero_t_ = std::min(frame_.t(cell_->in + at * (cell_->out - cell_->in)), t_max_);
    zero_cell_ = grid_cell(surface_, frame_, cell_->position);
  }
  void tell(PlaceKind kind, double t, const Vec3i& cell) {
    last_t_ = told_ ? std::max(last_t_, t) : t;
    told_ = true;
    emit_(SurfacePlace{last_t_, kind, cell});
  }

  const SurfaceBlocks& surface_;
  const RayFrame& frame_;
  Emit& emit_;
  double t_max_; // to which the frame's end may be rounded up
  const VisitedCell* cell_ = nullptr;
  int side_, first_;     // 0: not known yet
  bool at_zero_ = false; // f has come to 0, and nothing else has been seen since
  double zero_t_ = 0;
  Vec3i zero_cell_{0, 0, 0};
  bool told_ = false;
  double last_t_ = 0;
};

// Of a ray that meets no surface cell: that of its beginning. Outside of the grid's box everything is
// outside, so the interval must lie in the box for anything else, and f has one sign all along.
EndSides side_far_from_surface(const LevelSet& level_set, const WorldRay& ray) {
  if (!(ray.t_min <= ray.t_max)) return {};
  const Vec3d point = ray.at(ray.t_min);
  for (int a = 0; a < 3; ++a)
    if (!(std::fabs(point[a]) <= std::numeric_limits<double>::max())) return {};
  const int side = probe_field(level_set.grid(), point).value < 0 ? -1 : 1;
  return {side, side};
}

template <class Emit>
EndSides for_each_place(const LevelSet& level_set, const WorldRay& ray, Emit&& emit) {
  const SurfaceBlocks& surface = level_set.surface();
  const GridTransform& transform = level_set.grid().transform;
  RayFrame frame;
  if (!enter_box(surface, transform, ray, frame)) return side_far_from_surface(level_set, ray);
  WalkCounts counts;
  SignWalk<Emit> signs(surface, frame, ray.t_max, emit);
  walk_cells(surface, frame, counts, [&](const VisitedCell& cell) {
    signs.visit(cell);
    return false;
  });
  return signs.knows_side() ? signs.finish() : side_far_from_surface(level_set, ray);
}

} // namespace

EndSides all_hits(const LevelSet& level_set, const WorldRay& ray, std::vector<SurfacePlace>& places) {
  places.clear();
  return for_each_place(level_set, ray, [&](const SurfacePlace& place) { places.push_back(place); });
}

std::optional<SurfacePlace> farthest_hit(const LevelSet& level_set, const WorldRay& ray) {
  std::optional<SurfacePlace> farthest;
  for_each_place(level_set, ray, [&](const SurfacePlace& place) { farthest = place; });
  return farthest;
}

} // namespace levelray
