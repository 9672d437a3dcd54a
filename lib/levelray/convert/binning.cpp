#include "levelray/convert/binning.hpp"

#include "levelray/convert/triangle_frame.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

struct Pair {
  std::uint32_t node, triangle;
};

constexpr double half_node = (node_dim - 1) / 2.0; // from a node's centre to its outermost samples

Vec3d center_of(const Vec3i& node) {
  return Vec3d(node.x * node_dim + half_node, node.y * node_dim + half_node, node.z * node_dim + half_node);
}

// The distance from the origin to the triangle of a frame whose node centre is the origin.
double center_distance(const TriangleFrame& f) {
  double edge = INFINITY;
  bool above = true;
  for (int i = 0; i < 3; ++i) {
    const double over = std::max(std::abs(double{f.along[i][3]}) - f.half[i], 0.0);
    edge = std::min(edge, double{f.inward[i][3]} * f.inward[i][3] + over * over);
    above = above && f.inward[i][3] >= f.threshold;
  }
  return std::sqrt(double{f.plane[3]} * f.plane[3] + (above ? 0 : edge));
}

void bin_triangle(const VoxelMesh& mesh, const NodeBox& box, std::uint32_t t, double reach,
                  std::vector<Pair>& out) {
  const Vec3d &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
              &c = mesh.vertices[mesh.triangles[t][2]];
  Vec3i lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::min({a[axis], b[axis], c[axis]}), high = std::max({a[axis], b[axis], c[axis]});
    lo[axis] =
        std::max(static_cast<int>(std::ceil((low - reach - (node_dim - 1)) / node_dim)), box.node_min[axis]);
    hi[axis] = std::min(static_cast<int>(std::floor((high + reach) / node_dim)),
                        box.node_min[axis] + box.dims[axis] - 1);
    if (lo[axis] > hi[axis]) return;
  }
  const std::int64_t covered = std::int64_t{hi.x - lo.x + 1} * (hi.y - lo.y + 1) * (hi.z - lo.z + 1);
  if (covered == 1) {
    out.push_back({static_cast<std::uint32_t>(box.index(lo)), t});
    return;
  }

  // Of the nodes in the box keep those whose own box the dilated plane meets, and of large triangles those
  // whose centre is near.
  const Vec3d n = (b - a).cross(c - a);
  const double slack = half_node * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) + reach * n.length();
  const double offset = n.dot(a);
  // Rounding of n . center: each product errs by 2^-53 of its size, and sizes are below |n|_1 times the
  // largest coordinate.
  const double margin = slack * 1e-9 + std::abs(offset) * 1e-12;
  const double radius = half_node * std::sqrt(3.0) + reach;
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        const Vec3i node(x, y, z);
        const Vec3d center = center_of(node);
        if (std::abs(n.dot(center) - offset) > slack + margin) continue;
        // 1e-3: the frame's floats err by less than 2^-22 of the distances compared, which are below 2^10
        // where it matters.
        if (covered > 8 &&
            center_distance(make_triangle_frame(a, b, c, center, 1e4)) > radius * (1 + 1e-5) + 1e-3)
          continue;
        out.push_back({static_cast<std::uint32_t>(box.index(node)), t});
      }
}

} // namespace

NodeBins bin_triangles(const VoxelMesh& mesh, const NodeBox& box, double surface_reach, double cap_reach) {
  // Collect pairs by chunks of triangles, then sort them by node with a stable counting sort.
  constexpr std::size_t chunk_size = 2048;
  const std::size_t count = mesh.triangles.size();
  std::vector<std::vector<Pair>> chunks((count + chunk_size - 1) / chunk_size);
  parallel_for(count, chunk_size, [&](std::size_t begin, std::size_t end) {
    std::vector<Pair>& pairs = chunks[begin / chunk_size];
    pairs.reserve(4 * (end - begin));
    for (std::size_t t = begin; t < end; ++t)
      bin_triangle(mesh, box, static_cast<std::uint32_t>(t), mesh.is_cap(t) ? cap_reach : surface_reach,
                   pairs);
  });

  std::vector<std::uint32_t> per_node(box.count(), 0);
  for (const auto& pairs : chunks)
    for (const Pair& p : pairs) ++per_node[p.node];

  NodeBins bins;
  std::vector<std::uint64_t> next(box.count(), 0);
  std::uint64_t total = 0;
  for (std::size_t n = 0; n < per_node.size(); ++n) {
    if (!per_node[n]) continue;
    bins.node.push_back(static_cast<std::uint32_t>(n));
    bins.first.push_back(total);
    next[n] = total;
    total += per_node[n];
  }
  bins.first.push_back(total);
  bins.triangles.resize(total);
  for (const auto& pairs : chunks)
    for (const Pair& p : pairs) bins.triangles[next[p.node]++] = p.triangle;
  return bins;
}

} // namespace levelray
