// What goes on from mirrors and glass.
//
// Directions follow from the normals of the chosen scheme. Those are smoother than the surface that rays
// meet, and near a silhouette they may send a reflected ray into the surface or a refracted one out of it;
// there the gradient of the interpolant itself is taken, for which that cannot happen.
//
// A reflected ray stays on its side and starts from the hit's safe point. A refracted one starts from a point
// that is proven to lie on the other side (trace/field_probe.hpp). So every ray begins on a known side of
// every object, and what it meets next of the same glass is its way out, or in: crossings alternate, and none
// is lost or counted twice. Where no point of the other side is found, the glass is thinner than 2^-19 voxel
// or just touched: nothing enters it, and all light is reflected.
#include "levelray/render/dielectric.hpp"
#include "levelray/render/random.hpp"
#include "levelray/render/surface_place.hpp"

namespace levelray {

namespace {

// The normal by which d (unit) is scattered: the vertex's, unless that contradicts the surface.
Vec3d scattering_normal(const Vertex& vertex, const Vec3d& facing, const Vec3d& d, double eta) {
  const Vec3d& n = vertex.normal;
  if (!(d.dot(facing) < 0)) return n; // rounding at a touch: the gradient is no better
  if (!(d.dot(n) < 0) || !(reflected(d, n).dot(facing) > 0)) return facing;
  if (eta > 0) {
    const Refraction refraction = refract(d, n, eta);
    if (refraction.reflectance < 1 && !(refraction.direction.dot(facing) < 0)) return facing;
  }
  return n;
}

} // namespace

void scatter(const Shading& shading, const Vertex& vertex, std::vector<PathRay>& rays) {
  const Material& material = *vertex.material;
  const bool glass = material.kind == MaterialKind::glass;
  if (!glass && material.kind != MaterialKind::mirror) return;
  const Vec3d d = -vertex.back;
  const auto go_on = [&](const Vec3d& origin, const Vec3d& direction, double part, int medium, bool through) {
    PathRay next;
    next.ray.origin = origin;
    next.ray.direction = direction;
    next.root = vertex.root;
    next.branch = mix_hash(vertex.branch, through ? 3 : 2);
    next.depth = vertex.depth + 1;
    next.medium = medium;
    next.weight = vertex.weight * (vertex.coverage * part);
    rays.push_back(next);
  };

  if (vertex.object == SceneRays::nothing) { // the ground
    go_on(vertex.outside, reflected(d, vertex.normal), 1, SceneRays::nothing, false);
    rays.back().weight *= material.tint;
    return;
  }
  const SceneObject& object = shading.objects.object(vertex.object);
  const SurfacePlace place(object, vertex);
  const double eta = !glass ? 0 : vertex.inner ? material.ior : 1 / material.ior;
  const Vec3d n = scattering_normal(vertex, place.facing, d, eta);

  const double side = vertex.inner ? -1 : 1;
  const Vec3d start = place.start(vertex.outside, side);
  const int own = vertex.inner ? vertex.object : SceneRays::nothing; // the medium on the path's side
  if (!glass) {
    go_on(start, reflected(d, n), 1, own, false);
    rays.back().weight *= material.tint;
    return;
  }

  const Refraction refraction = refract(d, n, eta);
  const std::optional<Vec3d> across =
      refraction.reflectance < 1 ? place.beside(-place.facing, -side) : std::nullopt;
  const double reflectance = across ? refraction.reflectance : 1;
  go_on(start, reflected(d, n), reflectance, own, false);
  if (across)
    go_on(*across, refraction.direction, 1 - reflectance, vertex.inner ? SceneRays::nothing : vertex.object,
          true);
}

} // namespace levelray
