#include "levelray/mesh/duplicates.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/mesh/orientation.hpp"
#include "levelray/mesh/union_find.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace levelray {

namespace {

// Triangles over the same vertices; `up` tells their orientations apart.
struct Member {
  std::uint32_t apex, triangle;
  bool up;
  friend auto operator<=>(const Member&, const Member&) = default;
};
using Group = std::vector<Member>; // ascending by triangle, at least two of the same apex

// Every triple is looked at where its two lowest vertices meet.
std::vector<Group> find_groups(const std::vector<Triangle>& triangles, const EdgeTable& edges) {
  constexpr std::size_t grain = 65536;
  std::vector<std::vector<Group>> found((edges.size() + grain - 1) / grain);
  parallel_for(edges.size(), grain, [&](std::size_t begin, std::size_t end) {
    Group members;
    for (std::size_t e = begin; e < end; ++e) {
      const auto around = edges.of(e);
      if (around.size() < 2) continue;
      if (around.size() == 2 &&
          opposite_vertex(triangles, around[0]) != opposite_vertex(triangles, around[1]))
        continue;
      members.clear();
      for (const std::uint32_t h : around) {
        const std::uint32_t apex = opposite_vertex(triangles, h);
        if (apex > std::max(edge_start(triangles, h), edge_end(triangles, h)))
          members.push_back({apex, h / 3, runs_up(triangles, h)});
      }
      std::sort(members.begin(), members.end());
      for (std::size_t i = 0, next = 0; i < members.size(); i = next) {
        while (next < members.size() && members[next].apex == members[i].apex) ++next;
        if (next - i >= 2) found[begin / grain].emplace_back(members.begin() + i, members.begin() + next);
      }
    }
  });
  std::vector<Group> groups;
  for (auto& part : found) std::move(part.begin(), part.end(), std::back_inserter(groups));
  return groups;
}

// What dropping the repetitions of a cluster would do to the boundary next to other triangles.
struct Balance {
  std::uint64_t kept = 0, dropped = 0;         // length of the oriented boundary
  std::uint64_t kept_odd = 0, dropped_odd = 0; // edges with an odd number of triangles
  bool keep() const { return (kept == 0 && dropped != 0) || dropped_odd > kept_odd; }
};

bool in_first_half(const Group& group, std::uint32_t triangle) {
  for (std::size_t i = 0; i < std::max<std::size_t>(1, group.size() / 2); ++i)
    if (group[i].triangle == triangle) return true;
  return false;
}

// The triangles of shells that are double-sided almost everywhere, and either all of the mesh is or half of
// them is closed.
std::vector<bool> find_double_sided(const std::vector<Triangle>& triangles, const EdgeTable& edges,
                                    const std::vector<Group>& groups, const std::vector<bool>& paired) {
  const auto [shell, shells] = find_shells(triangles.size(), edges);
  std::vector<std::uint64_t> size(shells, 0), in_pairs(shells, 0);
  std::uint64_t all_pairs = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    ++size[shell[t]];
    in_pairs[shell[t]] += paired[t];
    all_pairs += paired[t];
  }
  const auto nearly = [](std::uint64_t part, std::uint64_t all) { return 10 * part >= 9 * all; };
  std::vector<bool> single(shells);
  for (std::uint32_t s = 0; s < shells; ++s) single[s] = nearly(in_pairs[s], size[s]);
  if (!nearly(all_pairs, triangles.size())) {
    std::vector<bool> stays(triangles.size(), true);
    for (const Group& group : groups)
      for (const Member& m : group)
        stays[m.triangle] = !paired[m.triangle] || in_first_half(group, m.triangle);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      int count = 0;
      for (const std::uint32_t h : edges.of(e)) count += stays[h / 3];
      if (count % 2 != 0) single[shell[edges.of(e)[0] / 3]] = false;
    }
  }
  std::vector<bool> out(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) out[t] = single[shell[t]];
  return out;
}

} // namespace

Duplicates find_duplicates(const std::vector<Triangle>& triangles, const EdgeTable& edges,
                           bool single_double_sided) {
  Duplicates out;
  const std::vector<Group> groups = find_groups(triangles, edges);
  if (groups.empty()) return out;

  // Mark what a group holds.
  std::vector<std::uint32_t> group_of(triangles.size(), no_index);
  std::vector<bool> repeated(triangles.size(), false), paired(triangles.size(), false);
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const Member* seen[2] = {nullptr, nullptr};
    for (const Member& m : groups[g]) {
      group_of[m.triangle] = g;
      repeated[m.triangle] = seen[m.up] != nullptr;
      out.same += repeated[m.triangle];
      if (!seen[m.up]) seen[m.up] = &m;
    }
    if (!seen[0] || !seen[1]) continue;
    ++out.opposite;
    for (const Member& m : groups[g]) paired[m.triangle] = true;
  }

  // Cluster the groups over edges, and weigh each cluster.
  UnionFind sets(groups.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touched; // (edge, one of its groups)
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    std::uint32_t any = no_index;
    for (const std::uint32_t h : edges.of(e)) {
      const std::uint32_t g = group_of[h / 3];
      if (g == no_index) continue;
      if (any == no_index) touched.emplace_back(e, any = g);
      sets.join(any, g);
    }
  }
  std::vector<Balance> balance(groups.size());
  for (const auto& [e, g] : touched) {
    std::int64_t all = 0, without = 0, count = 0, count_without = 0;
    bool others = false;
    for (const std::uint32_t h : edges.of(e)) {
      const int direction = runs_up(triangles, h) ? 1 : -1;
      others |= group_of[h / 3] == no_index;
      all += direction, ++count;
      if (!repeated[h / 3]) without += direction, ++count_without;
    }
    if (!others) continue;
    Balance& b = balance[sets.find(g)];
    b.kept += std::abs(all), b.dropped += std::abs(without);
    b.kept_odd += count % 2, b.dropped_odd += count_without % 2;
  }

  // Drop the later half of the groups in shells that are double-sided, and else what is repeated.
  const std::vector<bool> single = single_double_sided && out.opposite > 0
                                       ? find_double_sided(triangles, edges, groups, paired)
                                       : std::vector<bool>(triangles.size(), false);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (group_of[t] == no_index) continue;
    const Group& group = groups[group_of[t]];
    if (single[t] && paired[t]) {
      if (in_first_half(group, t)) continue;
      out.dropped.push_back(t);
      ++out.dropped_opposite;
    } else if (repeated[t] && !balance[sets.find(group_of[t])].keep()) {
      out.dropped.push_back(t);
      ++out.dropped_same;
    } else {
      out.kept_same += repeated[t];
      out.kept_opposite += paired[t] && group.front().triangle == t;
    }
  }
  return out;
}

} // namespace levelray
