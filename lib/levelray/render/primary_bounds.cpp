#include "levelray/render/primary_bounds.hpp"

namespace levelray {

PrimaryBounds::PrimaryBounds(const SceneRays& objects, const Camera& camera, int resolution)
    : per_width_(1.0 / camera.settings().width), per_height_(1.0 / camera.settings().height) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SceneObject& object = objects.object(static_cast<int>(i));
    PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
    view.half_height = camera.half_height();
    view.half_width = view.half_height * camera.settings().width / camera.settings().height;
    if (!object.in_place) {
      // Rays are moved by a linear map, so their slopes along the moved axes stay; those axes are orthonormal
      // to 1e-9 (check_similarity), and a length is t / scale to as much.
      const Similarity& move = object.object_from_world;
      view.eye = move.point(view.eye);
      view.right = move.rotate(view.right);
      view.up = move.rotate(view.up);
      view.forward = move.rotate(view.forward);
      view.skew = 1e-8;
    }
    buffers_.push_back(
        {MinMaxBuffer(object.level_set->surface(), object.level_set->grid().transform, view, resolution),
         object.instance->world_from_object.scale});
  }
}

namespace {

// Rounded outwards: by twice that of floats, 2^-148 for denormals.
RayBounds scaled(const RayBounds& bounds, double scale) {
  if (scale == 1 || !(bounds.near <= bounds.far)) return bounds;
  constexpr double largest = std::numeric_limits<float>::max();
  const double near = static_cast<double>(bounds.near) * scale * (1 - 0x1p-23) - 0x1p-148,
               far = static_cast<double>(bounds.far) * scale * (1 + 0x1p-23) + 0x1p-148;
  return {static_cast<float>(std::min(near, largest)),
          far <= largest ? static_cast<float>(far) : std::numeric_limits<float>::infinity()};
}

} // namespace

void PrimaryBounds::look_up(double x, double y, std::size_t i, std::size_t rays,
                            std::span<RayBounds> bounds) const {
  for (std::size_t o = 0; o < buffers_.size(); ++o)
    bounds[o * rays + i] = scaled(buffers_[o].cells.at(x * per_width_, y * per_height_), buffers_[o].scale);
}

} // namespace levelray
