// Exact numbers: integers times powers of two. Every double is one; sums and products of them are, too.
//
// For judging, where a sign must be beyond doubt: no rounding, no overflow, no underflow, and nothing in
// common with the sums of doubles that tracing proves its signs by (trace/double_double.hpp). Slow.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace levelray {

class ExactNumber {
 public:
  ExactNumber() = default;
  // Any finite double.
  explicit ExactNumber(double x) {
    if (x == 0) return;
    sign_ = x < 0 ? -1 : 1;
    int exponent = 0;
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(x), &exponent), 53));
    exponent -= 53;
    place_ = exponent >> 5;
    const int shift = exponent & 31;
    const std::uint64_t low = (mantissa & 0xFFFFFFFFu) << shift;
    const std::uint64_t high = ((mantissa >> 32) << shift) + (low >> 32);
    digits_ = {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high),
               static_cast<std::uint32_t>(high >> 32)};
    trim();
  }

  int sign() const { return sign_; }

  friend ExactNumber operator-(ExactNumber x) {
    x.sign_ = -x.sign_;
    return x;
  }
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    if (!a.sign_) return b;
    if (!b.sign_) return a;
    // Both as digits from the lower place on, two more for carries.
    const int place = std::min(a.place_, b.place_), top = std::max(a.top(), b.top()) + 1;
    ExactNumber sum;
    sum.place_ = place;
    sum.digits_.resize(static_cast<std::size_t>(top - place));
    std::int64_t carry = 0;
    for (int i = place; i < top; ++i) {
      carry += a.sign_ * a.digit(i) + b.sign_ * b.digit(i);
      sum.digits_[static_cast<std::size_t>(i - place)] = static_cast<std::uint32_t>(carry & 0xFFFFFFFF);
      carry >>= 32;
    }
    sum.sign_ = 1;
    if (carry < 0) { // two's complement of a negative number
      sum.sign_ = -1;
      std::uint64_t one = 1;
      for (std::uint32_t& d : sum.digits_) {
        one += static_cast<std::uint32_t>(~d);
        d = static_cast<std::uint32_t>(one);
        one >>= 32;
      }
    }
    sum.trim();
    return sum;
  }
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) { return a + -b; }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    ExactNumber product;
    if (!a.sign_ || !b.sign_) return product;
    product.sign_ = a.sign_ * b.sign_;
    product.place_ = a.place_ + b.place_;
    product.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.digits_.size(); ++j) {
        carry += std::uint64_t{a.digits_[i]} * b.digits_[j] + product.digits_[i + j];
        product.digits_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
      product.digits_[i + b.digits_.size()] = static_cast<std::uint32_t>(carry);
    }
    product.trim();
    return product;
  }

 private:
  int top() const { return place_ + static_cast<int>(digits_.size()); }
  std::int64_t digit(int i) const {
    return i >= place_ && i < top() ? digits_[static_cast<std::size_t>(i - place_)] : 0;
  }
  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
    std::size_t zeros = 0;
    while (zeros < digits_.size() && digits_[zeros] == 0) ++zeros;
    digits_.erase(digits_.begin(), digits_.begin() + static_cast<std::ptrdiff_t>(zeros));
    place_ += static_cast<int>(zeros);
    if (digits_.empty()) sign_ = 0, place_ = 0;
  }

  std::vector<std::uint32_t> digits_; // of the size, lowest first
  int place_ = 0, sign_ = 0;          // sign * sum of digits[i] 2^(32 (i + place))
};

} // namespace levelray
