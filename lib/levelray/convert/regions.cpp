#include "levelray/convert/regions.hpp"

#include "levelray/convert/join_blocks.hpp"
#include "levelray/convert/weighted_union_find.hpp"
#include "levelray/core/parallel.hpp"

namespace levelray {

namespace {

struct Join {
  std::uint32_t low, high;
  std::int32_t winding; // high - low
  bool operator==(const Join&) const = default;
};

// A node that nothing touches, as a block side: one component of all samples, far from everything.
const BlockComponent whole_node{~std::uint64_t{0}, 0, 0};

// What joins the regions of table entry `n` to those of its neighbour at +axis.
void joins_across(const Band& band, const std::vector<std::uint32_t>& first_id, std::size_t n,
                  std::size_t next, int axis, SheetCounting counting, std::vector<Join>& out) {
  const std::int32_t low_node = band.node_at[n], high_node = band.node_at[next];
  if (low_node == Band::untouched && high_node == Band::untouched) {
    out.push_back({first_id[n], first_id[next], 0});
    return;
  }
  const auto side_of = [&](std::int32_t node, int block) {
    return node == Band::untouched ? BlockSide{nullptr, {&whole_node, 1}}
                                   : band.nodes[static_cast<std::size_t>(node)].side(block);
  };
  const int shift = 3 << (2 * axis);
  for (std::uint64_t rest = face_samples(axis, 0); rest; rest &= rest - 1) {
    const int high_block = std::countr_zero(rest), low_block = high_block + shift;
    const BlockSide low = side_of(low_node, low_block), high = side_of(high_node, high_block);
    const FaceCrossing crossing = low_node == Band::untouched
                                      ? FaceCrossing{}
                                      : band.nodes[static_cast<std::size_t>(low_node)].face(low_block, axis);
    join_blocks(low, high, axis, crossing, counting, [&](std::size_t a, std::size_t b, std::int32_t winding) {
      const BlockComponent &ca = low.components[a], &cb = high.components[b];
      const Join join{first_id[n] + ca.node_component, first_id[next] + cb.node_component,
                      winding + ca.winding - cb.winding};
      if (out.empty() || out.back() != join) out.push_back(join);
    });
  }
}

} // namespace

Regions join_regions(const Band& band, SheetCounting counting) {
  Regions regions;
  const std::size_t count = band.box.count();
  regions.first_id.resize(count);
  std::uint32_t ids = 0;
  for (std::size_t n = 0; n < count; ++n) {
    regions.first_id[n] = ids;
    ids += band.node_at[n] == Band::untouched
               ? 1
               : band.nodes[static_cast<std::size_t>(band.node_at[n])].node_components;
  }

  // Find the joins in parallel, apply them in table order.
  constexpr std::size_t chunk_size = 256;
  std::vector<std::vector<Join>> chunks((count + chunk_size - 1) / chunk_size);
  parallel_for(count, chunk_size, [&](std::size_t begin, std::size_t end) {
    std::vector<Join>& joins = chunks[begin / chunk_size];
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i coord = band.box.coord(n);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3i next = coord;
        ++next[axis];
        if (band.box.contains(next))
          joins_across(band, regions.first_id, n, band.box.index(next), axis, counting, joins);
      }
    }
  });
  WeightedUnionFind sets(ids);
  for (const auto& joins : chunks)
    for (const Join& j : joins) regions.contradictions += !sets.unite(j.low, j.high, j.winding);

  regions.set.resize(ids);
  regions.winding.resize(ids);
  for (std::uint32_t id = 0; id < ids; ++id) {
    const WeightedUnionFind::Root root = sets.find(id);
    regions.set[id] = root.root;
    regions.winding[id] = root.offset;
  }
  regions.outer_set = regions.set[0]; // the corner node is untouched
  regions.outer_winding = regions.winding[0];
  regions.votes.assign(ids, 0);
  for (std::size_t n = 0; n < count; ++n) {
    if (band.node_at[n] == Band::untouched) continue;
    const NodeBand& node = band.nodes[static_cast<std::size_t>(band.node_at[n])];
    for (std::size_t c = 0; c < node.votes.size(); ++c)
      regions.votes[regions.set[regions.first_id[n] + node.components[c].node_component]] += node.votes[c];
  }
  return regions;
}

} // namespace levelray
