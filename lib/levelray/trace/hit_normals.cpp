#include "levelray/trace/hit_normals.hpp"

#include "levelray/core/error.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <cassert>

namespace levelray {

namespace {

CellPosition cell_position(const Vec3d& origin, double per_voxel, const WorldRay& ray, const Hit& hit) {
  CellPosition at;
  at.cell = hit.cell;
  const Vec3d p = (ray.at(hit.t) - origin) * per_voxel;
  for (int a = 0; a < 3; ++a) at.local[a] = std::min(std::max(p[a] - hit.cell[a], 0.0), 1.0);
  return at;
}

} // namespace

void hit_normals(const LevelSet& level_set, std::span<const WorldRay> rays, std::span<const Hit> hits,
                 std::string_view scheme, std::span<Vec3f> normals) {
  assert(rays.size() == hits.size() && hits.size() == normals.size());
  const BlockGrid& grid = level_set.grid();
  const Vec3d origin = grid.transform.origin;
  const double per_voxel = 1 / grid.transform.voxel_size;
  const auto work = [&]<class Scheme>(Scheme) {
    // In batches: all samples are asked for before the first are used.
    constexpr std::size_t batch = 32;
    Neighbourhood samples[batch];
    for (std::size_t first = 0; first < hits.size(); first += batch) {
      const std::size_t last = std::min(first + batch, hits.size());
      for (std::size_t i = first; i < last; ++i) {
        if (!hits[i]) continue;
        samples[i - first] = Neighbourhood(grid, hits[i].cell);
        samples[i - first].prefetch();
      }
      for (std::size_t i = first; i < last; ++i)
        normals[i] = hits[i] ? Vec3f(unit_normal<Scheme>(samples[i - first],
                                                         cell_position(origin, per_voxel, rays[i], hits[i])))
                             : Vec3f(0, 0, 0);
    }
  };
  if (visit_method<NormalSchemes>(scheme, work)) return;
  std::string names;
  for (const std::string& known : method_names<NormalSchemes>()) names += (names.empty() ? "" : ", ") + known;
  throw Error(ErrorKind::usage, "unknown normal scheme '" + std::string(scheme) + "'; legal are " + names);
}

Vec3f hit_normal(const LevelSet& level_set, const WorldRay& ray, const Hit& hit, std::string_view scheme) {
  Vec3f normal;
  hit_normals(level_set, {&ray, 1}, {&hit, 1}, scheme, {&normal, 1});
  return normal;
}

} // namespace levelray
