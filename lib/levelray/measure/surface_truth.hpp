// The surface that a level set stands for, where rays may be asked about it without the level set: the mesh
// that was converted, or the interpolant of a grid that is only stored or traced otherwise.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "levelray/trace/level_set.hpp"

#include <optional>
#include <vector>

namespace levelray {

struct TruePlace {
  double t = 0;            // of the ray
  Vec3d position{0, 0, 0}; // world units
  Vec3d normal{0, 0, 0};   // unit
};

class SurfaceTruth {
 public:
  virtual ~SurfaceTruth() = default;
  virtual Box3d bounds() const = 0;
  // The first place that a ray of unit direction from outside meets. Nothing too where that place need not be
  // in the level set: the back of a triangle, which is seen through a hole or inside out.
  virtual std::optional<TruePlace> first_place(const WorldRay& ray) const = 0;
  // The distance of a point from the surface, world units. `at_most`: an upper bound that is known already,
  // which saves work, or infinity. NaN where the point lies on what closes a hole, about which the mesh says
  // nothing.
  virtual double distance(const Vec3d& p, double at_most) const = 0;
  // The unit normal at the place nearest to a point; (0,0,0) where there is none.
  virtual Vec3d normal(const Vec3d& p) const = 0;
};

// A prepared mesh; with `thicken` (world units) the boundary of all within that distance of it.
//
// A point lies on what closes a hole, or on its rim, when it is nearest to an open edge
// (PreparedMesh::open_edges) or an end of one.
class MeshTruth : public SurfaceTruth {
 public:
  // Keeps a reference to the mesh.
  explicit MeshTruth(const PreparedMesh& mesh, double thicken = 0);

  Box3d bounds() const override;
  std::optional<TruePlace> first_place(const WorldRay& ray) const override;
  double distance(const Vec3d& p, double at_most) const override;
  Vec3d normal(const Vec3d& p) const override;

 private:
  Vec3d face_normal(std::uint32_t triangle) const;
  bool is_open(const MeshPoint& nearest) const;
  std::optional<TruePlace> first_of_sheet(const WorldRay& ray) const;

  const PreparedMesh& mesh_;
  const TriangleBvh bvh_;
  const double thicken_;
  std::vector<std::array<std::uint32_t, 2>> open_edges_; // smaller vertex first, ascending
  std::vector<bool> open_vertices_;
};

// The trilinear interpolant of a grid's samples, by the exact intersector.
class GridTruth : public SurfaceTruth {
 public:
  explicit GridTruth(const LevelSet& level_set); // keeps the reference

  Box3d bounds() const override { return bounds_; } // of the band
  std::optional<TruePlace> first_place(const WorldRay& ray) const override;
  double distance(const Vec3d& p, double at_most) const override;
  Vec3d normal(const Vec3d& p) const override;

 private:
  const LevelSet& level_set_;
  Box3d bounds_;
};

// The distance from a point to the zero set of a grid's interpolant: an upper bound, the nearest crossing on
// the lines through the point along the interpolant's gradient and along `normal` (which may be zero) and,
// where that is more than an eighth of a voxel, towards where Newton's steps lead and along 13 directions all
// about; no larger than `bound` (world units, finite). On a plane it is the distance; where the surface is
// curved or creased the nearest place may lie between the lines.
double distance_to_zero_set(const LevelSet& level_set, const Vec3d& p, const Vec3d& normal, double bound);

} // namespace levelray
