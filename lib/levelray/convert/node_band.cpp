#include "levelray/convert/node_band.hpp"

#include "levelray/convert/distance_kernel.hpp"
#include "levelray/convert/join_blocks.hpp"
#include "levelray/convert/pseudonormal_vote.hpp"
#include "levelray/convert/weighted_union_find.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

constexpr double block_radius = 1.5 * 1.7320508075688773; // from a block's centre to its corner samples
constexpr double half_node = (node_dim - 1) / 2.0;

// Buffers that live as long as the thread: a node needs about as much as the one before it.
struct Scratch {
  std::vector<TriangleFrame> frames;
  uninitialized_vector<float> center_squared; // 64 per triangle
  std::vector<std::uint32_t> lists;           // 64 lists of capacity frames.size(): local indices
  std::vector<std::uint32_t> mesh_list;       // one block's candidates as triangles of the mesh
};

Scratch& scratch() {
  thread_local Scratch s;
  return s;
}

// For the triangles frames[begin..end): appends to each block's list those that can be nearest to one of its
// samples within `reach`.
//
// With c the block's centre and r its radius, the nearest triangle T of a sample p has d(c,T) <= d(p,T) + r
// <= dmin(c) + 2r, and d(p,T) <= reach gives d(c,T) <= reach + r. The slack covers the float distances
// (relative error below 1e-5).
void list_candidates(std::size_t begin, std::size_t end, double reach, const float* center_squared,
                     std::size_t capacity, std::uint32_t* lists, std::array<std::uint32_t, 64>& count,
                     std::array<float, 64>& nearest_squared) {
  nearest_squared.fill(std::numeric_limits<float>::infinity());
  for (std::size_t t = begin; t < end; ++t) lower_to(nearest_squared.data(), &center_squared[64 * t]);

  std::array<float, 64> bound;
  for (std::size_t b = 0; b < 64; ++b) {
    const double nearest = std::sqrt(double{nearest_squared[b]});
    const double distance = std::min(nearest + 2 * block_radius, reach + block_radius) * (1 + 1e-5) + 1e-5;
    bound[b] = static_cast<float>(distance * distance);
  }
  for (std::size_t t = begin; t < end; ++t) {
    for (std::uint64_t near_blocks = mask_at_most(&center_squared[64 * t], bound.data()); near_blocks;
         near_blocks &= near_blocks - 1) {
      const std::size_t b = static_cast<std::size_t>(std::countr_zero(near_blocks));
      lists[b * capacity + count[b]++] = static_cast<std::uint32_t>(t);
    }
  }
}

// Distances of a block's samples to the triangles of its list.
void block_distances(const std::vector<TriangleFrame>& frames, const std::uint32_t* list, std::size_t count,
                     int block, float* out) {
  const float origin[3] = {static_cast<float>(4 * bit_x(block) - half_node),
                           static_cast<float>(4 * bit_y(block) - half_node),
                           static_cast<float>(4 * bit_z(block) - half_node)};
  std::fill_n(out, samples_per_block, std::numeric_limits<float>::infinity());
  lower_squared_distances(frames.data(), list, count, origin, 1.0f, out);
  square_roots(out);
}

// Joins the components of the node's blocks among each other, and numbers what remains.
void join_within_node(NodeBand& band, SheetCounting counting) {
  WeightedUnionFind sets(band.components.size());
  for (std::size_t block = 0; block < 64; ++block) {
    const std::uint32_t first = band.first[block];
    if (counting == SheetCounting::windings)
      for (std::uint32_t c = first + 1u; c < band.first[block + 1]; ++c)
        sets.unite(first, c, band.components[c].winding);
    for (int axis = 0; axis < 3; ++axis) {
      if ((block >> (2 * axis) & 3) == 3) continue;
      const std::size_t next = block + (std::size_t{1} << (2 * axis));
      const std::uint32_t first_next = band.first[next];
      join_blocks(band.side(static_cast<int>(block)), band.side(static_cast<int>(next)), axis,
                  band.face(static_cast<int>(block), axis), counting,
                  [&](std::size_t a, std::size_t b, std::int32_t winding) {
                    sets.unite(first + static_cast<std::uint32_t>(a),
                               first_next + static_cast<std::uint32_t>(b), winding);
                  });
    }
  }
  std::vector<std::uint32_t> number(band.components.size(), 0xFFFFFFFFu);
  for (std::uint32_t c = 0; c < band.components.size(); ++c) {
    const WeightedUnionFind::Root root = sets.find(c);
    if (number[root.root] == 0xFFFFFFFFu) number[root.root] = band.node_components++;
    band.components[c].winding = root.offset;
    band.components[c].node_component = number[root.root];
  }
}

} // namespace

NodeBand make_node_band(const VoxelMesh& mesh, const Vec3i& coord, std::span<const std::uint32_t> triangles,
                        const BandOptions& options) {
  NodeBand band;
  band.coord = coord;
  Scratch& s = scratch();
  const Vec3i first_sample = coord * node_dim;
  const Vec3d center =
      Vec3d(first_sample.x + half_node, first_sample.y + half_node, first_sample.z + half_node);
  const double reach = std::max(options.half_width_voxels, sign_reach);

  // Describe the triangles around the node's centre, and find how far each is from the centres of the 64
  // blocks.
  const std::size_t count = triangles.size();
  const std::size_t surface_count = static_cast<std::size_t>(
      std::lower_bound(triangles.begin(), triangles.end(), static_cast<std::uint32_t>(mesh.surface_count)) -
      triangles.begin());
  band.near_cap = surface_count < count;
  s.frames.resize(count);
  const double frame_reach = half_node * 1.7320508075688773 + reach + block_radius + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[triangles[i]];
    s.frames[i] = make_triangle_frame(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], center,
                                      frame_reach);
  }
  s.center_squared.resize(64 * count);
  const float first_center[3] = {-6, -6, -6};
  squared_distances_each(s.frames.data(), count, first_center, 4.0f, s.center_squared.data());

  // List each block's candidates: first of the surface, then of the caps.
  s.lists.resize(64 * count);
  std::array<std::uint32_t, 64> listed{}, listed_surface{};
  std::array<float, 64> nearest_surface, nearest_cap;
  list_candidates(0, surface_count, reach, s.center_squared.data(), count, s.lists.data(), listed,
                  nearest_surface);
  listed_surface = listed;
  list_candidates(surface_count, count, sign_reach, s.center_squared.data(), count, s.lists.data(), listed,
                  nearest_cap);

  const auto within = [](float squared, double distance) {
    return squared <= distance * distance * (1 + 1e-4) + 1e-4;
  };
  alignas(64) float surface[samples_per_block],
      sheets[samples_per_block + 16] = {}; // padded for pair_sums_above
  for (int block = 0; block < 64; ++block) {
    const std::size_t b = static_cast<std::size_t>(block);
    band.first[b] = static_cast<std::uint16_t>(band.components.size());
    bool keep =
        within(nearest_surface[b], reach + block_radius) || within(nearest_cap[b], sign_reach + block_radius);
    if (keep) {
      // Distances to the surface, and to surface and caps together.
      const std::uint32_t* list = &s.lists[b * count];
      block_distances(s.frames, list, listed_surface[b], block, surface);
      std::copy_n(surface, samples_per_block, sheets);
      if (listed[b] > listed_surface[b]) {
        block_distances(s.frames, list + listed_surface[b], listed[b] - listed_surface[b], block, sheets);
        lower_to(sheets, surface);
      }
      keep = mask_below(surface, static_cast<float>(reach)) != 0 ||
             mask_below(sheets, static_cast<float>(sign_reach)) != 0;
    }
    if (!keep) {
      band.components.push_back({~std::uint64_t{0}, 0, 0});
      continue;
    }
    band.kept |= std::uint64_t{1} << block;
    band.distance.insert(band.distance.end(), surface, surface + samples_per_block);
    if (band.near_cap)
      band.sheet_distance.insert(band.sheet_distance.end(), sheets, sheets + samples_per_block);
    if (!options.find_components) {
      band.components.push_back({~std::uint64_t{0}, 0, 0});
      continue;
    }

    // Split the block into regions of one winding number.
    s.mesh_list.clear();
    for (std::uint32_t i = 0; i < listed[b]; ++i) s.mesh_list.push_back(triangles[s.lists[b * count + i]]);
    const Vec3i block_first = first_sample + Vec3i(bit_x(block), bit_y(block), bit_z(block)) * block_dim;
    band.thin_places +=
        find_block_components(sheets, mesh, s.mesh_list, block_first, options.counting, band.components);
    if (options.pseudonormals) {
      band.votes.resize(band.components.size(), 0);
      for (std::size_t c = band.first[b]; c < band.components.size(); ++c)
        band.votes[c] =
            pseudonormal_vote(mesh, *options.pseudonormals, s.mesh_list, block_first, surface,
                              band.components[c].samples, static_cast<float>(options.half_width_voxels));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const FaceCrossing crossing =
          find_face_crossing(sheets, mesh, s.mesh_list, block_first, axis, options.counting);
      if (crossing.tested || crossing.free)
        band.faces.emplace_back(static_cast<std::uint16_t>(3 * block + axis), crossing);
    }
  }
  if (options.pseudonormals) band.votes.resize(band.components.size(), 0);
  band.first[64] = static_cast<std::uint16_t>(band.components.size());
  if (options.find_components) join_within_node(band, options.counting);
  return band;
}

} // namespace levelray
