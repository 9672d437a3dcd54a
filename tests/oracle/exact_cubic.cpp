#include "oracle/exact_cubic.hpp"

#include <algorithm>

namespace levelray::test {

namespace {

int variations(const ExactCubic& c) {
  int changes = 0, last = 0;
  for (const Dyadic& b : c.b) {
    const int sign = b.sign();
    if (sign && last && sign != last) ++changes;
    if (sign) last = sign;
  }
  return changes;
}

// At u = x, by de Casteljau; the halves if they are wanted.
Dyadic value(const ExactCubic& c, const Dyadic& x, ExactCubic* left = nullptr, ExactCubic* right = nullptr) {
  const Dyadic rest = Dyadic(1) - x;
  const auto mix = [&](const Dyadic& a, const Dyadic& b) { return a * rest + b * x; };
  const Dyadic m0 = mix(c.b[0], c.b[1]), m1 = mix(c.b[1], c.b[2]), m2 = mix(c.b[2], c.b[3]);
  const Dyadic n0 = mix(m0, m1), n1 = mix(m1, m2), top = mix(n0, n1);
  if (left) *left = {{c.b[0], m0, n0, top}};
  if (right) *right = {{top, n1, m2, c.b[3]}};
  return top;
}

// The one root of a cubic whose ends have different strict signs, in long double, then proven.
ExactRoot refined(const ExactCubic& c) {
  long double b[4], scale = 0;
  int exponent = -1000000;
  for (const Dyadic& x : c.b)
    if (x.sign()) exponent = std::max(exponent, std::ilogb(x.rounded().mantissa) + x.rounded().exponent);
  for (int k = 0; k < 4; ++k) {
    const Dyadic::Rounded r = c.b[k].rounded();
    b[k] = r.mantissa == 0 ? 0 : std::ldexp(r.mantissa, std::max(r.exponent - exponent, -16000));
    scale = std::max(scale, std::fabs(b[k]));
  }
  const int first = c.b[0].sign();
  long double low = 0, high = 1;
  for (int step = 0; step < 66; ++step) {
    const long double u = (low + high) / 2, r = 1 - u;
    const long double f = (b[0] * r + 3 * b[1] * u) * (r * r) + (3 * b[2] * r + b[3] * u) * (u * u);
    (f * static_cast<long double>(first) > 0 ? low : high) = u;
  }
  // Exact signs on both sides of the guess, ever farther from it.
  const double guess = static_cast<double>((low + high) / 2);
  const Dyadic centre = Dyadic(guess) + Dyadic(static_cast<double>((low + high) / 2 - guess));
  for (double away = 0x1p-62; away < 1; away *= 16) {
    const Dyadic left = centre - Dyadic(away), right = centre + Dyadic(away);
    const bool left_in = left.sign() > 0, right_in = (Dyadic(1) - right).sign() > 0;
    if ((!left_in || value(c, left).sign() == first) && (!right_in || value(c, right).sign() == -first))
      return {(low + high) / 2, away + 0x1p-63L, -first};
  }
  return {0.5L, 0.5L, -first};
}

// Roots of a cubic without repeated roots in (0,1), whose ends are not 0.
void isolate(const ExactCubic& c, long double low, long double size, std::vector<ExactRoot>& roots) {
  const int changes = variations(c);
  if (changes == 0) return;
  if (changes == 1) {
    ExactRoot root = refined(c);
    root.u = low + root.u * size;
    root.error = root.error * size + 0x1p-62L;
    roots.push_back(root);
    return;
  }
  // Halve, or cut elsewhere where the middle is a root.
  for (const double x : {0.5, 0.25, 0.75, 0.125}) {
    ExactCubic left, right;
    if (value(c, Dyadic(x), &left, &right).sign() == 0) continue;
    isolate(left, low, size * static_cast<long double>(x), roots);
    isolate(right, low + size * static_cast<long double>(x), size * (1 - static_cast<long double>(x)), roots);
    return;
  }
}

bool has_repeated_root(const Dyadic& a, const Dyadic& b, const Dyadic& c, const Dyadic& d) {
  const Dyadic n18(18), n4(4), n27(27);
  return (n18 * a * b * c * d - n4 * b * b * b * d + b * b * c * c - n4 * a * c * c * c - n27 * a * a * d * d)
             .sign() == 0;
}

} // namespace

std::vector<ExactRoot> exact_roots(const ExactCubic& cubic, int& sign_before) {
  std::vector<ExactRoot> roots;
  sign_before = cubic.b[0].sign();
  if (std::all_of(cubic.b, cubic.b + 4, [](const Dyadic& b) { return b.sign() == 0; }))
    return {{0, 0, 0}, {1, 0, 0}};
  if (sign_before && variations(cubic) == 0 && cubic.b[3].sign()) return roots;

  // a u^3 + b u^2 + c u + d.
  const Dyadic three(3);
  const Dyadic d = cubic.b[0], c = three * (cubic.b[1] - cubic.b[0]),
               b = three * (cubic.b[0] - cubic.b[1] - cubic.b[1] + cubic.b[2]),
               a = cubic.b[3] - cubic.b[0] + three * (cubic.b[1] - cubic.b[2]);
  const auto sign_at = [&](const Dyadic& p, const Dyadic& q) { // at u = p / q, q > 0
    return (((a * p + b * q) * p + c * q * q) * p + d * q * q * q).sign();
  };
  const auto add_fraction = [&](Dyadic p, Dyadic q) {
    if (q.sign() < 0) p = -p, q = -q;
    if (p.sign() < 0 || (q - p).sign() < 0) return;
    const long double u = quotient(p, q);
    roots.push_back({u, p.sign() == 0 || (q - p).sign() == 0 ? 0 : 0x1p-60L * u, 0});
  };

  const bool linear = a.sign() == 0 && b.sign() == 0;
  if (!linear && has_repeated_root(a, b, c, d)) {
    const Dyadic delta = b * b - three * a * c;
    if (delta.sign() == 0) {
      add_fraction(-b, three * a);
    } else {
      add_fraction(Dyadic(9) * a * d - b * c, Dyadic(2) * delta);
      if (a.sign()) add_fraction(Dyadic(4) * a * b * c - Dyadic(9) * a * a * d - b * b * b, a * delta);
    }
    std::sort(roots.begin(), roots.end(), [](const ExactRoot& x, const ExactRoot& y) { return x.u < y.u; });
  } else {
    // Take roots at the ends out: with b0 = 0 the cubic is u times a quadratic with coefficients b1, b2, b3
    // (times 3, 3/2, 1), raised again to a cubic.
    ExactCubic rest = cubic;
    const bool at_start = rest.b[0].sign() == 0;
    const auto divide_start = [&] {
      // 3 b1 (1-u)^2 + 3 b2 (1-u) u + b3 u^2, as quadratic Bernstein q0 = 3 b1, q1 = 3 b2 / 2, q2 = b3; times
      // 3 raised: q0 * 3, q0 + 2 q1, 2 q1 + q2, q2 * 3.
      const Dyadic q0 = three * rest.b[1], q1 = (three * rest.b[2]).halved(), q2 = rest.b[3];
      rest = {{three * q0, q0 + q1 + q1, q1 + q1 + q2, three * q2}};
    };
    if (at_start) {
      roots.push_back({0, 0, 0});
      divide_start();
    }
    const bool at_end = rest.b[3].sign() == 0;
    if (at_end) {
      std::swap(rest.b[0], rest.b[3]);
      std::swap(rest.b[1], rest.b[2]);
      divide_start();
      std::swap(rest.b[0], rest.b[3]);
      std::swap(rest.b[1], rest.b[2]);
    }
    isolate(rest, 0, 1, roots);
    if (at_end) roots.push_back({1, 0, 0});
  }

  // Signs between roots: in the middle of each gap, which roots' errors leave open.
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (roots[i].u == 1 && roots[i].error == 0) {
      roots[i].sign_after = 0;
      continue;
    }
    const bool last = i + 1 == roots.size();
    if (last) {
      roots[i].sign_after = cubic.b[3].sign();
      continue;
    }
    const long double middle = (roots[i].u + roots[i + 1].u) / 2;
    const double head = static_cast<double>(middle);
    roots[i].sign_after = sign_at(
        Dyadic(head) + Dyadic(static_cast<double>(middle - static_cast<long double>(head))), Dyadic(1));
  }
  return roots;
}

} // namespace levelray::test
