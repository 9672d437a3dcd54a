// Rays through all objects of a scene.
#pragma once

#include "levelray/render/acceleration.hpp"
#include "levelray/render/scene.hpp"
#include "levelray/trace/hit.hpp"
#include "levelray/trace/level_set.hpp"

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace levelray {

// An instance ready for rays.
struct SceneObject {
  const Instance* instance;
  const LevelSet* level_set;
  const Occluders* occluders; // or null
  Similarity object_from_world;
  bool in_place;         // the transform is the identity: rays need not be moved
  double precise_within; // 2^13 voxels, in world units: a hit's safe point with larger coordinates may have
                         // been rounded to the other side of the surface (intersect/exact.cpp)
};

// Rays are moved to each object's own space, where t is the same number, and ask there no farther than the
// nearest hit so far. One object in its place costs nothing more than closest_hits does.
class SceneRays {
 public:
  static constexpr int nothing = -1;

  // Builds a level set for each distinct grid that comes without one, and what the acceleration's shadow
  // scheme needs. The instances must outlive this.
  explicit SceneRays(std::span<const Instance> instances, const Acceleration& acceleration = {});

  const SceneObject& object(int index) const { return objects_[static_cast<std::size_t>(index)]; }
  std::size_t size() const { return objects_.size(); }

  // The nearest hits: closest_hits (trace/trace.hpp) of all objects. objects[i] is the index of the instance
  // that was hit, the first of several at the same t, or `nothing`. A hit's cell belongs to the instance's
  // grid; its counts are those of all objects together. bounds[object * rays.size() + i], or none, says where
  // ray i can meet an object (PrimaryBounds).
  void closest(std::span<const WorldRay> rays, std::string_view intersector, std::span<Hit> hits,
               std::span<int> objects, std::span<const RayBounds> bounds = {}) const;

  // Unit normals of those hits in world space, towards positive values; (0,0,0) for misses.
  void normals(std::span<const WorldRay> rays, std::span<const Hit> hits, std::span<const int> objects,
               std::string_view scheme, std::span<Vec3f> normals) const;

  // Whether a ray meets any object that casts shadows. `counts`, per ray, may be empty.
  void any(std::span<const WorldRay> rays, std::string_view intersector, std::span<bool> hits,
           std::span<RayCounts> counts = {}) const;

 private:
  Acceleration acceleration_;
  std::vector<std::unique_ptr<LevelSet>> level_sets_; // built here
  std::vector<std::unique_ptr<Occluders>> occluders_;
  std::vector<SceneObject> objects_;
};

} // namespace levelray
