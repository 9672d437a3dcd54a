#include "levelray/measure/sampled_shape.hpp"

#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/ray_sets.hpp"

#include <algorithm>
#include <utility>

namespace levelray {

std::vector<Reference> chosen_references(const AnalyticSettings& settings) {
  std::vector<Reference> all = all_references();
  std::string known;
  for (const Reference& shape : all) known += (known.empty() ? "" : ", ") + shape.name;
  for (const std::string& name : settings.shapes)
    if (std::none_of(all.begin(), all.end(), [&](const Reference& shape) { return shape.name == name; }))
      throw Error(ErrorKind::usage, "unknown shape '" + printable(name, 80) + "'; there are " + known);
  if (!settings.shapes.empty())
    std::erase_if(all, [&](const Reference& shape) {
      return std::find(settings.shapes.begin(), settings.shapes.end(), shape.name) == settings.shapes.end();
    });
  return all;
}

SampledShape::SampledShape(const Reference& of, int resolution, const AnalyticSettings& settings)
    : shape(of), at{of.name, resolution, 1.0 / resolution},
      grid(of.grid(at.voxel_size, settings.half_width_voxels)),
      level_set(grid), reference{&shape, at.voxel_size, static_cast<double>(grid.background)},
      camera(framing_camera(of.bounds, settings.image_size, settings.image_size)),
      primary(primary_rays(camera)), chords(random_chords(of.bounds, settings.chords, settings.seed)),
      rays(primary) {
  rays.insert(rays.end(), chords.begin(), chords.end());
  truth.reserve(rays.size());
  for (const WorldRay& ray : rays) truth.push_back(shape.chord(ray));
  exact.resize(rays.size());
  closest_hits(level_set, rays, Exact::name, exact);
}

void ConvergenceCurves::add(const Reference& shape, const std::string& method, const std::string& quantity,
                            double voxel_size, double mean, double median) {
  auto curve = std::find_if(curves_.begin(), curves_.end(), [&](const Convergence& c) {
    return c.shape == shape.name && c.method == method && c.quantity == quantity;
  });
  if (curve == curves_.end()) {
    curves_.emplace_back();
    curve = curves_.end() - 1;
    curve->shape = shape.name, curve->method = method, curve->quantity = quantity;
    curve->smooth = shape.smooth;
  }
  curve->voxel_sizes.push_back(voxel_size);
  curve->means.push_back(mean);
  curve->medians.push_back(median);
}

std::vector<Convergence> ConvergenceCurves::finish() {
  for (Convergence& curve : curves_) {
    curve.mean_slope = log_log_slope(curve.voxel_sizes, curve.means);
    curve.median_slope = log_log_slope(curve.voxel_sizes, curve.medians);
    std::vector<std::pair<double, double>> finest; // by size
    for (std::size_t i = 0; i < curve.means.size(); ++i)
      finest.emplace_back(curve.voxel_sizes[i], curve.means[i]);
    std::sort(finest.begin(), finest.end());
    finest.resize(std::min<std::size_t>(finest.size(), 2));
    std::vector<double> sizes, means;
    for (const auto& [size, mean] : finest) sizes.push_back(size), means.push_back(mean);
    curve.finest_slope = log_log_slope(sizes, means);
  }
  return std::move(curves_);
}

} // namespace levelray
