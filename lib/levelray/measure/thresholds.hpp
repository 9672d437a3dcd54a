// When two pictures, or two grids, differ: the thresholds of OpenImageIO's `idiff`, by its names.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace levelray {

// Of things (pixels, samples) whose difference is a number >= 0, infinite when the values cannot be
// subtracted. Both are exceeded by numbers that are greater, as in idiff.
struct Thresholds {
  double fail = 1e-6;                                         // a thing fails that differs by more
  double fail_percent = 0;                                    // of all things may fail
  double hard_fail = std::numeric_limits<double>::infinity(); // no thing may differ by more
  std::uint64_t allow_failures = 0;                           // so many things may differ by any amount
  double warn = 1e-6;                                         // the same for warnings
  double warn_percent = 0;
  double hard_warn = std::numeric_limits<double>::infinity();
};

enum class Verdict { pass, warning, failure };

// Counts things by their difference and judges.
class ThresholdCount {
 public:
  explicit ThresholdCount(const Thresholds& thresholds) : t_(thresholds) {}

  // `times` things that differ by this.
  void add(double difference, std::uint64_t times = 1) {
    total_ += times;
    if (difference > t_.fail) failed_ += times;
    if (difference > t_.hard_fail) hard_failed_ += times;
    if (difference > std::min(t_.fail, t_.hard_fail)) off_ += times;
    if (difference > t_.warn) warned_ += times;
    if (difference > t_.hard_warn) hard_warned_ += times;
  }
  // Things without a difference.
  void add_equal(std::uint64_t times) { total_ += times; }

  std::uint64_t total() const { return total_; }
  std::uint64_t failed() const { return failed_; }
  std::uint64_t warned() const { return warned_; }
  double percent(std::uint64_t count) const {
    return total_ ? 100 * static_cast<double>(count) / static_cast<double>(total_) : 0;
  }

  // idiff applies -allowfailures to -fail alone; here the things allowed to differ "by any amount" (its
  // documentation) may exceed --hardfail, too.
  Verdict verdict() const {
    if (off_ > t_.allow_failures && (percent(failed_) > t_.fail_percent || hard_failed_ > 0))
      return Verdict::failure;
    return percent(warned_) > t_.warn_percent || hard_warned_ > 0 ? Verdict::warning : Verdict::pass;
  }

 private:
  Thresholds t_;
  std::uint64_t total_ = 0, failed_ = 0, hard_failed_ = 0, off_ = 0, warned_ = 0, hard_warned_ = 0;
};

} // namespace levelray
