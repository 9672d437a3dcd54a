// Triangles from polygons: ear clipping for concave ones.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace levelray {

// Cuts polygons of at least four corners into triangles over the same corners.
//
// Source: G. H. Meisters, "Polygons have ears", Amer. Math. Monthly 82 (1975); only reflex corners can lie in
// an ear (D. Eberly, "Triangulation by Ear Clipping", 2002, section 2). Ours works in the coordinate plane in
// which the polygon's Newell normal is largest (I. E. Sutherland et al., "A characterization of ten hidden-
// surface algorithms", 1974, credit M. Newell): dropping a coordinate is exact, and it keeps convexity, order
// along lines and containment of a planar polygon. Holes that are joined to the outline by a bridge (corners
// that occur twice) are handled by looking at the directions in which a coincident corner goes on.
//
// A polygon that is not simple (it crosses itself) still gives a fan of its remaining corners: every choice
// of triangles has the outline as its boundary, so neighbours stay connected.
class PolygonTriangulator {
 public:
  struct Result {
    bool simple = true;   // no triangle is turned against the polygon
    double deviation = 0; // world units: largest distance of a corner from the polygon's mean plane
  };

  // `points` in order, finite. Sets `triangles` to points.size() - 2 triples of positions in `points`, turned
  // as the polygon is. A convex polygon gives the fan around its first corner.
  Result triangulate(const std::vector<Vec3d>& points, std::vector<Triangle>& triangles);

  // Tests of a corner against an ear so far: grows with the square of a polygon's corners at worst. Beyond
  // max_work, some seconds, polygons become fans, and the caller should refuse the mesh.
  static constexpr std::uint64_t max_work = 1'000'000'000;
  std::uint64_t work() const noexcept { return work_; }

 private:
  struct Point {
    double x, y;
  };

  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept;
  void mark(std::uint32_t corner);
  bool is_ear(std::uint32_t b, bool strict);
  bool blocks(std::uint32_t p, std::uint32_t a, std::uint32_t b, std::uint32_t c, bool strict) const noexcept;
  bool clip_ears(std::vector<Triangle>& triangles);

  std::vector<Vec3d> scaled_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> previous_, next_;
  std::vector<std::uint32_t> reflex_;   // corners that may block an ear
  std::vector<std::uint8_t> may_block_; // per corner: still in the outline, and not strictly convex
  std::uint64_t work_ = 0;
};

} // namespace levelray
