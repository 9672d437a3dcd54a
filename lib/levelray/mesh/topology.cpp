#include "levelray/mesh/topology.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/mesh/orientation.hpp"
#include "levelray/mesh/union_find.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

namespace levelray {

namespace {

// The triangles at each vertex, ascending.
struct Incidence {
  std::vector<std::uint32_t> first, triangles;
  explicit Incidence(const TriangleMesh& mesh)
      : first(mesh.vertices.size() + 1, 0), triangles(3 * mesh.triangles.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++first[v + 1];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) first[v + 1] += first[v];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t]) triangles[next[v]++] = t;
  }
};

// Whether the triangles around v are one fan: its link, the edges opposite to v, is connected.
class FanTest {
 public:
  bool operator()(const std::vector<Triangle>& triangles, const std::uint32_t* begin,
                  const std::uint32_t* end, std::uint32_t v) {
    if (end - begin < 2) return true;
    if (end - begin > 64) return many(triangles, begin, end, v);
    link_.clear();
    for (const std::uint32_t* t = begin; t != end; ++t) link_.push_back(opposite(triangles[*t], v));
    // Grow the first edge's part by edges that touch its end, as the fan of a manifold vertex allows, then by
    // search.
    std::size_t done = 1;
    for (std::size_t i = 0; i < done; ++i)
      for (std::size_t j = done; j < link_.size(); ++j)
        if (touches(link_[i], link_[j])) std::swap(link_[j], link_[done++]);
    return done == link_.size();
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;
  static Edge opposite(const Triangle& t, std::uint32_t v) {
    return t[0] == v ? Edge{t[1], t[2]} : t[1] == v ? Edge{t[2], t[0]} : Edge{t[0], t[1]};
  }
  static bool touches(const Edge& a, const Edge& b) {
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
  }
  static bool many(const std::vector<Triangle>& triangles, const std::uint32_t* begin,
                   const std::uint32_t* end, std::uint32_t v) {
    std::vector<std::uint32_t> names;
    for (const std::uint32_t* t = begin; t != end; ++t)
      for (const std::uint32_t w : opposite(triangles[*t], v)) names.push_back(w);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const auto number = [&](std::uint32_t w) {
      return static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), w) - names.begin());
    };
    UnionFind sets(names.size());
    for (const std::uint32_t* t = begin; t != end; ++t) {
      const Edge e = opposite(triangles[*t], v);
      sets.join(number(e[0]), number(e[1]));
    }
    return sets.labels().second == 1;
  }

  std::vector<Edge> link_;
};

// Numbers for the vertices of a set of edges, and the sets of connected ones.
struct Parts {
  std::vector<std::uint32_t> vertices, part; // ascending; the part of each
  std::uint32_t count = 0;
  explicit Parts(const std::vector<std::array<std::uint32_t, 2>>& segments) {
    for (const auto& s : segments) vertices.insert(vertices.end(), s.begin(), s.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto number = [&](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                        vertices.begin());
    };
    UnionFind sets(vertices.size());
    for (const auto& s : segments) sets.join(number(s[0]), number(s[1]));
    std::tie(part, count) = sets.labels();
  }
};

} // namespace

void count_topology(const TriangleMesh& mesh, const EdgeTable& edges, MeshReport& report) {
  const std::vector<Triangle>& triangles = mesh.triangles;

  // Edges.
  struct Counted {
    std::vector<std::array<std::uint32_t, 2>> boundary;
    std::uint64_t non_manifold = 0, clashes = 0;
  };
  constexpr std::size_t grain = 65536;
  std::vector<Counted> counted((edges.size() + grain - 1) / grain);
  parallel_for(edges.size(), grain, [&](std::size_t begin, std::size_t end) {
    Counted part;
    for (std::size_t e = begin; e < end; ++e) {
      const auto group = edges.of(e);
      if (group.size() == 1)
        part.boundary.push_back({edge_start(triangles, group[0]), edge_end(triangles, group[0])});
      else if (group.size() == 2)
        part.clashes += runs_up(triangles, group[0]) == runs_up(triangles, group[1]);
      else
        ++part.non_manifold;
    }
    counted[begin / grain] = std::move(part);
  });
  std::vector<std::array<std::uint32_t, 2>> boundary;
  for (const Counted& part : counted) {
    boundary.insert(boundary.end(), part.boundary.begin(), part.boundary.end());
    report.non_manifold_edges += part.non_manifold;
    report.winding_clashes += part.clashes;
  }
  report.boundary_edges = boundary.size();
  report.boundary_loops = Parts(boundary).count;
  report.closed = boundary.empty();

  // Vertices, and what is connected over them.
  const Incidence incidence(mesh);
  std::atomic<std::uint64_t> pinched{0};
  parallel_for(mesh.vertices.size(), 16384, [&](std::size_t begin, std::size_t end) {
    FanTest one_fan;
    std::uint64_t count = 0;
    for (std::size_t v = begin; v < end; ++v)
      count += !one_fan(triangles, incidence.triangles.data() + incidence.first[v],
                        incidence.triangles.data() + incidence.first[v + 1], static_cast<std::uint32_t>(v));
    pinched += count;
  });
  report.non_manifold_vertices = pinched;
  const auto [shell, shells] = find_shells(triangles.size(), edges);
  report.shells = shells;
  UnionFind components(shells);
  if (shells > 1)
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      for (std::uint32_t i = incidence.first[v] + 1; i < incidence.first[v + 1]; ++i)
        components.join(shell[incidence.triangles[i - 1]], shell[incidence.triangles[i]]);
  report.components = components.labels().second;
}

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  // Each component of the cross product is a difference of two products of rounded differences: four
  // roundings of at most |u||v| each. The corners were rounded when they were read: half an ulp of the
  // largest coordinate each.
  const Vec3d u = b - a, v = c - a;
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(a[i]), std::abs(b[i]), std::abs(c[i])});
  const double lu = u.length(), lv = v.length();
  const double rounding = std::numeric_limits<double>::epsilon() * (4 * lu * lv + 2 * largest * (lu + lv));
  return u.cross(v).length() > rounding;
}

std::uint64_t count_without_area(const TriangleMesh& mesh) {
  std::atomic<std::uint64_t> total{0};
  parallel_for(mesh.triangles.size(), 65536, [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      count += !has_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    }
    total += count;
  });
  return total;
}

double largest_part(const TriangleMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& segments) {
  const Parts parts(segments);
  std::vector<Box3d> boxes(parts.count);
  for (std::size_t i = 0; i < parts.vertices.size(); ++i)
    boxes[parts.part[i]].extendBy(mesh.vertices[parts.vertices[i]]);
  double largest = 0;
  for (const Box3d& box : boxes) largest = std::max(largest, box.size().length());
  return largest;
}

} // namespace levelray
