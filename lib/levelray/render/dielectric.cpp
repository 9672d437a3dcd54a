#include "levelray/render/dielectric.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

Refraction refract(const Vec3d& d, const Vec3d& n, double eta) {
  Refraction result;
  const double cos_i = std::clamp(-d.dot(n), 0.0, 1.0);
  const double cos_t_squared = 1 - eta * eta * (1 - cos_i * cos_i);
  if (!(cos_t_squared > 0) || !(cos_i > 0)) return result;
  const double cos_t = std::sqrt(cos_t_squared);
  // Divided by n2 throughout.
  const double across =
      (eta * cos_i - cos_t) / (eta * cos_i + cos_t); // the field across the plane of incidence
  const double within = (eta * cos_t - cos_i) / (eta * cos_t + cos_i);
  result.reflectance = 0.5 * (across * across + within * within);
  result.direction = (d * eta + n * (eta * cos_i - cos_t)).normalized();
  return result;
}

} // namespace levelray
