// Union-find whose elements carry integer potentials: it knows the difference between any two elements of a
// set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace levelray {

class WeightedUnionFind {
 public:
  struct Root {
    std::uint32_t root;
    std::int32_t offset; // potential(element) - potential(root)
  };

  explicit WeightedUnionFind(std::size_t count) : parent_(count), offset_(count, 0) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }

  Root find(std::uint32_t element) {
    // Two passes: find the root, then point everything on the way at it.
    std::uint32_t root = element;
    std::int32_t total = 0;
    for (; parent_[root] != root; root = parent_[root]) total += offset_[root];
    const Root found{root, total};
    while (parent_[element] != root && element != root) {
      const std::uint32_t next = parent_[element];
      const std::int32_t step = offset_[element];
      parent_[element] = root;
      offset_[element] = total;
      total -= step;
      element = next;
    }
    return found;
  }

  // States potential(b) - potential(a) = difference. The smaller root stays root, so the result does not
  // depend on sizes. Returns false where the statement contradicts earlier ones.
  bool unite(std::uint32_t a, std::uint32_t b, std::int32_t difference) {
    const Root ra = find(a), rb = find(b);
    if (ra.root == rb.root) return rb.offset - ra.offset == difference;
    // potential(root b) - potential(root a)
    const std::int32_t between = difference + ra.offset - rb.offset;
    if (ra.root < rb.root) {
      parent_[rb.root] = ra.root;
      offset_[rb.root] = between;
    } else {
      parent_[ra.root] = rb.root;
      offset_[ra.root] = -between;
    }
    return true;
  }

  std::size_t size() const { return parent_.size(); }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::int32_t> offset_;
};

} // namespace levelray
