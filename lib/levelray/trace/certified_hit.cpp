#include "levelray/trace/certified_hit.hpp"

#include "levelray/accel/cell_walk.hpp"
#include "levelray/core/rounding_mode.hpp"
#include "levelray/intersect/bernstein.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/trace/ray_values.hpp"
#include "levelray/trace/starting_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace levelray {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using Coefficients = std::array<double, 4>;

// f times the side, less the margin.
Coefficients oriented(const CellSegment& segment, double side, double margin) {
  const Bernstein<double> f = bernstein_along<double>(segment);
  return {side * f.start - margin, side * f.sum1 / 3 - margin, side * f.sum2 / 3 - margin,
          side * f.end - margin};
}

// The end of the longest [0, u] found on which the cubic with these coefficients is above 0: that of all
// halves, quarters, ... with positive coefficients, down to 2^-50.
double positive_until(const Coefficients& b, double from, double to, int depth) {
  if (b[0] > 0 && b[1] > 0 && b[2] > 0 && b[3] > 0) return to;
  if (!(b[0] > 0) || depth == 50) return from;
  const double m01 = 0.5 * (b[0] + b[1]), m12 = 0.5 * (b[1] + b[2]), m23 = 0.5 * (b[2] + b[3]);
  const double low = 0.5 * (m01 + m12), high = 0.5 * (m12 + m23), middle = 0.5 * (low + high);
  const double half = 0.5 * (from + to);
  const double reached = positive_until({b[0], m01, low, middle}, from, half, depth + 1);
  if (reached < half) return reached;
  return positive_until({middle, high, m23, b[3]}, half, to, depth + 1);
}

// Lowers `clear_to`, a t of the ray, to where f is not above the margin in a cell within `place_error` voxels
// of the ray, whether the surface crosses that cell or not, in a plain loop over slabs of the main axis.
void look_at_all_cells(const LevelSet& level_set, const WorldRay& ray, double side, double place_error,
                       double margin, double& clear_to) {
  const BlockGrid& grid = level_set.grid();
  const GridTransform& transform = grid.transform;
  double origin[3], direction[3];
  int main = 0;
  for (int a = 0; a < 3; ++a) {
    origin[a] = (ray.origin[a] - transform.origin[a]) / transform.voxel_size;
    direction[a] = ray.direction[a] / transform.voxel_size;
    if (std::fabs(direction[a]) > std::fabs(direction[main])) main = a;
  }
  if (!(std::fabs(direction[main]) > 0)) return;
  // All by the coordinate along the main axis, x. Slopes are 1 at the most.
  const int way = direction[main] > 0 ? 1 : -1;
  double slope[3];
  for (int a = 0; a < 3; ++a) slope[a] = direction[a] / direction[main];
  const auto t_of = [&](double x) { return (x - origin[main]) / direction[main]; };
  const int low = grid.node_min[main] * node_dim - 1, size = grid.node_dims[main] * node_dim + 1;
  const double first = origin[main] + ray.t_min * direction[main] - way * place_error,
               last = origin[main] + clear_to * direction[main] + way * place_error;

  for (int n = 0; n < size; ++n) {
    const int slab = way > 0 ? low + n : low + size - 1 - n;
    const double low_x = std::max(slab - place_error, std::min(first, last)),
                 high_x = std::min(slab + 1 + place_error, std::max(first, last));
    if (!(low_x <= high_x)) continue;
    if (t_of(way > 0 ? low_x : high_x) >= clear_to) continue;
    Box3i cells;
    for (int a = 0; a < 3; ++a) {
      const double y0 = origin[a] + (low_x - origin[main]) * slope[a],
                   y1 = origin[a] + (high_x - origin[main]) * slope[a];
      const auto index = [](double y) { return static_cast<int>(std::floor(std::clamp(y, -1e9, 1e9))); };
      cells.min[a] = a == main ? slab : index(std::min(y0, y1) - place_error);
      cells.max[a] = a == main ? slab : index(std::max(y0, y1) + place_error);
    }
    Vec3i cell;
    for (cell.z = cells.min.z; cell.z <= cells.max.z; ++cell.z)
      for (cell.y = cells.min.y; cell.y <= cells.max.y; ++cell.y)
        for (cell.x = cells.min.x; cell.x <= cells.max.x; ++cell.x) {
          // The ray's piece in the cell grown by place_error; its ends, up to twice that off, moved into it.
          double in_x = low_x, out_x = high_x;
          for (int a = 0; a < 3; ++a) {
            if (a == main || slope[a] == 0) continue;
            const double x0 = origin[main] + (cell[a] - place_error - origin[a]) / slope[a],
                         x1 = origin[main] + (cell[a] + 1 + place_error - origin[a]) / slope[a];
            in_x = std::max(in_x, std::min(x0, x1));
            out_x = std::min(out_x, std::max(x0, x1));
          }
          if (!(in_x <= out_x)) continue;
          if (way < 0) std::swap(in_x, out_x);
          CellSegment segment;
          for (int a = 0; a < 3; ++a)
            for (const auto& [point, x] : {std::pair{&segment.in, in_x}, std::pair{&segment.out, out_x}}) {
              const double y = a == main ? x : origin[a] + (x - origin[main]) * slope[a];
              point->x[a] = std::clamp(y - cell[a], 0.0, 1.0);
              point->rest[a] = 1 - point->x[a];
            }
          for (int c = 0; c < 8; ++c)
            segment.corner[c] = grid.value(cell.x + (c & 1), cell.y + (c >> 1 & 1), cell.z + (c >> 2));
          const double until = positive_until(oriented(segment, side, margin), 0, 1, 0);
          if (until < 1)
            clear_to = std::min(clear_to, t_of(in_x + until * (out_x - in_x) - way * 2 * place_error));
        }
  }
}

// What the second walk says.
struct Clearance {
  double t = 0; // f * side > the margin and `extra` up to here
  double margin = 0;
};

Clearance clearance(const LevelSet& level_set, const WorldRay& ray, double extra) {
  Clearance result;
  result.t = ray.t_max;
  RayFrame frame{};
  const GridTransform& transform = level_set.grid().transform;
  const SurfaceBlocks& surface = level_set.surface();
  if (surface.empty()) return result;
  const bool meets_box = enter_box(surface, transform, ray, frame);

  // Distances that were rounded on the way into the frame, in voxels.
  const double start =
      meets_box ? std::fabs(frame.t_at_start) / frame.t_per_s : 0; // its unit is at most 2 voxels long
  double distances = 2 * start;
  for (int a = 0; a < 3; ++a)
    distances = std::max(distances,
                         std::fabs(ray.origin[a]) / transform.voxel_size +
                             std::fabs(transform.origin[a]) / transform.voxel_size +
                             node_dim * (std::fabs(double(surface.node_min()[a])) + surface.node_dims()[a]));
  const double largest = static_cast<double>(surface.largest_sample());
  const double place_error = 0x1p-48 * distances;
  const double margin = largest * (0x1p-44 + 6 * place_error) + extra;
  result.margin = margin;

  frame.from_outside |= !meets_box;
  StartingSide side(frame);
  WalkCounts counts;
  const auto visit = [&](const VisitedCell& cell) {
    const double sign = side.at_first(cell.segment);
    const double until = positive_until(oriented(cell.segment, sign, margin), 0, 1, 0);
    if (until == 1) return false;
    result.t = std::min(frame.t(cell.in + until * (cell.out - cell.in)), ray.t_max);
    return true;
  };
  if (meets_box) walk_cells(surface, frame, counts, visit);
  // That is all, unless a sample is so near to 0 that a root may hide behind it. Ends of pieces are up to
  // three times as far off in the other loop.
  if (extra > 0 || static_cast<double>(surface.least_sample()) <= margin) {
    const double near_margin = 3 * (margin - extra) + extra;
    const bool inside =
        side.known() ? side.inside() : RayValues(level_set.grid(), ray).at(ray.t_min).value < 0;
    if (near_margin < largest) // and so place_error below 1/18
      look_at_all_cells(level_set, ray, inside ? -1 : 1, place_error, near_margin, result.t);
    else // no sample exceeds it: a ray from that far away, or a field known that badly, proves nothing
      result.t = std::min(result.t, ray.t_min);
  }
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

[[gnu::noinline]] CertifiedHit certify_to_nearest(const LevelSet& level_set, const WorldRay& ray,
                                                  const Hit& hit) {
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

[[gnu::noinline]] SurfaceBracket bracket_to_nearest(const LevelSet& level_set, const WorldRay& ray,
                                                    const Hit& hit, double field_error) {
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

} // namespace

CertifiedHit certify(const LevelSet& level_set, const WorldRay& ray, const Hit& hit) {
  const RoundingMode mode(FE_TONEAREST);
  return certify_to_nearest(level_set, ray, hit);
}

SurfaceBracket bracket_original(const LevelSet& level_set, const WorldRay& ray, const Hit& hit,
                                double field_error) {
  const RoundingMode mode(FE_TONEAREST);
  return bracket_to_nearest(level_set, ray, hit, field_error);
}

SurfaceBracket bracket_original(const LevelSet& level_set, const WorldRay& ray, const Hit& hit) {
  if (const auto& error = level_set.grid().field_error) return bracket_original(level_set, ray, hit, *error);
  return {ray.t_min, infinite};
}

} // namespace levelray
