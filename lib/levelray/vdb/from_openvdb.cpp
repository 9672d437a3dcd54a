#include "levelray/vdb/from_openvdb.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/vdb/openvdb_layout.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

using namespace openvdb_layout;

namespace {

constexpr int index_limit = 1 << 30;            // so that no sum of two indices overflows
constexpr std::uint32_t node_mark = 0xFFFFFFFD; // a table entry that will become a node

template <class Grid>
class Importer {
  using Tree = typename Grid::TreeType;
  using Leaf = typename Tree::LeafNodeType;
  static_assert(Leaf::DIM == 8);

 public:
  Importer(const Grid& grid, const std::string& place, std::uint64_t max_bytes)
      : tree_(grid.tree()), place_(place), max_bytes_(max_bytes) {}

  BlockGrid run(const GridTransform& transform, std::vector<std::string>& warnings) {
    out_.transform = transform;
    gather();
    measure();
    choose_background(warnings);
    summarise();
    lay_out();
    fill();
    if (total_.odd_inactive)
      warnings.push_back(
          fmt::format("{} inactive samples are neither +background nor -background; they were kept as "
                      "part of the band",
                      total_.odd_inactive));
    if (total_.zero_inactive)
      warnings.push_back(
          fmt::format("{} inactive samples are 0; they were taken for outside", total_.zero_inactive));
    if (odd_tiles_)
      warnings.push_back(
          fmt::format("{} inactive tiles are neither +background nor -background; only their signs were used",
                      odd_tiles_));
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(ErrorKind kind, const std::string& reason) const {
    throw Error(kind, place_ + " " + reason);
  }

  // Lists leaves and tiles, and checks tiles and index range.
  void gather() {
    for (auto leaf = tree_.cbeginLeaf(); leaf; ++leaf) {
      leaves_.push_back(&*leaf);
      check_aligned(leaf->origin(), Leaf::DIM);
      bounds_.expand(leaf->getNodeBoundingBox());
    }
    auto tile = tree_.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      const bool active = tile.isValueOn();
      const float value = to_float(*tile);
      if (!std::isfinite(value)) fail(ErrorKind::bad_input, "has a tile whose value is not finite");
      if (!active && !(value < 0)) {
        odd_tiles_ += value != to_float(tree_.background());
        continue;
      }
      Tile t{tile.getBoundingBox(), value, active};
      check_aligned(t.box.min(), static_cast<openvdb::Index>(t.box.dim().x()));
      bounds_.expand(t.box);
      tiles_.push_back(t);
    }
    if (leaves_.empty() && std::none_of(tiles_.begin(), tiles_.end(), [](const Tile& t) { return t.active; }))
      fail(ErrorKind::bad_input, "is empty: no active values");
    for (int a = 0; a < 3; ++a)
      if (bounds_.min()[a] < -index_limit || bounds_.max()[a] > index_limit)
        fail(ErrorKind::limit,
             fmt::format("reaches from sample {} to {}; indices beyond +-{} are not supported",
                         coord_text(bounds_.min()), coord_text(bounds_.max()), index_limit));
  }

  // A damaged file can hang nodes to places where they overlap others.
  void check_aligned(const openvdb::Coord& origin, openvdb::Index dim) const {
    if ((origin & openvdb::Int32(dim - 1)) != openvdb::Coord(0, 0, 0))
      fail(ErrorKind::bad_input,
           fmt::format("is damaged: a node of {} samples begins at {}", dim, coord_text(origin)));
  }

  static std::string coord_text(const openvdb::Coord& c) {
    return fmt::format("({}, {}, {})", c.x(), c.y(), c.z());
  }

  // Checks all values.
  void measure() {
    const float background = to_float(tree_.background());
    std::vector<Statistics> chunks((leaves_.size() + chunk - 1) / chunk);
    parallel_for(leaves_.size(), chunk, [&](std::size_t begin, std::size_t end) {
      Statistics s;
      for (std::size_t l = begin; l < end; ++l) {
        const auto* values = leaves_[l]->buffer().data();
        for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
          const float v = to_float(values[i]);
          const bool on = leaves_[l]->isValueOn(i);
          if (!std::isfinite(v) && !s.bad) s.bad = true, s.bad_at = leaves_[l]->offsetToGlobalCoord(i);
          s.negative |= v < 0;
          s.positive |= v > 0;
          if (on) {
            ++s.active;
            s.largest = std::max(s.largest, std::fabs(v));
          } else if (v == 0) {
            s.zero_inactive += background != 0;
          } else {
            s.odd_inactive += std::fabs(v) != std::fabs(background);
          }
        }
      }
      chunks[begin / chunk] = s;
    });
    for (const Statistics& s : chunks) total_.add(s);
    if (total_.bad)
      fail(ErrorKind::bad_input, fmt::format("has a value that is not a finite 32-bit number, at sample {}",
                                             coord_text(total_.bad_at)));
    for (const Tile& t : tiles_) {
      total_.negative |= t.value < 0;
      total_.positive |= t.value > 0;
      if (t.active)
        total_.active += t.box.volume(), total_.largest = std::max(total_.largest, std::fabs(t.value));
    }
    if (total_.active == 0) fail(ErrorKind::bad_input, "is empty: no active values");
  }

  void choose_background(std::vector<std::string>& warnings) {
    file_background_ = to_float(tree_.background());
    if (!std::isfinite(file_background_)) fail(ErrorKind::bad_input, "has a background that is not finite");
    if (file_background_ < 0)
      fail(ErrorKind::bad_input,
           fmt::format("has the background {:.6g}; a level set's is positive (the distance outside)",
                       file_background_));
    if (!total_.negative || !(total_.positive || file_background_ > 0))
      fail(ErrorKind::bad_input,
           fmt::format("has no surface: no value is {}", total_.negative ? "positive" : "negative"));
    out_.background = file_background_;
    if (file_background_ == 0) {
      out_.background = total_.largest;
      warnings.push_back(fmt::format(
          "background 0: taken as {:.6g}, the largest |value|, so that all beyond the samples is outside",
          out_.background));
    }
    for (Tile& t : tiles_)
      if (!t.active) odd_tiles_ += t.value != -out_.background;
  }

  Sample sample(const Leaf& leaf, openvdb::Index i) const {
    return convert(to_float(leaf.buffer().data()[i]), leaf.isValueOn(i), file_background_, out_.background);
  }

  // Decides which octants of the leaves are stored.
  void summarise() {
    summaries_.resize(leaves_.size());
    parallel_for(leaves_.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l)
        for (int octant = 0; octant < 8; ++octant) {
          bool active = false, negative = false, positive = false;
          for (int s = 0; s < samples_per_block; ++s) {
            const Sample v = sample(*leaves_[l], leaf_index(octant, s));
            active |= v.active;
            negative |= v.value < 0;
            positive |= !(v.value < 0);
          }
          const auto bit = static_cast<std::uint8_t>(1 << octant);
          if (active || (negative && positive))
            summaries_[l].stored |= bit;
          else if (negative)
            summaries_[l].inside |= bit;
        }
    });
  }

  std::uint32_t& entry(const Vec3i& node) {
    const Vec3i at = node - out_.node_min;
    return out_.node_table[at.x + static_cast<std::size_t>(out_.node_dims.x) *
                                      (at.y + static_cast<std::size_t>(out_.node_dims.y) * at.z)];
  }
  // Checks what the result needs against the budget, then makes table and nodes.
  void lay_out() {
    double entries = 1;
    for (int a = 0; a < 3; ++a) { // one sample of margin below: complete_blocks wants it
      out_.node_min[a] = (bounds_.min()[a] - 1) >> 4;
      out_.node_dims[a] = (bounds_.max()[a] >> 4) - out_.node_min[a] + 1;
      entries *= out_.node_dims[a];
    }
    double blocks = 0;
    for (const LeafSummary& s : summaries_) blocks += std::popcount(s.stored);
    for (const Tile& t : tiles_)
      if (t.active) blocks += static_cast<double>(t.box.volume()) / samples_per_block;
    const double bytes =
        entries * sizeof(std::uint32_t) + blocks * (samples_per_block * sizeof(float) + 16.0) +
        std::min(entries, static_cast<double>(leaves_.size() + tiles_.size()) + blocks / 64) *
            static_cast<double>(sizeof(BlockGrid::Node));
    if (!(bytes <= static_cast<double>(max_bytes_)))
      fail(ErrorKind::limit, fmt::format("spans {} x {} x {} samples with {:.4g} active and needs {:.3g} "
                                         "GiB; at most {:.3g} GiB are allowed",
                                         bounds_.dim().x(), bounds_.dim().y(), bounds_.dim().z(),
                                         static_cast<double>(total_.active), bytes / (1 << 30),
                                         static_cast<double>(max_bytes_) / (1 << 30)));

    out_.node_table.assign(static_cast<std::size_t>(entries), BlockGrid::outside_node);
    for (const Tile& t : tiles_)
      for_nodes(t, [&](const Vec3i& node, std::uint64_t blocks_of_node) {
        entry(node) = t.active || ~blocks_of_node ? node_mark : BlockGrid::inside_node;
      });
    for (std::size_t l = 0; l < leaves_.size(); ++l)
      if (summaries_[l].stored || summaries_[l].inside) entry(node_of(leaves_[l]->origin())) = node_mark;

    make_nodes();
    for (const Tile& t : tiles_)
      for_nodes(t, [&](const Vec3i& node, std::uint64_t blocks_of_node) {
        if (entry(node) >= node_mark) return;
        BlockGrid::Node& n = out_.nodes[entry(node)];
        (t.active ? n.stored : n.inside) |= blocks_of_node;
      });
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
      if (!summaries_[l].stored && !summaries_[l].inside) continue;
      BlockGrid::Node& n = out_.nodes[entry(node_of(leaves_[l]->origin()))];
      const int octant = octant_of(leaves_[l]->origin());
      n.stored |= octant_blocks(octant, summaries_[l].stored);
      n.inside |= octant_blocks(octant, summaries_[l].inside);
    }

    // Nodes that turned out to be all inside need no node.
    const std::vector<BlockGrid::Node> drafts = std::move(out_.nodes);
    out_.nodes.clear();
    std::uint64_t first_block = 0;
    for (std::uint32_t& e : out_.node_table) {
      if (e >= node_mark) continue;
      BlockGrid::Node node = drafts[e];
      if (!~node.inside) {
        e = BlockGrid::inside_node;
        continue;
      }
      node.first_block = first_block;
      first_block += static_cast<std::uint64_t>(std::popcount(node.stored));
      e = static_cast<std::uint32_t>(out_.nodes.size());
      out_.nodes.push_back(node);
    }
    out_.values.resize(first_block * samples_per_block);
    out_.active.resize(first_block);
  }

  // Turns the marked table entries into nodes, in the table's order.
  void make_nodes() {
    const std::size_t nx = static_cast<std::size_t>(out_.node_dims.x),
                      ny = static_cast<std::size_t>(out_.node_dims.y);
    for (std::size_t i = 0; i < out_.node_table.size(); ++i) {
      if (out_.node_table[i] != node_mark) continue;
      BlockGrid::Node node;
      node.coord = out_.node_min + Vec3i(static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                         static_cast<int>(i / nx / ny));
      out_.node_table[i] = static_cast<std::uint32_t>(out_.nodes.size());
      out_.nodes.push_back(node);
    }
  }

  void fill() {
    for (const Tile& t : tiles_) {
      if (!t.active) continue;
      for_nodes(t, [&](const Vec3i& coord, std::uint64_t blocks) {
        const BlockGrid::Node& node = out_.nodes[entry(coord)];
        for (std::uint64_t rest = blocks; rest; rest &= rest - 1) {
          const std::size_t b = BlockGrid::block_index(node, std::countr_zero(rest));
          std::fill_n(&out_.values[b * samples_per_block], samples_per_block, t.value);
          out_.active[b] = ~std::uint64_t{0};
        }
      });
    }
    parallel_for(leaves_.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l) {
        if (!summaries_[l].stored) continue;
        const Leaf& leaf = *leaves_[l];
        const BlockGrid::Node& node = out_.nodes[entry(node_of(leaf.origin()))];
        for (int octant = 0; octant < 8; ++octant) {
          if (!(summaries_[l].stored >> octant & 1)) continue;
          const std::size_t b = BlockGrid::block_index(node, block_bit(octant_of(leaf.origin()), octant));
          std::uint64_t active = 0;
          for (int s = 0; s < samples_per_block; ++s) {
            const Sample v = sample(leaf, leaf_index(octant, s));
            out_.values[b * samples_per_block + static_cast<std::size_t>(s)] = v.value;
            active |= std::uint64_t{v.active} << s;
          }
          out_.active[b] = active;
        }
      }
    });
  }

  static constexpr std::size_t chunk = 256; // leaves

  const Tree& tree_;
  const std::string& place_;
  const std::uint64_t max_bytes_;
  BlockGrid out_;
  std::vector<const Leaf*> leaves_;
  std::vector<LeafSummary> summaries_;
  std::vector<Tile> tiles_; // active or inside
  openvdb::CoordBBox bounds_;
  Statistics total_;
  float file_background_ = 0;
  std::uint64_t odd_tiles_ = 0;
};

} // namespace

template <class Grid>
BlockGrid from_openvdb(const Grid& grid, const GridTransform& transform, const std::string& place,
                       std::uint64_t max_bytes, std::vector<std::string>& warnings) {
  return Importer<Grid>(grid, place, max_bytes).run(transform, warnings);
}

template BlockGrid from_openvdb(const openvdb::FloatGrid&, const GridTransform&, const std::string&,
                                std::uint64_t, std::vector<std::string>&);
template BlockGrid from_openvdb(const openvdb::DoubleGrid&, const GridTransform&, const std::string&,
                                std::uint64_t, std::vector<std::string>&);

} // namespace levelray
