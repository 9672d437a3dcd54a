// Exact sums and products of doubles, and sums of two doubles as numbers of about 106 bits.
//
// Source: Dekker 1971; Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic", sections 2.2 to 2.4
// (two-sum, two-product by splitting, grow-expansion, compress). No fma, so that the bits do not depend on
// the build. Round to nearest; no overflow below 2^996 (splitting) and no underflow of terms above 2^-900.
#pragma once

#include <cmath>

namespace levelray {

struct DoubleDouble {
  double high = 0, low = 0; // |low| <= ulp(high) / 2
};

inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// |a| >= |b| or a = 0.
inline DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

inline DoubleDouble two_product(double a, double b) {
  const auto split = [](double x) {
    const double c = 134217729.0 * x, high = c - (c - x); // 2^27 + 1
    return DoubleDouble{high, x - high};
  };
  const double product = a * b;
  const DoubleDouble x = split(a), y = split(b);
  return {product, x.low * y.low - (((product - x.high * y.high) - x.low * y.high) - x.high * y.low)};
}

// Within 2^-104 (|a| + |b|) of the sum.
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.high, b.high);
  return fast_two_sum(sum.high, sum.low + (a.low + b.low));
}

// Within 2^-101 |a b| of the product.
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

// A sum of up to N doubles, exactly.
template <int N>
class ExactSum {
 public:
  ExactSum& operator+=(double x) {
    // Grow the expansion: its components do not overlap and ascend.
    for (int i = 0; i < count_; ++i) {
      const DoubleDouble sum = two_sum(x, component_[i]);
      component_[i] = sum.low;
      x = sum.high;
    }
    component_[count_++] = x;
    return *this;
  }
  ExactSum& operator+=(const DoubleDouble& x) { return (*this += x.low) += x.high; }

  // The sum, within 2^-103 of itself, exactly 0 where it is 0.
  DoubleDouble rounded() const {
    double packed[N], rest = component_[count_ - 1];
    int bottom = count_ - 1;
    for (int i = count_ - 2; i >= 0; --i) {
      const DoubleDouble sum = fast_two_sum(rest, component_[i]);
      if (sum.low != 0) {
        packed[bottom--] = sum.high;
        rest = sum.low;
      } else {
        rest = sum.high;
      }
    }
    packed[bottom] =
        rest; // components of `packed` from `bottom` on, ascending, none of them 0 but perhaps one
    DoubleDouble top{packed[count_ - 1], 0};
    if (bottom < count_ - 1) top = fast_two_sum(packed[count_ - 1], packed[count_ - 2]);
    return top;
  }

 private:
  double component_[N] = {};
  int count_ = 0;
};

} // namespace levelray
