#include "levelray/trace/certified_hit.hpp"

#include "levelray/accel/cell_walk.hpp"
#include "levelray/intersect/bernstein.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/trace/ray_values.hpp"
#include "levelray/trace/starting_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// The end of the longest [0, u] found on which the cubic with these coefficients is above 0: that of all
// halves, quarters, ... with positive coefficients, down to 2^-50.
double positive_until(const double (&b)[4], double from, double to, int depth) {
  if (b[0] > 0 && b[1] > 0 && b[2] > 0 && b[3] > 0) return to;
  if (!(b[0] > 0) || depth == 50) return from;
  const double m01 = 0.5 * (b[0] + b[1]), m12 = 0.5 * (b[1] + b[2]), m23 = 0.5 * (b[2] + b[3]);
  const double low = 0.5 * (m01 + m12), high = 0.5 * (m12 + m23), middle = 0.5 * (low + high);
  const double half = 0.5 * (from + to);
  const double left[4] = {b[0], m01, low, middle};
  const double reached = positive_until(left, from, half, depth + 1);
  if (reached < half) return reached;
  const double right[4] = {middle, high, m23, b[3]};
  return positive_until(right, half, to, depth + 1);
}

// What the second walk says.
struct Clearance {
  bool met_box = false;
  double side = 1;
  double t = 0; // f * side > the margin and `extra` up to here
  double margin = 0;
};

Clearance clearance(const LevelSet& level_set, const WorldRay& ray, double extra) {
  Clearance result;
  result.t = ray.t_max;
  RayFrame frame;
  const GridTransform& transform = level_set.grid().transform;
  const SurfaceBlocks& surface = level_set.surface();
  if (!enter_box(surface, transform, ray, frame)) return result;
  result.met_box = true;

  // Distances that were rounded on the way into the frame, in voxels.
  const double start = std::fabs(frame.t_at_start) / frame.t_per_s; // its unit is at most 2 voxels long
  double distances = 2 * start;
  for (int a = 0; a < 3; ++a)
    distances = std::max(distances,
                         std::fabs(ray.origin[a]) / transform.voxel_size +
                             std::fabs(transform.origin[a]) / transform.voxel_size +
                             node_dim * (std::fabs(double(surface.node_min()[a])) + surface.node_dims()[a]));
  const double largest = static_cast<double>(surface.largest_sample());
  const double margin = largest * (0x1p-44 + 6 * 0x1p-48 * distances) + extra;
  result.margin = margin;

  StartingSide side(frame);
  WalkCounts counts;
  walk_cells(surface, frame, counts, [&](const VisitedCell& cell) {
    const double sign = side.at_first(cell.segment);
    const Bernstein<double> f = bernstein_along<double>(cell.segment);
    const double b[4] = {sign * f.start - margin, sign * f.sum1 / 3 - margin, sign * f.sum2 / 3 - margin,
                         sign * f.end - margin};
    const double until = positive_until(b, 0, 1, 0);
    if (until == 1) return false;
    result.t = std::min(frame.t(cell.in + until * (cell.out - cell.in)), ray.t_max);
    return true;
  });
  result.side = side.inside() ? -1 : 1;
  return result;
}

// The least step from t that is worth a try, and a voxel's length in t.
struct Steps {
  double least, voxel;

  Steps(const BlockGrid& grid, const WorldRay& ray, double t) {
    const double largest =
        std::max({std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)});
    voxel = grid.transform.voxel_size / largest;
    least = std::max({std::nextafter(std::fabs(t), infinite) - std::fabs(t), 0x1p-52 * voxel,
                      std::numeric_limits<double>::denorm_min()});
  }
};

// How far a and b lie apart at the most.
double distance_up(double a, double b) {
  return a == b ? 0 : std::nextafter(std::fabs(a - b), infinite);
}

} // namespace

CertifiedHit certify(const LevelSet& level_set, const WorldRay& ray, const Hit& hit) {
  CertifiedHit result;
  const Clearance clear = clearance(level_set, ray, 0);
  result.clear_to = clear.t;
  if (!hit) {
    result.t_lo = result.t_hi = ray.t_max;
    result.error = infinite;
    return result;
  }

  const double side = hit.from_inside ? -1 : 1;
  const RayValues values(level_set.grid(), ray);
  // Looks for places with proven signs: +1, -1 (which is 0, too), or 0 where none is proven.
  bool has_low = false, has_high = false;
  double value = 0;
  const auto look_at = [&](double t) {
    Enclosure f = values.at(t);
    value = f.value *= side;
    const int sign = f.surely_positive() ? 1 : f.surely_not_positive() ? -1 : 0;
    if (sign > 0 && (!has_low || t > result.t_lo)) has_low = true, result.t_lo = t;
    if (sign < 0 && (!has_high || t < result.t_hi)) has_high = true, result.t_hi = t;
    return sign;
  };
  const Steps steps(level_set.grid(), ray, hit.t);
  look_at(hit.t);
  bool from_beginning = hit.t == ray.t_min;
  for (double step = steps.least; !has_low && step <= 4 * steps.voxel && !from_beginning; step *= 2) {
    const double t = std::max(hit.t - step, ray.t_min);
    look_at(t);
    from_beginning = t == ray.t_min;
  }
  bool passed = false; // behind the hit f is above the margin again, and it was not before: no crossing here
  double behind = std::min(hit.t + 4 * steps.voxel, ray.t_max);
  for (double step = steps.least; !has_high && !passed && step <= 4 * steps.voxel; step *= 2) {
    const double t = std::min(hit.t + step, ray.t_max);
    passed = look_at(t) > 0 && value > clear.margin && clear.t <= hit.t;
    if (passed) behind = t;
    if (t == ray.t_max) break;
  }

  if (has_low && has_high && result.t_lo < result.t_hi) {
    result.proof = Proof::crossing;
    result.clear_to = std::min(result.clear_to, result.t_lo);
  } else if (has_high && from_beginning) {
    result.proof = Proof::beginning;
    result.t_lo = result.clear_to = ray.t_min;
  } else if (clear.t > behind) {
    result.proof = Proof::refuted;
    result.t_lo = result.t_hi = result.clear_to;
    result.error = infinite;
    return result;
  } else {
    result.proof = Proof::graze;
    result.clear_to = std::min(result.clear_to, hit.t);
    result.t_lo = result.clear_to;
    result.t_hi = behind;
  }
  result.error = std::max(distance_up(hit.t, result.clear_to), distance_up(result.t_hi, hit.t));
  return result;
}

SurfaceBracket bracket_original(const LevelSet& level_set, const WorldRay& ray, const Hit& hit,
                                double field_error) {
  SurfaceBracket result;
  result.t_lo = clearance(level_set, ray, field_error).t;
  if (hit) result.t_lo = std::min(result.t_lo, hit.t);
  result.t_hi = infinite;
  if (!hit) return result;
  const double side = hit.from_inside ? -1 : 1;
  const RayValues values(level_set.grid(), ray);
  const Steps steps(level_set.grid(), ray, hit.t);
  for (int step = 0; step <= 64; ++step) {
    const double t = std::min(hit.t + step * 0.25 * steps.voxel, ray.t_max);
    const Enclosure f = values.at(t);
    if (side * f.value + f.error < -field_error) {
      result.t_hi = t;
      break;
    }
    if (t == ray.t_max) break;
  }
  return result;
}

} // namespace levelray
