// The oracle's answers by exact numbers, for rays that long double leaves in doubt.
#include "oracle/exact_cubic.hpp"
#include "oracle/ray_oracle.hpp"
#include "oracle/real_bernstein.hpp"

#include <algorithm>
#include <cmath>

namespace levelray::test {

namespace {

// A place on the ray: t = p / q, q > 0.
struct ExactTime {
  Dyadic p, q;
  int compare(const ExactTime& other) const { return (p * other.q - other.p * q).sign(); }
};

} // namespace

// The sign of f on a whole piece of the line, where long double is sure of it, within the bound that
// roots_by_long_double has; else 0.
int RayOracle::sure_sign(const Line& line, const Cell& cell, const float (&f)[8], Real in, Real out) const {
  float largest = 0;
  for (const float v : f) largest = std::max(largest, std::fabs(v));
  const Real bound = Real(largest) * (0x1p-58L + 8 * line.place_error);
  Real p[3], q[3];
  for (int a = 0; a < 3; ++a) {
    p[a] = line.o[a] + in * line.d[a] - cell.at[a];
    q[a] = line.o[a] + out * line.d[a] - cell.at[a];
  }
  const RealBernstein cubic = along(f, p, q);
  const auto [least, most] = std::minmax_element(cubic.b, cubic.b + 4);
  return *least > bound ? 1 : *most < -bound ? -1 : 0;
}

void RayOracle::roots_exactly(const WorldRay& ray, const Line& line, bool throughout,
                              OracleAnswer& answer) const {
  answer = {};
  answer.exactly = true;
  answer.first_sign = start_sign(ray);
  std::vector<Cell> cells;
  cells_near(line, cells, line.t_min, line.t_max, Which::crossed);
  const Dyadic h(transform_.voxel_size), one(1);
  Dyadic offset[3], d[3];
  for (int a = 0; a < 3; ++a) {
    offset[a] = Dyadic(ray.origin[a]) - Dyadic(transform_.origin[a]);
    d[a] = Dyadic(ray.direction[a]);
  }

  // Exact pieces of the ray in cells, sorted.
  struct Piece {
    Cell cell;
    ExactTime in, out;
  };
  std::vector<Piece> pieces;
  for (const Cell& cell : cells) {
    Piece piece{cell, {}, {}};
    bool has_in = false, has_out = false, empty = false;
    const auto begin_at = [&](const ExactTime& t) {
      if (!has_in || t.compare(piece.in) > 0) piece.in = t, has_in = true;
    };
    const auto end_at = [&](const ExactTime& t) {
      if (!has_out || t.compare(piece.out) < 0) piece.out = t, has_out = true;
    };
    if (std::isfinite(ray.t_min)) begin_at({Dyadic(ray.t_min), one});
    if (std::isfinite(ray.t_max)) end_at({Dyadic(ray.t_max), one});
    for (int a = 0; a < 3; ++a) {
      const Dyadic low = Dyadic(cell.at[a]) * h - offset[a], high = low + h;
      if (d[a].sign() == 0) {
        empty |= low.sign() > 0 || high.sign() < 0;
      } else if (d[a].sign() > 0) {
        begin_at({low, d[a]});
        end_at({high, d[a]});
      } else {
        begin_at({-high, -d[a]});
        end_at({-low, -d[a]});
      }
    }
    if (!empty && piece.in.compare(piece.out) <= 0) pieces.push_back(piece);
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    const int order = a.in.compare(b.in);
    return order < 0 || (order == 0 && a.out.compare(b.out) < 0);
  });

  // Follow the sign.
  int sign = answer.first_sign;
  bool at_zero = false;
  OracleRoot zero;
  const auto see_sign = [&](int s) {
    if (s == 0) return;
    if (at_zero) {
      zero.touch = sign == 0 || sign == s;
      zero.sign_after = s;
      answer.roots.push_back(zero);
    }
    sign = s;
    at_zero = false;
  };
  const auto see_zero = [&](Real t, Real error) {
    if (at_zero) return;
    at_zero = true;
    zero.t = t;
    zero.error = error;
  };
  const ExactTime* covered = nullptr;
  for (const Piece& piece : pieces) {
    // In a face or an edge: the cell on the other side said it all.
    if (covered && piece.in.compare(*covered) < 0) continue;
    covered = &piece.out;
    float f[8];
    corners(piece.cell.at, f);
    const Real in = quotient(piece.in.p, piece.in.q), out = quotient(piece.out.p, piece.out.q);
    if (const int sure = throughout ? 0 : sure_sign(line, piece.cell, f, in, out)) {
      see_sign(sure);
      continue;
    }
    // Homogeneous: with t = P / Q the weights are (offset - cell h) Q + d P and its complement to h Q.
    Dyadic weight[2][3][2];
    for (int end = 0; end < 2; ++end)
      for (int a = 0; a < 3; ++a) {
        const ExactTime& t = end ? piece.out : piece.in;
        weight[end][a][1] = (offset[a] - Dyadic(piece.cell.at[a]) * h) * t.q + d[a] * t.p;
        weight[end][a][0] = h * t.q - weight[end][a][1];
      }
    Dyadic blossom[2][2][2]; // by the ends that x, y, z are taken from
    for (int x = 0; x < 2; ++x) {
      Dyadic row[4];
      for (int r = 0; r < 4; ++r)
        row[r] = Dyadic(f[2 * r]) * weight[x][0][0] + Dyadic(f[2 * r + 1]) * weight[x][0][1];
      for (int y = 0; y < 2; ++y) {
        const Dyadic low = row[0] * weight[y][1][0] + row[1] * weight[y][1][1],
                     high = row[2] * weight[y][1][0] + row[3] * weight[y][1][1];
        for (int z = 0; z < 2; ++z) blossom[x][y][z] = low * weight[z][2][0] + high * weight[z][2][1];
      }
    }
    const Dyadic &qi = piece.in.q, &qo = piece.out.q;
    const Dyadic b0 = blossom[0][0][0] * qo * qo * qo, b3 = blossom[1][1][1] * qi * qi * qi;
    const Dyadic b1 = (blossom[1][0][0] + blossom[0][1][0] + blossom[0][0][1]) * qi * qo * qo;
    const Dyadic b2 = (blossom[1][1][0] + blossom[1][0][1] + blossom[0][1][1]) * qi * qi * qo;
    const Dyadic three(3);
    int before = 0;
    const std::vector<ExactRoot> roots = exact_roots({{three * b0, b1, b2, three * b3}}, before);
    const Real rounding = 0x1p-58L * (std::fabs(in) + std::fabs(out));
    see_sign(before);
    for (const ExactRoot& root : roots) {
      see_zero(in + root.u * (out - in), root.error * (out - in) + rounding);
      see_sign(root.sign_after);
    }
  }
  if (at_zero) {
    zero.touch = true;
    zero.sign_after = 0;
    answer.roots.push_back(zero);
  }
  answer.last_sign = at_zero ? 0 : sign;
}

int RayOracle::sign_at(const WorldRay& ray, double t) const {
  // Find the cell and the value in long double.
  int cell[3];
  Real p[3], distances = 0;
  for (int a = 0; a < 3; ++a) {
    const Real h = transform_.voxel_size;
    const Real o = (Real(ray.origin[a]) - transform_.origin[a]) / h,
               way = Real(t) * Real(ray.direction[a]) / h;
    const Real x = o + way;
    cell[a] = index_of(x);
    p[a] = x - cell[a];
    distances =
        std::max({distances, std::fabs(o), std::fabs(way), std::fabs(Real(transform_.origin[a]) / h)});
  }
  const auto beyond = [&] {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < low_[a] || cell[a] > low_[a] + size_[a] - 2) return true;
    return false;
  };
  const Real place_error = 0x1p-60L * distances;
  if (beyond() && place_error < 0.25L) return 1; // the copy has a layer of the outside all around
  float f[8];
  if (!beyond()) {
    corners(cell, f);
    float largest = 0;
    for (const float v : f) largest = std::max(largest, std::fabs(v));
    const Real value = along(f, p, p).b[0], bound = Real(largest) * (0x1p-58L + 8 * place_error);
    if (std::fabs(value) > bound) return value > 0 ? 1 : -1;
  }
  // Exactly.
  const Dyadic h(transform_.voxel_size), time(t);
  Dyadic weight[3][2];
  for (int a = 0; a < 3; ++a) {
    const Dyadic place =
        Dyadic(ray.origin[a]) - Dyadic(transform_.origin[a]) + Dyadic(ray.direction[a]) * time;
    for (int attempt = 0; attempt < 4; ++attempt) {
      weight[a][1] = place - Dyadic(cell[a]) * h;
      weight[a][0] = h - weight[a][1];
      if (weight[a][1].sign() < 0)
        --cell[a];
      else if (weight[a][0].sign() < 0)
        ++cell[a];
      else
        break;
    }
  }
  if (beyond()) return 1;
  corners(cell, f);
  Dyadic sum;
  for (int c = 0; c < 8; ++c)
    sum = sum + Dyadic(f[c]) * weight[0][c & 1] * weight[1][c >> 1 & 1] * weight[2][c >> 2];
  return sum.sign();
}

} // namespace levelray::test
