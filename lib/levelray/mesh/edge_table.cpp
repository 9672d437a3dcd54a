#include "levelray/mesh/edge_table.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/core/uninitialized_vector.hpp"

#include <algorithm>

namespace levelray {

namespace {
constexpr std::size_t vertices_per_chunk = 8192;
constexpr std::size_t edges_per_chunk = 32768;
} // namespace

EdgeTable build_edge_table(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  if (triangles.size() >= no_index / 3)
    throw Error(ErrorKind::limit, "mesh has more than 1.4e9 triangles; split it");
  const std::size_t half_edge_count = 3 * triangles.size();

  // Sort half-edges into one bucket per lower vertex (counting sort).
  std::vector<std::uint32_t> bucket(vertex_count + 1, 0);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++bucket[std::min(t[k], t[(k + 1) % 3]) + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) bucket[v + 1] += bucket[v];
  uninitialized_vector<std::uint64_t> keys(half_edge_count); // higher vertex << 32 | half-edge
  {
    std::vector<std::uint32_t> next(bucket.begin(), bucket.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({triangles[t][k], triangles[t][(k + 1) % 3]});
        keys[next[low]++] = std::uint64_t{high} << 32 | (3 * t + k);
      }
  }

  // Sort each bucket by higher vertex and count its edges.
  const auto starts_edge = [&](std::size_t i, std::size_t bucket_begin) {
    return i == bucket_begin || keys[i] >> 32 != keys[i - 1] >> 32;
  };
  const std::size_t chunks = (vertex_count + vertices_per_chunk - 1) / vertices_per_chunk;
  std::vector<std::uint32_t> edges_before(chunks + 1, 0);
  parallel_for(vertex_count, vertices_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t count = 0;
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(keys.begin() + bucket[v], keys.begin() + bucket[v + 1]);
      for (std::size_t i = bucket[v]; i < bucket[v + 1]; ++i) count += starts_edge(i, bucket[v]);
    }
    edges_before[begin / vertices_per_chunk + 1] = count;
  });
  for (std::size_t c = 0; c < chunks; ++c) edges_before[c + 1] += edges_before[c];

  EdgeTable out;
  out.half_edges.resize(half_edge_count);
  out.first.resize(std::size_t{edges_before[chunks]} + 1);
  out.first.back() = static_cast<std::uint32_t>(half_edge_count);
  parallel_for(vertex_count, vertices_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t edge = edges_before[begin / vertices_per_chunk];
    for (std::size_t v = begin; v < end; ++v)
      for (std::uint32_t i = bucket[v]; i < bucket[v + 1]; ++i) {
        if (starts_edge(i, bucket[v])) out.first[edge++] = i;
        out.half_edges[i] = static_cast<std::uint32_t>(keys[i]);
      }
  });
  return out;
}

std::vector<std::uint32_t> find_twins(const EdgeTable& edges) {
  std::vector<std::uint32_t> twins(edges.half_edges.size(), no_index);
  parallel_for(edges.size(), edges_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto group = edges.of(e);
      if (group.size() != 2) continue;
      twins[group[0]] = group[1];
      twins[group[1]] = group[0];
    }
  });
  return twins;
}

std::vector<OpenEdge> find_boundary_chain(const std::vector<Triangle>& triangles, const EdgeTable& edges) {
  std::vector<std::vector<OpenEdge>> found((edges.size() + edges_per_chunk - 1) / edges_per_chunk);
  parallel_for(edges.size(), edges_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      int excess = 0;
      for (const std::uint32_t h : edges.of(e)) excess += runs_up(triangles, h) ? 1 : -1;
      if (excess != 0) found[begin / edges_per_chunk].push_back({static_cast<std::uint32_t>(e), excess});
    }
  });
  std::vector<OpenEdge> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<std::uint32_t> find_edges(const EdgeTable& edges) {
  std::vector<std::uint32_t> edge_of(edges.half_edges.size());
  parallel_for(edges.size(), edges_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      for (const std::uint32_t h : edges.of(e)) edge_of[h] = static_cast<std::uint32_t>(e);
  });
  return edge_of;
}

} // namespace levelray
