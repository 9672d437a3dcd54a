// The one list of normal schemes; command line, documentation, instantiations and tests come from it.
//
// A scheme is `smooth` if its normals do not jump between cells where the surface has no crease: shading by
// others shows the cells.
#pragma once

#include "levelray/core/methods.hpp"
#include "levelray/normal/analytic.hpp"
#include "levelray/normal/difference_of_interpolations.hpp"
#include "levelray/normal/dual_voxel.hpp"
#include "levelray/normal/interpolation_of_differences.hpp"
#include "levelray/normal/offset_differences.hpp"
#include "levelray/normal/sharp_features.hpp"
#include "levelray/normal/tricubic_b_spline.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

using NormalSchemes = std::tuple<InterpolationOfDifferences, DifferenceOfInterpolations, AnalyticNormal,
                                 OffsetDifferences, DualVoxel, TricubicBSpline, SharpFeatures>;

// The unit normal of the scheme, towards positive values. Where its gradient is zero or not finite the
// analytic one is taken, and where that is too (all samples around are equal), +z.
template <class Scheme>
Vec3d unit_normal(const Neighbourhood& samples, const CellPosition& at) {
  const auto normalized = [](const Vec3d& g, Vec3d& unit) {
    const double square = g.dot(g);
    if (!(square > 1e-250 && square < 1e250)) { // zero, NaN, or of a grid with extreme units
      const double largest = std::max({std::fabs(g.x), std::fabs(g.y), std::fabs(g.z)});
      if (!(largest > 0 && std::isfinite(largest))) return false;
      unit = g / largest;
      unit *= 1 / std::sqrt(unit.dot(unit));
      return true;
    }
    unit = g * (1 / std::sqrt(square));
    return true;
  };
  Vec3d unit;
  if (normalized(Scheme::gradient(samples, at), unit)) return unit;
  if (normalized(AnalyticNormal::gradient(samples, at), unit)) return unit;
  return Vec3d(0, 0, 1);
}

} // namespace levelray
