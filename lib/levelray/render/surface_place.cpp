#include "levelray/render/surface_place.hpp"

#include "levelray/trace/field_probe.hpp"

namespace levelray {

SurfacePlace::SurfacePlace(const SceneObject& of, const Vertex& vertex)
    : object(of), at(of.in_place ? vertex.point : of.object_from_world.point(vertex.point)) {
  facing = of.instance->world_from_object.rotate(probe_field(of.level_set->grid(), at).gradient).normalized();
  if (vertex.inner) facing = -facing;
}

Vec3d SurfacePlace::start(const Vec3d& safe, double side) const {
  const BlockGrid& grid = object.level_set->grid();
  const Vec3d in_object = object.in_place ? safe : object.object_from_world.point(safe);
  if ((in_object - at).length() <= 2 * grid.transform.voxel_size && lies_on_side(grid, in_object, side))
    return safe;
  return beside(facing, side).value_or(safe);
}

std::optional<Vec3d> SurfacePlace::beside(const Vec3d& n, double side) const {
  const Vec3d direction = object.in_place ? n : object.object_from_world.rotate(n);
  const std::optional<Vec3d> p = point_on_side(object.level_set->grid(), at, direction, side);
  if (!p || object.in_place) return p;
  return object.instance->world_from_object.point(*p);
}

} // namespace levelray
