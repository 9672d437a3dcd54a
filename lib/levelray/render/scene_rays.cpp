#include "levelray/render/scene_rays.hpp"

#include "levelray/trace/hit_normals.hpp"
#include "levelray/trace/trace.hpp"

#include <algorithm>
#include <cassert>
#include <map>

namespace levelray {

SceneRays::SceneRays(std::span<const Instance> instances, const Acceleration& acceleration)
    : acceleration_(acceleration) {
  std::map<const BlockGrid*, const LevelSet*> ready;
  std::map<const LevelSet*, const Occluders*> solids;
  for (const Instance& instance : instances)
    if (instance.level_set) ready.emplace(instance.grid, instance.level_set);
  for (const Instance& instance : instances) {
    const LevelSet*& level_set = ready[instance.grid];
    if (!level_set) level_set = level_sets_.emplace_back(std::make_unique<LevelSet>(*instance.grid)).get();
    const Occluders*& occluders = solids[level_set];
    if (!occluders && acceleration.shadow != ShadowScheme::plain)
      occluders =
          occluders_.emplace_back(std::make_unique<Occluders>(*instance.grid, level_set->surface())).get();
    objects_.push_back({&instance, level_set, occluders, instance.world_from_object.inverse(),
                        instance.world_from_object.is_identity(),
                        0x1p13 * instance.grid->transform.voxel_size * instance.world_from_object.scale});
  }
}

void SceneRays::closest(std::span<const WorldRay> rays, std::string_view intersector, std::span<Hit> hits,
                        std::span<int> objects, std::span<const RayBounds> bounds) const {
  assert(rays.size() == hits.size() && rays.size() == objects.size());
  assert(bounds.empty() || bounds.size() == rays.size() * objects_.size());
  PrimaryOptions options;
  options.intersector = intersector;
  options.traversal = acceleration_.traversal;
  if (objects_.size() == 1 && objects_[0].in_place) {
    options.bounds = bounds;
    closest_hits(*objects_[0].level_set, rays, options, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) objects[i] = hits[i] ? 0 : nothing;
    return;
  }
  std::fill(hits.begin(), hits.end(), Hit{});
  std::fill(objects.begin(), objects.end(), nothing);
  std::vector<WorldRay> moved(rays.size());
  std::vector<Hit> found(rays.size());
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      moved[i] = objects_[o].in_place ? rays[i] : objects_[o].object_from_world.ray(rays[i]);
      if (hits[i]) moved[i].t_max = std::min(moved[i].t_max, hits[i].t);
    }
    if (!bounds.empty()) options.bounds = bounds.subspan(o * rays.size(), rays.size());
    closest_hits(*objects_[o].level_set, moved, options, found);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayCounts counts = hits[i].counts;
      counts += found[i].counts;
      if (found[i] && (!hits[i] || found[i].t < hits[i].t)) {
        hits[i] = found[i];
        objects[i] = static_cast<int>(o);
      }
      hits[i].counts = counts;
    }
  }
}

void SceneRays::normals(std::span<const WorldRay> rays, std::span<const Hit> hits,
                        std::span<const int> objects, std::string_view scheme,
                        std::span<Vec3f> normals) const {
  if (objects_.size() == 1 && objects_[0].in_place)
    return hit_normals(*objects_[0].level_set, rays, hits, scheme, normals);
  std::fill(normals.begin(), normals.end(), Vec3f(0, 0, 0));
  std::vector<std::size_t> mine;
  std::vector<WorldRay> moved;
  std::vector<Hit> of_mine;
  std::vector<Vec3f> found;
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    mine.clear(), moved.clear(), of_mine.clear();
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (objects[i] == static_cast<int>(o)) {
        mine.push_back(i);
        moved.push_back(objects_[o].in_place ? rays[i] : objects_[o].object_from_world.ray(rays[i]));
        of_mine.push_back(hits[i]);
      }
    found.resize(mine.size());
    hit_normals(*objects_[o].level_set, moved, of_mine, scheme, found);
    const Similarity& place = objects_[o].instance->world_from_object;
    for (std::size_t i = 0; i < mine.size(); ++i)
      normals[mine[i]] = objects_[o].in_place ? found[i] : Vec3f(place.rotate(Vec3d(found[i])));
  }
}

void SceneRays::any(std::span<const WorldRay> rays, std::string_view intersector, std::span<bool> hits,
                    std::span<RayCounts> counts) const {
  assert(rays.size() == hits.size());
  ShadowOptions options;
  options.intersector = intersector;
  options.traversal = acceleration_.traversal;
  options.scheme = acceleration_.shadow;
  options.occluder_steps = acceleration_.occluder_steps;
  options.occluders = objects_.empty() ? nullptr : objects_[0].occluders;
  if (objects_.size() == 1 && objects_[0].in_place && objects_[0].instance->casts_shadows)
    return any_hits(*objects_[0].level_set, rays, options, hits, counts);
  std::fill(hits.begin(), hits.end(), false);
  std::fill(counts.begin(), counts.end(), RayCounts{});
  std::vector<RayCounts> own;
  std::vector<std::size_t> open; // rays that have met nothing yet
  std::vector<WorldRay> moved;
  const std::unique_ptr<bool[]> found(new bool[rays.size()]());
  for (const SceneObject& object : objects_) {
    if (!object.instance->casts_shadows) continue;
    open.clear(), moved.clear();
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!hits[i]) {
        open.push_back(i);
        moved.push_back(object.in_place ? rays[i] : object.object_from_world.ray(rays[i]));
      }
    options.occluders = object.occluders;
    own.resize(counts.empty() ? 0 : open.size());
    any_hits(*object.level_set, moved, options, {found.get(), moved.size()}, own);
    for (std::size_t i = 0; i < open.size(); ++i) hits[open[i]] = found[i];
    for (std::size_t i = 0; i < own.size(); ++i) counts[open[i]] += own[i];
  }
}

} // namespace levelray
