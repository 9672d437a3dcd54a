#include "levelray/trace/hit_normals.hpp"

#include "levelray/core/error.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <cassert>

namespace levelray {

namespace {

CellPosition cell_position(const Vec3d& origin, double per_voxel, const WorldRay& ray, const Hit& hit) {
  CellPosition at;
  at.cell = hit.cell;
  const Vec3d p = (ray.at(hit.t) - origin) * per_voxel;
  for (int a = 0; a < 3; ++a) at.local[a] = std::min(std::max(p[a] - hit.cell[a], 0.0), 1.0);
  return at;
}

constexpr int stride[3] = {1, SurfaceBlocks::record_stride_y, SurfaceBlocks::record_stride_z};

// Copies the 2x2 samples with index `side` along axis a, and 0 or 1 along the others, from a record in which
// the first of them lies at `first`.
template <int a, int side>
void copy_face(const float* first, Neighbourhood& samples) {
  constexpr int b = a == 0 ? 1 : 0, c = a == 2 ? 1 : 2;
  constexpr int x = a == 0 ? side : 0, y = a == 1 ? side : 0, z = a == 2 ? side : 0;
  samples.at(x, y, z) = first[0];
  samples.at(x + (b == 0), y + (b == 1), z) = first[stride[b]];
  samples.at(x, y + (c == 1), z + (c == 2)) = first[stride[c]];
  samples.at(x + (b == 0), y + (b == 1) + (c == 1), z + (c == 2)) = first[stride[b] + stride[c]];
}

// The same for a side outside the cell, -1 or 2, which may lie beyond the record of the cell's block: then it
// comes from that of the neighbour there, or from the grid where the neighbour is no surface block.
template <int a, int side>
void copy_side(const LevelSet& level_set, const Vec3i& cell, const float* corner, int offset,
               Neighbourhood& samples) {
  if ((cell[a] & 3) != (side < 0 ? 0 : block_dim - 1))
    return copy_face<a, side>(corner + side * stride[a], samples);
  Vec3i beyond = cell;
  beyond[a] += side;
  if (const float* const record = level_set.surface().find_record(beyond))
    return copy_face<a, side>(record + offset + (side < 0 ? side + block_dim : side - block_dim) * stride[a],
                              samples);
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      Vec3i at(0, 0, 0);
      at[a] = side, at[a == 0 ? 1 : 0] = p, at[a == 2 ? 1 : 2] = q;
      samples.at(at.x, at.y, at.z) = level_set.grid().value(cell.x + at.x, cell.y + at.y, cell.z + at.z);
    }
}

// Where the four samples cell-1 .. cell+2 along an axis lie: `count` of them, from neighbourhood index
// `first`, in the record of the block `shift` blocks away, from its index `at`. A record holds indices 0
// .. 4.
struct Piece {
  int first, count, shift, at;
};
int pieces_along(int cell_in_block, Piece (&pieces)[2]) {
  if (cell_in_block == 0) {
    pieces[0] = {-1, 1, -1, block_dim - 1};
    pieces[1] = {0, 3, 0, 0};
    return 2;
  }
  pieces[0] = {-1, std::min(4, block_dim + 2 - cell_in_block), 0, cell_in_block - 1};
  pieces[1] = {2, 1, 1, 1};
  return cell_in_block == block_dim - 1 ? 2 : 1;
}

// Fills in all 64 samples around a cell, from the records of up to eight blocks, or from the grid where a
// block is no surface block.
void copy_whole(const LevelSet& level_set, const Vec3i& cell, Neighbourhood& samples) {
  Piece pieces[3][2];
  int count[3];
  for (int a = 0; a < 3; ++a) count[a] = pieces_along(cell[a] & (block_dim - 1), pieces[a]);
  for (int r = 0; r < count[2]; ++r)
    for (int q = 0; q < count[1]; ++q)
      for (int p = 0; p < count[0]; ++p) {
        const Piece &x = pieces[0][p], &y = pieces[1][q], &z = pieces[2][r];
        const Vec3i block = cell + Vec3i(x.shift, y.shift, z.shift) * block_dim;
        const float* const record = level_set.surface().find_record(block);
        for (int k = 0; k < z.count; ++k)
          for (int j = 0; j < y.count; ++j)
            for (int i = 0; i < x.count; ++i)
              samples.at(x.first + i, y.first + j, z.first + k) =
                  record ? record[(x.at + i) * stride[0] + (y.at + j) * stride[1] + (z.at + k) * stride[2]]
                         : level_set.grid().value(cell.x + x.first + i, cell.y + y.first + j,
                                                  cell.z + z.first + k);
      }
}

// Fills in the 32 samples around a cell that most normal schemes look at, from the records, which are in
// cache because the tracer has just read them.
void copy_samples(const LevelSet& level_set, const Vec3i& cell, Neighbourhood& samples) {
  const float* const record = level_set.surface().find_record(cell);
  if (!record) { // no ray can have hit it
    samples = Neighbourhood(level_set.grid(), cell);
    return;
  }
  const int offset = (cell.x & 3) + (cell.y & 3) * stride[1] + (cell.z & 3) * stride[2];
  const float* const corner = record + offset;
  copy_face<0, 0>(corner, samples);
  copy_face<0, 1>(corner + stride[0], samples);
  copy_side<0, -1>(level_set, cell, corner, offset, samples);
  copy_side<0, 2>(level_set, cell, corner, offset, samples);
  copy_side<1, -1>(level_set, cell, corner, offset, samples);
  copy_side<1, 2>(level_set, cell, corner, offset, samples);
  copy_side<2, -1>(level_set, cell, corner, offset, samples);
  copy_side<2, 2>(level_set, cell, corner, offset, samples);
}

template <class Work>
void for_scheme(std::string_view scheme, Work&& work) {
  if (visit_method<NormalSchemes>(scheme, work)) return;
  std::string names;
  for (const std::string& known : method_names<NormalSchemes>()) names += (names.empty() ? "" : ", ") + known;
  throw Error(ErrorKind::usage, "unknown normal scheme '" + std::string(scheme) + "'; legal are " + names);
}

} // namespace

void hit_normals(const LevelSet& level_set, std::span<const WorldRay> rays, std::span<const Hit> hits,
                 std::string_view scheme, std::span<Vec3f> normals) {
  assert(rays.size() == hits.size() && hits.size() == normals.size());
  const GridTransform& transform = level_set.grid().transform;
  const Vec3d origin = transform.origin;
  const double per_voxel = 1 / transform.voxel_size;
  const auto work = [&]<class Scheme>(Scheme) {
    Neighbourhood samples;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i]) {
        normals[i] = Vec3f(0, 0, 0);
        continue;
      }
      if constexpr (Scheme::whole)
        copy_whole(level_set, hits[i].cell, samples);
      else
        copy_samples(level_set, hits[i].cell, samples);
      normals[i] = Vec3f(unit_normal<Scheme>(samples, cell_position(origin, per_voxel, rays[i], hits[i])));
    }
  };
  for_scheme(scheme, work);
}

RayCounts counts_of_normal(std::string_view scheme) {
  RayCounts counts;
  for_scheme(scheme, [&]<class Scheme>(Scheme) {
    counts.samples = Scheme::samples;
    counts.interpolations = Scheme::interpolations;
  });
  return counts;
}

Vec3f hit_normal(const LevelSet& level_set, const WorldRay& ray, const Hit& hit, std::string_view scheme) {
  Vec3f normal;
  hit_normals(level_set, {&ray, 1}, {&hit, 1}, scheme, {&normal, 1});
  return normal;
}

} // namespace levelray
