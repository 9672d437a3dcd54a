#include "levelray/mesh/orientation.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/mesh/union_find.hpp"

#include <algorithm>
#include <cstdlib>

namespace levelray {

namespace {

double triangle_area(const TriangleMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).length();
}

struct Patches {
  std::vector<std::uint32_t> of; // per triangle
  std::uint32_t count = 0;
};

// Propagates orientation through each patch, and decides which of its two classes to turn.
Patches orient_patches(const TriangleMesh& mesh, const EdgeTable& edges, Consistency& out) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::vector<std::uint32_t> twins = find_twins(edges);
  Patches patches;
  patches.of.assign(triangles.size(), no_index);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (patches.of[seed] != no_index) continue;
    check_cancel();
    const std::uint32_t patch = patches.count++;
    queue.assign(1, seed);
    patches.of[seed] = patch;
    std::uint64_t clashes = 0, contradictions = 0; // half-edges: of the input, and whatever is turned
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t t = queue[i];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t twin = twins[h];
        if (twin == no_index) continue;
        const std::uint32_t u = twin / 3;
        const bool clash = runs_up(triangles, h) == runs_up(triangles, twin);
        const auto wanted = static_cast<std::uint8_t>(out.flip[t] ^ (clash ? 1 : 0));
        clashes += clash;
        if (patches.of[u] == no_index) {
          patches.of[u] = patch;
          out.flip[u] = wanted;
          queue.push_back(u);
        } else
          contradictions += out.flip[u] != wanted;
      }
    }
    out.orientable &= contradictions == 0;
    if (clashes == 0) continue; // flip is 0 all over
    double area[2] = {0, 0};    // as the seed, and against it
    for (const std::uint32_t t : queue) area[out.flip[t]] += triangle_area(mesh, t);
    const bool worse = contradictions >= clashes;
    const std::uint8_t other = !worse && area[1] > area[0];
    for (const std::uint32_t t : queue) out.flip[t] = worse ? 0 : out.flip[t] ^ other;
  }
  return patches;
}

// The patches around one edge with more than two triangles, and the sum of their directions along it.
struct Junction {
  std::vector<std::pair<std::uint32_t, int>> patches;
};

// Turns whole patches so that the boundary chain along edges with more than two triangles gets short.
void match_patches(const TriangleMesh& mesh, const EdgeTable& edges, const Patches& patches,
                   Consistency& out) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  // Collect the junctions that patches can change.
  std::vector<Junction> junctions;
  std::vector<std::pair<std::uint32_t, int>> sums;
  bool avoidable = false;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto group = edges.of(e);
    if (group.size() < 3) continue;
    sums.clear();
    for (const std::uint32_t h : group)
      sums.emplace_back(patches.of[h / 3], runs_up(triangles, h) != (out.flip[h / 3] != 0) ? 1 : -1);
    std::sort(sums.begin(), sums.end());
    Junction junction;
    int total = 0;
    for (const auto& [patch, direction] : sums) {
      total += direction;
      if (junction.patches.empty() || junction.patches.back().first != patch)
        junction.patches.emplace_back(patch, 0);
      junction.patches.back().second += direction;
    }
    std::erase_if(junction.patches, [](const auto& p) { return p.second == 0; });
    avoidable |= std::abs(total) > static_cast<int>(group.size() % 2);
    if (!junction.patches.empty()) junctions.push_back(std::move(junction));
  }
  if (!avoidable) return;
  std::vector<double> area(patches.count, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) area[patches.of[t]] += triangle_area(mesh, t);

  std::vector<std::vector<std::pair<std::uint32_t, int>>> junctions_of(patches.count);
  for (std::uint32_t j = 0; j < junctions.size(); ++j)
    for (const auto& [patch, sum] : junctions[j].patches) junctions_of[patch].emplace_back(j, sum);
  std::vector<std::uint32_t> order;
  for (std::uint32_t p = 0; p < patches.count; ++p)
    if (!junctions_of[p].empty()) order.push_back(p);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });

  std::vector<int> sign(patches.count, 1), total(junctions.size(), 0);
  const auto length_with = [&](std::uint32_t patch, int factor) { // boundary at the patch's junctions
    std::int64_t length = 0;
    for (const auto& [j, sum] : junctions_of[patch]) length += std::abs(total[j] + factor * sum);
    return length;
  };
  const auto add = [&](std::uint32_t patch, int factor) {
    for (const auto& [j, sum] : junctions_of[patch]) total[j] += factor * sum;
  };

  // Place patches one by one, then turn single ones while it helps. Each turn shortens the chain by 2 or
  // more, and sweeps are capped because a local optimum is all we promise.
  for (const std::uint32_t p : order) {
    sign[p] = length_with(p, -1) < length_with(p, 1) ? -1 : 1;
    add(p, sign[p]);
  }
  bool changed = true;
  for (int sweep = 0; changed && sweep < 50; ++sweep) {
    changed = false;
    for (auto p = order.rbegin(); p != order.rend(); ++p) {
      if (length_with(*p, -2 * sign[*p]) >= length_with(*p, 0)) continue;
      add(*p, -2 * sign[*p]);
      sign[*p] = -sign[*p];
      changed = true;
    }
  }

  // Keep the input's signs unless that was an improvement.
  std::int64_t before = 0, after = 0;
  for (std::size_t j = 0; j < junctions.size(); ++j) {
    int sum = 0;
    for (const auto& p : junctions[j].patches) sum += p.second;
    before += std::abs(sum), after += std::abs(total[j]);
  }
  if (after >= before) return;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    if (sign[patches.of[t]] < 0) out.flip[t] ^= 1;
}

} // namespace

std::pair<std::vector<std::uint32_t>, std::uint32_t> find_shells(std::size_t triangle_count,
                                                                 const EdgeTable& edges) {
  UnionFind sets(triangle_count);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto group = edges.of(e);
    for (std::size_t i = 1; i < group.size(); ++i) sets.join(group[0] / 3, group[i] / 3);
  }
  return sets.labels();
}

Consistency make_consistent(const TriangleMesh& mesh, const EdgeTable& edges) {
  Consistency out;
  out.flip.assign(mesh.triangles.size(), 0);
  const Patches patches = orient_patches(mesh, edges, out);
  match_patches(mesh, edges, patches, out);
  for (const std::uint8_t f : out.flip) out.flips += f;
  return out;
}

} // namespace levelray
