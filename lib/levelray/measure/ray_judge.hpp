// Who is right about a ray, decided without any code of the tracer.
//
// f is the trilinear interpolant of the grid's samples along the true ray o + t d, all of these numbers taken
// as the reals that they are. A plain loop over the unit slabs of the ray's main axis looks at every cell
// near the line, through BlockGrid::value alone, and at the cubic there in long double (64 bits of mantissa
// on x86-64); places are judged by signs in exact numbers (exact_number.hpp).
//
// The tests have an oracle that isolates all roots of every ray in exact numbers (tests/oracle); soaks use
// it. It needs a dense copy of the grid, and Boost; the shipped program judges grids of any extent by this
// one, which tells what a tracer may say, rather than all there is to know: with `margin` what a value of f
// may be off by according to the documentation (trace/certified_hit.hpp: rounding of coefficients and
// places),
//   earliest  the first t with side * f <= margin: no hit is right before it,
//   latest    the first t with side * f <= -margin: a hit is owed by then.
// Both are the same place but for a rounding where the ray crosses the surface at an angle.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/field/field.hpp"
#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <vector>

namespace levelray {

struct RayAnswer {
  // +1 outside, -1 inside; 0: f is within the margin of 0 where the ray begins, and either will do.
  int side = 1;
  Extended earliest = std::numeric_limits<Extended>::infinity(); // t; infinite: no hit is right
  Extended latest = std::numeric_limits<Extended>::infinity();   // t; infinite: none is owed
  Extended root = std::numeric_limits<Extended>::infinity(); // the first t with side * f <= 0, for side != 0
  Extended per_voxel = 0;                                    // t per voxel along the ray's largest component
  Extended place_error = 0; // voxels: rounding of places that the documentation allows

  // Whether f crosses 0 so clearly that rounding moves the place by less than 2^-20 voxel.
  bool is_clear() const { return side != 0 && latest - earliest <= 0x1p-20L * per_voxel; }
};

class RayJudge {
 public:
  // The grid must outlive it. `rounding`: of the tracer's arithmetic, relative to round to nearest; 2 for the
  // other modes.
  explicit RayJudge(const BlockGrid& grid, double rounding = 1);

  // For rays that trace/trace.hpp takes for rays.
  RayAnswer ask(const WorldRay& ray) const;
  // The exact sign of f at o + t d, for finite t.
  int sign_at(const WorldRay& ray, double t) const;
  // f there, in long double, and what it may be off by according to the documentation.
  Extended value_at(const WorldRay& ray, double t, Extended& margin) const;

 private:
  struct Line;
  struct Cell;
  Line line_of(const WorldRay& ray) const;
  void cells_near(const Line& line, std::vector<Cell>& cells) const;
  bool corners(const Vec3i& cell, float (&f)[8]) const;

  const BlockGrid& grid_;
  Extended rounding_;
};

} // namespace levelray
