#include "levelray/field/polynomial_roots.hpp"

namespace levelray {

namespace {

constexpr int most_halvings = 60; // the interval is then 2^-60 of the first, about the last bit of t

// The Bernstein coefficients of p(low + (high - low) s) over s in [0,1].
Quartic bernstein_of(const Quartic& p, Extended low, Extended high) {
  // Taylor's coefficients at `low`, by Horner's scheme, scaled to the interval.
  Quartic c = p;
  for (std::size_t i = 0; i < quartic_degree; ++i)
    for (std::size_t j = quartic_degree; j-- > i;) c[j] += low * c[j + 1];
  Extended scale = 1;
  for (Extended& x : c) x *= scale, scale *= high - low;
  // b_i = sum_j C(i,j) / C(n,j) c_j.
  constexpr Extended choose[5][5] = {
      {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};
  Quartic b{};
  for (std::size_t i = 0; i <= quartic_degree; ++i)
    for (std::size_t j = 0; j <= i; ++j) b[i] += choose[i][j] / choose[quartic_degree][j] * c[j];
  return b;
}

class Isolation {
 public:
  Isolation(const Quartic& b, Crossings& result) : result_(result) {
    for (const Extended x : b) error_ = std::max(error_, std::fabs(x));
    error_ *= 0x1p-64L * most_halvings * quartic_degree;
  }

  // Of the piece [low, high] with these coefficients; left parts first, so roots come out in their order.
  void search(const Quartic& b, Extended low, Extended high, int halvings) {
    int changes = 0, last = 0;
    bool sure = true;
    for (const Extended x : b) {
      const int sign = x > error_ ? 1 : x < -error_ ? -1 : 0;
      sure = sure && sign != 0;
      if (sign == 0) continue;
      changes += last != 0 && sign != last;
      last = sign;
    }
    if (sure && changes == 0) return;
    if (sure && changes == 1) {
      bisect(b, low, high);
      return;
    }
    if (halvings == most_halvings) {
      // Where the ends differ in sign there is a crossing here, whatever else there is.
      if (sure && std::signbit(b.front()) != std::signbit(b.back())) result_.at.push_back((low + high) / 2);
      result_.undecided = true;
      return;
    }
    Quartic left, right;
    halve(b, left, right);
    const Extended middle = (low + high) / 2;
    search(left, low, middle, halvings + 1);
    search(right, middle, high, halvings + 1);
  }

 private:
  static void halve(Quartic b, Quartic& left, Quartic& right) {
    for (std::size_t i = 0; i <= quartic_degree; ++i) {
      left[i] = b[0];
      right[quartic_degree - i] = b[quartic_degree - i];
      for (std::size_t j = 0; j + i < quartic_degree; ++j) b[j] = (b[j] + b[j + 1]) / 2;
    }
  }

  void bisect(Quartic b, Extended low, Extended high) {
    const bool positive = b.front() > 0;
    for (int step = 0; step < 64; ++step) {
      Quartic left, right;
      halve(b, left, right);
      const Extended middle = (low + high) / 2;
      if ((left.back() > 0) == positive)
        b = right, low = middle;
      else
        b = left, high = middle;
    }
    result_.at.push_back((low + high) / 2);
  }

  Crossings& result_;
  Extended error_ = 0;
};

} // namespace

Crossings crossings_of(const Quartic& polynomial, Extended low, Extended high) {
  Crossings result;
  if (!(low < high)) return result;
  const Quartic b = bernstein_of(polynomial, low, high);
  Isolation(b, result).search(b, low, high, 0);
  return result;
}

} // namespace levelray
