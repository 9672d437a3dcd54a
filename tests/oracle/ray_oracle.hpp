// The oracle: all roots of the interpolant along a ray, without any code of the tracer.
//
// f is the trilinear interpolant of the grid's samples along the true ray o + t d, all of them taken as the
// real numbers that they are. A plain loop goes over the unit slabs of the ray's main axis and, in each, over
// every cell near the line. What long double decides beyond its rounding stands; a ray with anything that it
// does not decide is done again with exact numbers (dyadic.hpp), so the answer is always the true one.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <vector>

namespace levelray::test {

using Real = long double;

struct OracleRoot {
  Real t = 0, error = 0; // |t - root| <= error
  bool touch = false;    // no change of sign: f comes to 0 and goes back, or is 0 at an end of the interval
  int sign_after = 1;
};

struct OracleAnswer {
  int first_sign = 1; // of f where the ray begins; on the surface: 0
  int last_sign = 1;  // where it ends
  bool exactly = false;
  std::vector<OracleRoot> roots; // in order
};

class RayOracle {
 public:
  explicit RayOracle(const BlockGrid& grid);

  // The ray's t_min and t_max may be infinite; everything else must be finite, the direction not zero.
  // `exactly`: by exact numbers throughout.
  OracleAnswer ask(const WorldRay& ray, bool exactly = false) const;
  // The sign of f at o + t d, for finite t.
  int sign_at(const WorldRay& ray, double t) const;
  // The least of side * f on the ray in [from, to], whether the surface crosses the cells there or not; in
  // long double, within 2^-50 of the largest sample. Large for a ray that stays beyond the samples.
  Real least(const WorldRay& ray, int side, Real from, Real to) const;

 private:
  // The ray in voxels, sample (i,j,k) at (i,j,k), in long double: off by 2^-62 of the distances.
  struct Line {
    Real o[3], d[3];
    Real t_min, t_max; // where the dense copy is, with a voxel's margin
    Real place_error;  // of a point, in voxels
    int main;
    bool empty = false;
  };
  // A cell, and the line's piece in it.
  struct Cell {
    int at[3];
    Real in, out;
  };
  Line line_of(const WorldRay& ray, Real from, Real to) const;
  enum class Which { crossed, all };
  void cells_near(const Line& line, std::vector<Cell>& cells, Real from, Real to, Which which) const;
  bool roots_by_long_double(const WorldRay& ray, const Line& line, OracleAnswer& answer) const;
  // `throughout`: even where long double is sure.
  void roots_exactly(const WorldRay& ray, const Line& line, bool throughout, OracleAnswer& answer) const;
  int sure_sign(const Line& line, const Cell& cell, const float (&f)[8], Real in, Real out) const;
  int start_sign(const WorldRay& ray) const;
  const float* corner(int x, int y, int z) const; // of the dense copy, from its own lowest corner
  void corners(const int (&cell)[3], float (&f)[8]) const;

  GridTransform transform_;
  int low_[3], size_[3]; // samples of the dense copy
  std::vector<float> samples_;
  std::vector<std::uint8_t> crossed_; // per cell: corners not all of one strict sign
};

} // namespace levelray::test
