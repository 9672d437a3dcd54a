#include "framing.hpp"

#include "levelray/render/surface_extent.hpp"
#include "turntable.hpp"

#include <algorithm>
#include <limits>

namespace levelray {

Framing::Framing(const CameraSettings& view)
    : view_(view), directions_(framing_directions(view.width, view.height, view.fov_degrees, view.up)),
      lowest_(std::numeric_limits<double>::infinity()) {
  support_.fill(-std::numeric_limits<double>::infinity());
}

void Framing::add(const BlockGrid& grid) {
  bounds_.extendBy(surface_bounds(grid));
  std::vector<Vec3d> directions(directions_.begin(), directions_.end());
  directions.push_back(-view_.up.normalized());
  const std::vector<double> own = surface_support(grid, directions);
  for (std::size_t i = 0; i < support_.size(); ++i) support_[i] = std::max(support_[i], own[i]);
  lowest_ = std::min(lowest_, -own.back());
}

void Framing::add_turning(const BlockGrid& grid) {
  add(grid);
  if (bounds_.isEmpty()) return;
  const std::vector<double> swept = turned_surface_support(grid, view_.up, bounds_.center(), directions_);
  std::copy(swept.begin(), swept.end(), support_.begin());
}

CameraSettings Framing::camera() const {
  if (bounds_.isEmpty())
    return framing_camera(bounds_, view_.width, view_.height, view_.fov_degrees, view_.up);
  return framing_camera(support_, bounds_.center(), view_.width, view_.height, view_.fov_degrees, view_.up);
}

void Framing::place(GroundSettings& ground) const {
  if (bounds_.isEmpty()) return;
  ground.height = lowest_;
  ground.centre = bounds_.center();
  ground.radius = bounds_.size().length() / 2;
}

std::vector<int> framing_frames(const std::vector<int>& frames) {
  std::vector<int> some{frames.front(), frames[(frames.size() - 1) / 2], frames.back()};
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

} // namespace levelray
