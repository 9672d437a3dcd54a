// How doubles and floats are rounded, until the end of a scope.
#pragma once

#include <cfenv>

namespace levelray {

// Of this thread. What is computed under another mode than the caller's belongs into a function of its own
// that is not inlined: compilers take arithmetic to be the same in all modes, and may move it.
class RoundingMode {
 public:
  explicit RoundingMode(int mode) : old_(std::fegetround()) {
    if (mode != old_) std::fesetround(mode);
  }
  ~RoundingMode() {
    if (std::fegetround() != old_) std::fesetround(old_);
  }
  RoundingMode(const RoundingMode&) = delete;
  RoundingMode& operator=(const RoundingMode&) = delete;

 private:
  int old_;
};

} // namespace levelray
