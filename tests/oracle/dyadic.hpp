// Exact numbers: integers times powers of two. Every double is one; sums and products are exact.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace levelray::test {

class Dyadic {
 public:
  Dyadic() = default;
  Dyadic(double x) { // implicit: doubles are exact; must be finite
    if (x == 0) return;
    int exponent = 0;
    mantissa_ = static_cast<long long>(std::ldexp(std::frexp(x, &exponent), 53));
    exponent_ = exponent - 53;
    strip();
  }

  int sign() const { return mantissa_.sign(); }
  Dyadic operator-() const { return Dyadic(-mantissa_, exponent_); }
  Dyadic halved() const { return Dyadic(mantissa_, exponent_ - 1); }

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    if (a.exponent_ < b.exponent_) return b + a;
    return Dyadic((a.mantissa_ << (a.exponent_ - b.exponent_)) + b.mantissa_, b.exponent_);
  }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    return Dyadic(a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_);
  }

  // mantissa * 2^exponent with a mantissa of at most 64 bits: off by less than 2^-63 of the value.
  struct Rounded {
    long double mantissa = 0;
    int exponent = 0;
  };
  Rounded rounded() const {
    if (sign() == 0) return {};
    const Integer size = abs(mantissa_);
    const int bits = static_cast<int>(msb(size)) + 1, shift = bits > 64 ? bits - 64 : 0;
    const auto top = static_cast<unsigned long long>(size >> shift);
    return {sign() * static_cast<long double>(top), exponent_ + shift};
  }
  long double approximate() const {
    const Rounded r = rounded();
    return std::ldexp(r.mantissa, r.exponent);
  }

 private:
  // Up to 1024 bits, which most have, without memory of their own.
  using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<1024>,
                                                boost::multiprecision::et_off>;
  Dyadic(Integer mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}
  void strip() {
    const auto zeros = static_cast<int>(lsb(abs(mantissa_)));
    mantissa_ >>= zeros;
    exponent_ += zeros;
  }

  Integer mantissa_ = 0;
  int exponent_ = 0;
};

// a / b in long double, off by less than 2^-61 of itself.
inline long double quotient(const Dyadic& a, const Dyadic& b) {
  const Dyadic::Rounded x = a.rounded(), y = b.rounded();
  return x.mantissa == 0 ? 0 : std::ldexp(x.mantissa / y.mantissa, x.exponent - y.exponent);
}

} // namespace levelray::test
