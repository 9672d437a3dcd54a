// Ambient occlusion: what hides the sky.
//
// Zhukov, Iones and Kronin 1998 ("An ambient light illumination model"), with hard limits instead of an
// attenuation by distance. Directions are Malley's: a uniform point of the disk, lifted to the hemisphere,
// has the density of the cosine (Pharr, Jakob and Humphreys, PBRT, section 13.6.3 of the third edition). The
// points are Hammersley's, shifted for each vertex by a random vector (Cranley and Patterson 1976).
#include "levelray/render/random.hpp"
#include "levelray/render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace levelray {

namespace {

// Two unit vectors that complete n to an orthonormal basis (Duff et al. 2017, "Building an orthonormal basis,
// revisited", JCGT 6(1), listing 3).
void basis_around(const Vec3d& n, Vec3d& s, Vec3d& t) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  s = Vec3d(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  t = Vec3d(b, sign + n.y * n.y * a, -n.y);
}

} // namespace

std::vector<double> occlusion(Shading& shading, std::span<const Vertex> vertices) {
  const AmbientOcclusion& settings = shading.scene.ambient_occlusion;
  std::vector<double> hidden(vertices.size(), 0);
  if (settings.samples == 0) return hidden;

  // Rays of some vertices at a time, as many as fit well into a cache.
  constexpr std::size_t batch = 1024;
  std::vector<WorldRay> rays;
  std::vector<std::size_t> owner;
  std::vector<double> share; // of a ray among its vertex's
  const std::unique_ptr<bool[]> met(new bool[batch]());
  const auto trace = [&] {
    shading.objects.any(rays, shading.intersector, {met.get(), rays.size()});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (met[i]) {
        hidden[owner[i]] += share[i];
      } else if (shading.ground) {
        if (const std::optional<double> t = shading.ground->hit(rays[i]))
          hidden[owner[i]] += share[i] * shading.ground->coverage(rays[i].at(*t));
      }
    }
    shading.secondary_rays += rays.size();
    rays.clear(), owner.clear(), share.clear();
  };
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Vertex& vertex = vertices[v];
    // Vertices of which less arrives at the eye need fewer: their noise is weighted likewise.
    const double part = std::clamp(std::max({vertex.weight.x, vertex.weight.y, vertex.weight.z}), 0.0, 1.0);
    const auto samples = static_cast<std::uint32_t>(std::max(1.0, std::ceil(settings.samples * part)));
    const std::uint64_t hash = mix_hash(vertex.branch, 1);
    const double shift_u = high_fraction(hash), shift_v = low_fraction(hash);
    Vec3d s, t;
    basis_around(vertex.normal, s, t);
    for (std::uint32_t i = 0; i < samples; ++i) {
      double u = (i + 0.5) / samples + shift_u, angle = radical_inverse(i) + shift_v;
      u -= std::floor(u);
      angle = (angle - std::floor(angle)) * (2 * std::numbers::pi);
      const double r = std::sqrt(u);
      WorldRay& ray = rays.emplace_back();
      ray.origin = vertex.outside;
      ray.direction =
          s * (r * std::cos(angle)) + t * (r * std::sin(angle)) + vertex.normal * std::sqrt(1 - u);
      ray.t_max = settings.radius; // the direction has unit length but for rounding
      owner.push_back(v);
      share.push_back(1.0 / samples);
      if (rays.size() == batch) trace();
    }
  }
  if (!rays.empty()) trace();
  for (double& h : hidden) h = std::min(h, 1.0); // shares add up to 1 but for rounding
  return hidden;
}

} // namespace levelray
