#include "levelray/measure/reference.hpp"

#include "levelray/convert/field_to_grid.hpp"
#include "levelray/field/reference_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

template <class Shape>
Reference reference_of(Shape shape) {
  Reference r;
  r.name = Shape::name, r.source = Shape::source;
  r.is_distance = Shape::is_distance, r.smooth = Shape::smooth;
  r.bounds = shape.bounds();
  r.value = [shape](const Vec3d& p) { return shape.value(p); };
  r.gradient = [shape](const Vec3d& p) { return shape.gradient(p); };
  r.chord = [shape](const WorldRay& ray) { return shape.chord(ray); };
  r.curvature = [shape](const Vec3d& p, double radius) { return shape.curvature(p, radius); };
  r.grid = [shape](double voxel_size, double half_width_voxels) {
    FieldSampling sampling;
    sampling.voxel_size = voxel_size;
    sampling.half_width_voxels = half_width_voxels;
    return field_to_grid(shape, sampling, shape.bounds());
  };
  return r;
}

} // namespace

std::vector<Reference> all_references() {
  return std::apply([](auto... shape) { return std::vector<Reference>{reference_of(shape)...}; },
                    ReferenceShapes{});
}

double interpolation_error(const Reference& shape, const Vec3d& p, double voxel_size, double half_width) {
  const double curvature = shape.curvature(p, std::sqrt(3.0) * voxel_size);
  const double anywhere = std::sqrt(3.0) / 2 * voxel_size;
  return std::min(anywhere, voxel_size * voxel_size / 8 * curvature) + 0x1p-24 * half_width;
}

} // namespace levelray
