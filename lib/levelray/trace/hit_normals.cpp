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

// Where the four samples cell-1 .. cell+2 along an axis lie: the first `low` of them in the record of one
// block, from its index `at[0]`, the others in that of the next block, from `at[1]`. A record holds indices
// 0 .. 4 of a block. `block` is the first block's lowest cell.
struct Split {
  int low, at[2], block;

  explicit Split(int cell) {
    const int place = cell & (block_dim - 1);
    low = place == 0 ? 1 : std::min(4, block_dim + 2 - place);
    at[0] = place == 0 ? block_dim - 1 : place - 1;
    at[1] = place == 0 ? 0 : 1;
    block = cell - place - (place == 0 ? block_dim : 0);
  }
};

// Copies 16 rows of four samples, of which the first `low` along x are in one record; what would be in a
// record that there is not comes from the grid.
template <int low>
void copy_rows(const BlockGrid& grid, const Vec3i& cell, const float* const (&records)[8], const Split& x,
               const Split& y, const Split& z, Neighbourhood& samples) {
  for (int k = 0; k < 4; ++k) {
    const int r = k >= z.low, row_z = (z.at[r] + k - r * z.low) * stride[2];
    for (int j = 0; j < 4; ++j) {
      const int q = j >= y.low, row = row_z + (y.at[q] + j - q * y.low) * stride[1];
      const auto copy = [&](int first, int end, const float* record, int at) {
        for (int i = first; i < end; ++i)
          samples.at(i - 1, j - 1, k - 1) = record
                                                ? record[row + at + i - first]
                                                : grid.value(cell.x + i - 1, cell.y + j - 1, cell.z + k - 1);
      };
      copy(0, low, records[2 * q + 4 * r], x.at[0]);
      if constexpr (low < 4) copy(low, 4, records[1 + 2 * q + 4 * r], x.at[1]);
    }
  }
}

// Fills in all 64 samples around a cell, from the records of up to eight blocks.
void copy_whole(const LevelSet& level_set, const Vec3i& cell, Neighbourhood& samples) {
  const Split x(cell.x), y(cell.y), z(cell.z);
  const float* records[8] = {};
  for (int c = 0; c < 8; ++c) {
    const int p = c & 1, q = c >> 1 & 1, r = c >> 2;
    if ((p && x.low == 4) || (q && y.low == 4) || (r && z.low == 4)) continue;
    records[c] = level_set.surface().find_record(
        {x.block + p * block_dim, y.block + q * block_dim, z.block + r * block_dim});
  }
  const auto copy = x.low == 4 ? copy_rows<4> : x.low == 3 ? copy_rows<3> : copy_rows<1>;
  copy(level_set.grid(), cell, records, x, y, z, samples);
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
