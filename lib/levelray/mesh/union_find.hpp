// Disjoint sets (Tarjan & van Leeuwen 1984, section 1, path halving), each named by its lowest member, so
// that results do not depend on the order of the unions.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace levelray {

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }

  // Numbers the sets 0, 1, … by their lowest members: label[i] of each element, and how many there are.
  std::pair<std::vector<std::uint32_t>, std::uint32_t> labels() {
    std::vector<std::uint32_t> label(parent_.size());
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
      const std::uint32_t root = find(i);
      label[i] = root == i ? count++ : label[root];
    }
    return {std::move(label), count};
  }

 private:
  std::vector<std::uint32_t> parent_;
};

} // namespace levelray
