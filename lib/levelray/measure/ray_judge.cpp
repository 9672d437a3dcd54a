#include "levelray/measure/ray_judge.hpp"

#include "levelray/measure/exact_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

constexpr Extended infinite = std::numeric_limits<Extended>::infinity();

int index_of(Extended x) {
  return static_cast<int>(std::floor(std::clamp<Extended>(x, -0x1p30L, 0x1p30L)));
}

// f(u) = sum of C(3,k) (1-u)^(3-k) u^k b[k].
struct Cubic {
  Extended b[4];
};

// From point p to point q of a cell, from the values at the corners of the box that they span.
Cubic along(const float (&f)[8], const Extended (&p)[3], const Extended (&q)[3]) {
  Extended sums[4] = {0, 0, 0, 0};
  for (int ends = 0; ends < 8; ++ends) {
    Extended value = 0;
    for (int c = 0; c < 8; ++c) {
      Extended weight = f[c];
      for (int a = 0; a < 3; ++a) {
        const Extended x = ends >> a & 1 ? q[a] : p[a];
        weight *= c >> a & 1 ? x : 1 - x;
      }
      value += weight;
    }
    sums[(ends & 1) + (ends >> 1 & 1) + (ends >> 2)] += value;
  }
  return {{sums[0], sums[1] / 3, sums[2] / 3, sums[3]}};
}

// The first u in [0,1] with f(u) <= 0, or infinity, by halving (Lane and Riesenfeld 1981). Where 2^-62 of the
// piece cannot tell a touch from a near miss, `doubt` decides.
Extended first_not_positive(const Cubic& f, bool doubt, Extended from = 0, Extended size = 1, int depth = 0) {
  const Extended(&b)[4] = f.b;
  if (b[0] <= 0) return from;
  if (b[1] > 0 && b[2] > 0 && b[3] > 0) return infinite;
  if (depth == 62) return doubt || b[3] <= 0 ? from : infinite;
  const Extended m0 = (b[0] + b[1]) / 2, m1 = (b[1] + b[2]) / 2, m2 = (b[2] + b[3]) / 2;
  const Extended n0 = (m0 + m1) / 2, n1 = (m1 + m2) / 2, top = (n0 + n1) / 2;
  const Extended left = first_not_positive({{b[0], m0, n0, top}}, doubt, from, size / 2, depth + 1);
  if (left < infinite) return left;
  return first_not_positive({{top, n1, m2, b[3]}}, doubt, from + size / 2, size / 2, depth + 1);
}

Cubic oriented(const Cubic& f, int side, Extended less) {
  Cubic result;
  for (int k = 0; k < 4; ++k) result.b[k] = side * f.b[k] - less;
  return result;
}

} // namespace

// In voxels, sample (i,j,k) at (i,j,k).
struct RayJudge::Line {
  Extended o[3], d[3];
  Extended t_min, t_max; // where there are samples, and a voxel more
  Extended place_error = 0;
  int main = 0;
  bool empty = false;

  Extended at(int a, Extended t) const { return o[a] + t * d[a]; }
};

struct RayJudge::Cell {
  Vec3i at;
  Extended in, out;      // t
  float largest, nearby; // |corner| of it, and of the cells about it along the line
  Cubic f;
};

RayJudge::RayJudge(const BlockGrid& grid, double rounding) : grid_(grid), rounding_(rounding) {}

// False where nothing but the background's size is there, all of one sign.
bool RayJudge::corners(const Vec3i& cell, float (&f)[8]) const {
  bool negative = false, positive = false;
  for (int c = 0; c < 8; ++c) {
    f[c] = grid_.value(cell.x + (c & 1), cell.y + (c >> 1 & 1), cell.z + (c >> 2));
    negative |= !(f[c] >= grid_.background);
    positive |= !(f[c] <= -grid_.background);
  }
  return negative && positive;
}

RayJudge::Line RayJudge::line_of(const WorldRay& ray) const {
  Line line;
  line.t_min = ray.t_min, line.t_max = ray.t_max;
  const Extended h = grid_.transform.voxel_size;
  Extended low[3], high[3], distances = 0;
  for (int a = 0; a < 3; ++a) {
    line.o[a] = (Extended(ray.origin[a]) - grid_.transform.origin[a]) / h;
    line.d[a] = Extended(ray.direction[a]) / h;
    low[a] = Extended(grid_.node_min[a]) * node_dim - 2;
    high[a] = (Extended(grid_.node_min[a]) + grid_.node_dims[a]) * node_dim + 1;
    distances = std::max(distances, std::fabs(Extended(ray.origin[a])) / h +
                                        std::fabs(Extended(grid_.transform.origin[a])) / h +
                                        std::fabs(low[a]) + grid_.node_dims[a] * Extended(node_dim));
    if (std::fabs(line.d[a]) > std::fabs(line.d[line.main])) line.main = a;
  }
  for (int a = 0; a < 3; ++a) {
    if (line.d[a] == 0) {
      line.empty |= !(line.o[a] >= low[a] && line.o[a] <= high[a]);
      continue;
    }
    const Extended s0 = (low[a] - line.o[a]) / line.d[a], s1 = (high[a] - line.o[a]) / line.d[a];
    line.t_min = std::max(line.t_min, std::min(s0, s1));
    line.t_max = std::min(line.t_max, std::max(s0, s1));
  }
  line.empty |= !(line.t_min <= line.t_max);
  // As in certified_hit.hpp, whose unit of distances along the ray is up to two voxels long.
  if (!line.empty) distances = std::max(distances, 2 * std::fabs(line.t_min * line.d[line.main]));
  line.place_error = rounding_ * 0x1p-48L * distances;
  return line;
}

// All cells that the line comes within place_error of, but for those that are surely all on one side; in the
// order of slabs.
void RayJudge::cells_near(const Line& line, std::vector<Cell>& cells) const {
  cells.clear();
  const int m = line.main, u = (m + 1) % 3, v = (m + 2) % 3, step = line.d[m] > 0 ? 1 : -1;
  const Extended pad = line.place_error;
  const int first = index_of(line.at(m, line.t_min) - step * pad),
            last = index_of(line.at(m, line.t_max) + step * pad);
  for (int slab = first; (last - slab) * step >= 0; slab += step) {
    Extended s0 = (slab - pad - line.o[m]) / line.d[m], s1 = (slab + 1 + pad - line.o[m]) / line.d[m];
    if (s0 > s1) std::swap(s0, s1);
    s0 = std::max(s0, line.t_min), s1 = std::min(s1, line.t_max);
    if (!(s0 <= s1)) continue;
    Vec3i low, high;
    low[m] = high[m] = slab;
    for (const int a : {u, v}) {
      const Extended p0 = line.at(a, s0), p1 = line.at(a, s1);
      low[a] = index_of(std::min(p0, p1) - pad), high[a] = index_of(std::max(p0, p1) + pad);
    }
    Vec3i at;
    for (at.z = low.z; at.z <= high.z; ++at.z)
      for (at.y = low.y; at.y <= high.y; ++at.y)
        for (at.x = low.x; at.x <= high.x; ++at.x) {
          Cell cell{at, s0, s1, 0, 0, {}};
          for (const int a : {u, v}) {
            if (line.d[a] == 0) continue;
            const Extended i0 = (at[a] - pad - line.o[a]) / line.d[a],
                           i1 = (at[a] + 1 + pad - line.o[a]) / line.d[a];
            cell.in = std::max(cell.in, std::min(i0, i1)), cell.out = std::min(cell.out, std::max(i0, i1));
          }
          float f[8];
          if (!(cell.in <= cell.out) || !corners(at, f)) continue;
          for (const float value : f) cell.largest = std::max(cell.largest, std::fabs(value));
          Extended p[3], q[3];
          for (int a = 0; a < 3; ++a) {
            p[a] = line.at(a, cell.in) - at[a]; // beyond the cell by place_error at most
            q[a] = line.at(a, cell.out) - at[a];
          }
          cell.f = along(f, p, q);
          cells.push_back(cell);
        }
  }
  // A tracer's place may lie in the next cell, whose values may be larger.
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t k = i < 8 ? 0 : i - 8; k < std::min(cells.size(), i + 9); ++k)
      if (cells[k].in <= cells[i].out && cells[i].in <= cells[k].out)
        cells[i].nearby = std::max(cells[i].nearby, cells[k].largest);
}

Extended RayJudge::value_at(const WorldRay& ray, double t, Extended& margin) const {
  const Line line = line_of(ray);
  Vec3i cell;
  Extended p[3];
  for (int a = 0; a < 3; ++a) {
    const Extended x = line.at(a, t);
    if (!(std::fabs(x) < 0x1p29L)) { // far outside
      margin = 0;
      return grid_.background;
    }
    cell[a] = index_of(x);
    p[a] = x - cell[a];
  }
  float f[8], largest = 0;
  // Places near a face may be taken for the next cell's.
  for (int c = 0; c < 27; ++c) {
    const int beside[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
    bool near = true;
    Vec3i other = cell;
    for (int a = 0; a < 3; ++a) {
      other[a] += beside[a];
      near &= beside[a] < 0 ? p[a] <= line.place_error : beside[a] == 0 || p[a] >= 1 - line.place_error;
    }
    if (!near) continue;
    corners(other, f);
    for (const float value : f) largest = std::max(largest, std::fabs(value));
  }
  corners(cell, f);
  margin = Extended(largest) * (rounding_ * 0x1p-44L + 8 * line.place_error);
  return along(f, p, p).b[0];
}

RayAnswer RayJudge::ask(const WorldRay& ray) const {
  RayAnswer answer;
  const Line line = line_of(ray);
  answer.per_voxel = 1 / std::fabs(line.d[line.main]);
  answer.place_error = line.place_error;
  if (line.empty) return answer;
  if (std::isfinite(ray.t_min)) {
    Extended margin = 0;
    const Extended value = value_at(ray, ray.t_min, margin);
    answer.side = value > margin ? 1 : value < -margin ? -1 : 0;
  }
  std::vector<Cell> cells;
  cells_near(line, cells);

  const auto first = [&](int side, int margins, bool doubt) {
    Extended result = infinite;
    for (const Cell& cell : cells) {
      if (cell.in >= result) continue;
      const Extended margin = Extended(cell.nearby) * (rounding_ * 0x1p-44L + 8 * line.place_error);
      const Extended u = first_not_positive(oriented(cell.f, side, margins * margin), doubt);
      if (u < infinite) result = std::min(result, cell.in + u * (cell.out - cell.in));
    }
    return result;
  };
  if (answer.side == 0) {
    answer.earliest = std::max<Extended>(ray.t_min, line.t_min);
    answer.latest = std::max(first(1, -1, false), first(-1, -1, false));
    return answer;
  }
  answer.earliest = first(answer.side, 1, true);
  answer.root = first(answer.side, 0, true);
  answer.latest = first(answer.side, -1, false);
  return answer;
}

int RayJudge::sign_at(const WorldRay& ray, double t) const {
  const ExactNumber h(grid_.transform.voxel_size), time(t);
  ExactNumber weight[3][2];
  Vec3i cell;
  for (int a = 0; a < 3; ++a) {
    const Extended near =
        (Extended(ray.origin[a]) - grid_.transform.origin[a] + Extended(t) * ray.direction[a]) /
        grid_.transform.voxel_size;
    if (!(std::fabs(near) < 0x1p29L)) return 1;
    cell[a] = index_of(near);
    const ExactNumber place = ExactNumber(ray.origin[a]) - ExactNumber(grid_.transform.origin[a]) +
                              ExactNumber(ray.direction[a]) * time;
    for (int attempt = 0; attempt < 4; ++attempt) { // long double may be off by one
      weight[a][1] = place - ExactNumber(cell[a]) * h;
      weight[a][0] = h - weight[a][1];
      cell[a] += weight[a][1].sign() < 0 ? -1 : weight[a][0].sign() < 0 ? 1 : 0;
      if (weight[a][1].sign() >= 0 && weight[a][0].sign() >= 0) break;
    }
  }
  float f[8];
  corners(cell, f);
  ExactNumber sum;
  for (int c = 0; c < 8; ++c)
    sum = sum + ExactNumber(double{f[c]}) * weight[0][c & 1] * weight[1][c >> 1 & 1] * weight[2][c >> 2];
  return sum.sign();
}

} // namespace levelray
