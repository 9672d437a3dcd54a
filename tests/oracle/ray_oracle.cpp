#include "oracle/ray_oracle.hpp"

#include "oracle/real_bernstein.hpp"

#include <algorithm>
#include <cmath>

namespace levelray::test {

namespace {

// Isolates the roots of a cubic known to within `bound`; false where that is not enough.
bool isolate(const RealBernstein& f, Real bound, Real low, Real high, int depth,
             std::vector<std::pair<Real, Real>>& intervals) {
  int sign[4];
  for (int k = 0; k < 4; ++k) sign[k] = f.b[k] > bound ? 1 : f.b[k] < -bound ? -1 : 0;
  if (!sign[0] || !sign[3] || depth == 40) return false;
  if (sign[0] == sign[3] && sign[1] == sign[0] && sign[2] == sign[0]) return true;
  if (sign[0] != sign[3] && (sign[1] == sign[0] || sign[2] == sign[3])) {
    intervals.emplace_back(low, high);
    return true;
  }
  const Real m0 = (f.b[0] + f.b[1]) / 2, m1 = (f.b[1] + f.b[2]) / 2, m2 = (f.b[2] + f.b[3]) / 2;
  const Real n0 = (m0 + m1) / 2, n1 = (m1 + m2) / 2, top = (n0 + n1) / 2, middle = (low + high) / 2;
  return isolate({{f.b[0], m0, n0, top}}, bound, low, middle, depth + 1, intervals) &&
         isolate({{top, n1, m2, f.b[3]}}, bound, middle, high, depth + 1, intervals);
}

// The root of f in an interval at whose ends its signs differ, and how far off that may be.
std::pair<Real, Real> refined(const RealBernstein& f, Real bound, Real low, Real high) {
  const Real sign = f(low) > 0 ? 1 : -1;
  Real from = low, to = high, f_from = sign * f(low), f_to = sign * f(high);
  for (int step = 0; step < 90 && to - from > 0x1p-62L; ++step) {
    // False position, halving every third step.
    Real u = step % 3 == 2 ? (from + to) / 2 : from + (to - from) * (f_from / (f_from - f_to));
    if (!(u > from && u < to)) u = (from + to) / 2;
    if (u == from || u == to) break;
    const Real value = sign * f(u);
    if (value > 0)
      from = u, f_from = value;
    else
      to = u, f_to = value;
  }
  const Real root = (from + to) / 2;
  for (Real away = std::max<Real>(to - from, 0x1p-62L);; away *= 4) {
    const Real left = std::max(low, root - away), right = std::min(high, root + away);
    if ((left == low || sign * f(left) > bound) && (right == high || sign * f(right) < -bound))
      return {root, away};
  }
}

} // namespace

RayOracle::RayOracle(const BlockGrid& grid) : transform_(grid.transform) {
  std::size_t count = 1;
  for (int a = 0; a < 3; ++a) {
    low_[a] = grid.node_min[a] * node_dim - 1;
    size_[a] = grid.node_dims[a] * node_dim + 2;
    count *= static_cast<std::size_t>(size_[a]);
  }
  samples_.resize(count);
  crossed_.resize(count);
  std::size_t at = 0;
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x) samples_[at++] = grid.value(low_[0] + x, low_[1] + y, low_[2] + z);
  at = 0;
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x, ++at) {
        if (x + 1 == size_[0] || y + 1 == size_[1] || z + 1 == size_[2]) continue;
        bool negative = false, positive = false;
        for (int c = 0; c < 8; ++c) {
          const float v = *corner(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          negative |= v <= 0;
          positive |= v >= 0;
        }
        crossed_[at] = negative && positive;
      }
}

const float* RayOracle::corner(int x, int y, int z) const {
  return &samples_[static_cast<std::size_t>(x) +
                   static_cast<std::size_t>(size_[0]) *
                       (static_cast<std::size_t>(y) + static_cast<std::size_t>(size_[1]) * z)];
}

void RayOracle::corners(const int (&cell)[3], float (&f)[8]) const {
  for (int c = 0; c < 8; ++c)
    f[c] =
        *corner(cell[0] - low_[0] + (c & 1), cell[1] - low_[1] + (c >> 1 & 1), cell[2] - low_[2] + (c >> 2));
}

// All cells, or all crossed ones, within the line's margin in [from, to], with the piece of the line in each,
// in order of their middles; `in` may be a little above `out` for those that are barely touched or missed.
// Which cells, is found out in double with a margin to spare: 2^-20 voxel, and 2^-46 of the distances for its
// rounding.
void RayOracle::cells_near(const Line& line, std::vector<Cell>& cells, Real from, Real to,
                           Which which) const {
  cells.clear();
  const int m = line.main, u = (m + 1) % 3, v = (m + 2) % 3;
  const int step = line.d[m] > 0 ? 1 : -1, count = size_[m] - 1;
  // The slabs that [from, to] reaches.
  const auto slab_at = [&](Real t) {
    const int slab = index_of(line.o[m] + t * line.d[m]) - low_[m];
    return step > 0 ? slab : count - 1 - slab;
  };
  const int first = std::max(0, slab_at(from) - 1), last = std::min(count - 1, slab_at(to) + 1);
  // Coordinates in the dense copy by that along the main axis.
  double slope[3], base[3];
  for (const int a : {u, v}) {
    const Real s = line.d[a] / line.d[m];
    slope[a] = static_cast<double>(s);
    base[a] = static_cast<double>(line.o[a] - low_[a] + (low_[m] - line.o[m]) * s);
  }
  const double margin = 0x1p-20 + 0x1p+14 * static_cast<double>(line.place_error);
  for (int n = first; n <= last; ++n) {
    const int slab = step > 0 ? n : count - 1 - n;
    int begin[3], end[3];
    bool any = true;
    for (const int a : {u, v}) {
      const double p0 = base[a] + slab * slope[a], p1 = p0 + slope[a];
      const double low = std::min(p0, p1) - margin, high = std::max(p0, p1) + margin;
      any &= high >= 0 && low < size_[a] - 1;
      begin[a] = static_cast<int>(std::max(low, 0.0));
      end[a] = static_cast<int>(std::min(high, size_[a] - 2.0));
    }
    if (!any) continue;
    const std::size_t old = cells.size();
    int at[3];
    at[m] = slab;
    for (at[v] = begin[v]; at[v] <= end[v]; ++at[v])
      for (at[u] = begin[u]; at[u] <= end[u]; ++at[u]) {
        if (which == Which::crossed &&
            !crossed_[static_cast<std::size_t>(corner(at[0], at[1], at[2]) - samples_.data())])
          continue;
        Cell cell{{at[0] + low_[0], at[1] + low_[1], at[2] + low_[2]}, from, to};
        for (int a = 0; a < 3; ++a) {
          if (line.d[a] == 0) continue; // who needs to know looks again
          const Real s0 = (cell.at[a] - line.o[a]) / line.d[a], s1 = (cell.at[a] + 1 - line.o[a]) / line.d[a];
          cell.in = std::max(cell.in, std::min(s0, s1));
          cell.out = std::min(cell.out, std::max(s0, s1));
        }
        cells.push_back(cell);
      }
    if (cells.size() > old + 1)
      std::sort(cells.begin() + static_cast<std::ptrdiff_t>(old), cells.end(),
                [](const Cell& a, const Cell& b) { return a.in + a.out < b.in + b.out; });
  }
}

// False where anything is in doubt.
bool RayOracle::roots_by_long_double(const WorldRay& ray, const Line& line, OracleAnswer& answer) const {
  thread_local std::vector<Cell> cells;
  thread_local std::vector<std::pair<Real, Real>> intervals;
  answer.first_sign = start_sign(ray);
  if (answer.first_sign == 0) return false;
  int sign = answer.first_sign;
  cells_near(line, cells, line.t_min, line.t_max, Which::crossed);
  Real covered = line.t_min - 1;
  for (const Cell& cell : cells) {
    float f[8];
    corners(cell.at, f);
    float largest = 0;
    for (const float v : f) largest = std::max(largest, std::fabs(v));
    // Thirty roundings of 2^-64, and |df/dx| <= 2 M per axis times the error of the place.
    const Real bound = Real(largest) * (0x1p-58L + 8 * line.place_error);
    Real p[3], q[3], length = 0;
    bool beside = false;
    for (int a = 0; a < 3; ++a) {
      p[a] = line.o[a] + cell.in * line.d[a] - cell.at[a];
      q[a] = line.o[a] + cell.out * line.d[a] - cell.at[a];
      length = std::max(length, std::fabs(q[a] - p[a]));
      if (line.d[a] != 0) continue;
      beside |= p[a] < -line.place_error || p[a] > 1 + line.place_error;
    }
    if (beside || cell.out <= covered) continue; // in a face: the cell on the other side said it all
    if (cell.in > cell.out || length <= 16 * line.place_error) {
      if (cell.in > cell.out && length > 16 * line.place_error) continue;
      // Barely met: only its sign can matter, which it has from its neighbours if it is not near 0.
      const Real value = along(f, p, q).b[0];
      if (!(std::fabs(value) > 32 * bound)) return false;
      continue;
    }
    covered = cell.out;
    const RealBernstein cubic = along(f, p, q);
    if (!((cubic.b[0] > bound && sign > 0) || (cubic.b[0] < -bound && sign < 0))) return false;
    intervals.clear();
    if (!isolate(cubic, bound, 0, 1, 0, intervals)) return false;
    for (const auto& [low, high] : intervals) {
      const auto [u, error] = refined(cubic, bound, low, high);
      sign = -sign;
      OracleRoot root;
      root.t = cell.in + u * (cell.out - cell.in);
      root.error = error * (cell.out - cell.in) + 0x1p-61L * (std::fabs(cell.in) + std::fabs(cell.out));
      root.sign_after = sign;
      answer.roots.push_back(root);
    }
  }
  answer.last_sign = sign;
  return true;
}

// The ray where the dense copy is, in [from, to].
RayOracle::Line RayOracle::line_of(const WorldRay& ray, Real from, Real to) const {
  Line line;
  line.t_min = from, line.t_max = to;
  Real distances = 0;
  line.main = 0;
  for (int a = 0; a < 3; ++a) {
    const Real h = transform_.voxel_size;
    line.o[a] = (Real(ray.origin[a]) - transform_.origin[a]) / h;
    line.d[a] = Real(ray.direction[a]) / h;
    distances = std::max({distances, std::fabs(line.o[a]), std::fabs(Real(transform_.origin[a]) / h),
                          std::fabs(Real(low_[a])) + size_[a]});
    if (std::fabs(line.d[a]) > std::fabs(line.d[line.main])) line.main = a;
  }
  line.place_error = 0x1p-60L * distances; // some ten roundings of 2^-64 of coordinates
  for (int a = 0; a < 3; ++a) {
    const Real low = low_[a] - 1, high = low_[a] + size_[a];
    if (line.d[a] == 0) {
      line.empty |= line.o[a] < low || line.o[a] > high;
      continue;
    }
    const Real s0 = (low - line.o[a]) / line.d[a], s1 = (high - line.o[a]) / line.d[a];
    line.t_min = std::max(line.t_min, std::min(s0, s1));
    line.t_max = std::min(line.t_max, std::max(s0, s1));
  }
  line.empty |= !(line.t_min <= line.t_max);
  return line;
}

OracleAnswer RayOracle::ask(const WorldRay& ray, bool exactly) const {
  OracleAnswer answer;
  const Line line = line_of(ray, ray.t_min, ray.t_max);
  if (line.empty) return answer; // everything is outside
  if (!exactly && roots_by_long_double(ray, line, answer)) return answer;
  roots_exactly(ray, line, exactly, answer);
  return answer;
}

int RayOracle::start_sign(const WorldRay& ray) const {
  return std::isfinite(ray.t_min) ? sign_at(ray, ray.t_min) : 1;
}

Real RayOracle::least(const WorldRay& ray, int side, Real from, Real to) const {
  Real result = 1e30L;
  const Line line = line_of(ray, from, to);
  if (line.empty) return result;
  std::vector<Cell> cells;
  cells_near(line, cells, line.t_min, line.t_max, Which::all);
  for (const Cell& cell : cells) {
    if (cell.in > cell.out) continue;
    float f[8];
    corners(cell.at, f);
    Real p[3], q[3];
    for (int a = 0; a < 3; ++a) {
      p[a] = std::clamp<Real>(line.o[a] + cell.in * line.d[a] - cell.at[a], 0, 1);
      q[a] = std::clamp<Real>(line.o[a] + cell.out * line.d[a] - cell.at[a], 0, 1);
    }
    const RealBernstein cubic = along(f, p, q);
    const Real d0 = cubic.b[1] - cubic.b[0], d1 = cubic.b[2] - cubic.b[1], d2 = cubic.b[3] - cubic.b[2];
    result = std::min({result, side * cubic.b[0], side * cubic.b[3]});
    // d0 (1-u)^2 + 2 d1 (1-u) u + d2 u^2 = 0.
    const Real A = d0 - 2 * d1 + d2, B = d1 - d0, D = B * B - A * d0;
    if (D < 0) continue;
    const Real k = -(B + std::copysign(std::sqrt(D), B));
    for (const Real u : {k / A, d0 / k})
      if (u > 0 && u < 1) result = std::min(result, side * cubic(u));
  }
  return result;
}

} // namespace levelray::test
