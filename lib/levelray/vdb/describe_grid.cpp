#include "levelray/vdb/describe_grid.hpp"

#include "levelray/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

// Relative difference of scales that still counts as none: shifts a sample by at most 0.004 voxel across 4096
// samples, and is more than files written with 32-bit matrices show (6e-8).
constexpr double scale_tolerance = 1e-6;

// Why the transform is not a uniform scale and a translation; empty when it is.
std::string transform_problem(const openvdb::math::Transform& transform, GridTransform* result) {
  if (!transform.isLinear()) return "has a frustum transform, which is not supported";
  const openvdb::math::Mat4d m = transform.baseMap()->getAffineMap()->getMat4(); // acts on row vectors
  double rows[3][3], length[3], largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[i][j] = m(i, j);
    length[i] = std::sqrt(rows[i][0] * rows[i][0] + rows[i][1] * rows[i][1] + rows[i][2] * rows[i][2]);
    largest = std::max(largest, length[i]);
    if (!std::isfinite(length[i]) || !std::isfinite(m(3, i))) return "has a transform that is not finite";
  }
  for (int i = 0; i < 3; ++i)
    if (!(length[i] > largest * 1e-12)) return "has a singular transform: voxels without volume";

  double off_diagonal = 0, skew = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (i == j) continue;
      off_diagonal = std::max(off_diagonal, std::fabs(rows[i][j]) / largest);
      const double dot = rows[i][0] * rows[j][0] + rows[i][1] * rows[j][1] + rows[i][2] * rows[j][2];
      skew = std::max(skew, std::fabs(dot) / (length[i] * length[j]));
    }
  if (skew > scale_tolerance) return "has sheared voxels, which are not supported";
  if (off_diagonal > scale_tolerance)
    return "has rotated voxels, which are not supported; resample it without the rotation";
  for (int i = 0; i < 3; ++i)
    if (rows[i][i] < 0) return "has a mirroring transform, which is not supported";
  for (int i = 0; i < 3; ++i)
    if (std::fabs(length[i] - length[0]) > scale_tolerance * largest)
      return fmt::format("has non-uniform voxels, which are not supported: {:.6g} x {:.6g} x {:.6g}",
                         length[0], length[1], length[2]);
  if (result) {
    result->voxel_size = rows[0][0];
    result->origin = Vec3d(m(3, 0), m(3, 1), m(3, 2));
  }
  return {};
}

} // namespace

GridTransform uniform_transform(const openvdb::math::Transform& transform, const std::string& place) {
  GridTransform result;
  const std::string problem = transform_problem(transform, &result);
  if (!problem.empty()) throw Error(ErrorKind::bad_input, place + " " + problem);
  return result;
}

VdbGridInfo describe_grid(const ArchivedGrid& archived) {
  VdbGridInfo info;
  info.name = printable(archived.name, 60);
  if (!archived.grid) {
    info.type = printable(archived.type, 40);
    info.note = archived.problem;
    return info;
  }
  const openvdb::GridBase& grid = *archived.grid;
  const openvdb::GridClass grid_class = grid.getGridClass();
  info.type = printable(grid.valueType(), 40);
  info.grid_class = openvdb::GridBase::gridClassToString(grid_class);
  info.voxel_size = grid.voxelSize().x();
  if (const auto count = grid.getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_VOXEL_COUNT))
    info.active_samples = static_cast<std::uint64_t>(std::max<openvdb::Int64>(count->value(), 0));

  if (info.type.rfind("ptdata", 0) == 0)
    info.note = "holds points, not a surface; turn them into a mesh or level set first";
  else if (!grid.isType<openvdb::FloatGrid>() && !grid.isType<openvdb::DoubleGrid>())
    info.note = fmt::format("holds {} values; a level set holds float or double", info.type);
  else if (grid_class == openvdb::GRID_FOG_VOLUME)
    info.note = fog_volume_note;
  else if (grid_class == openvdb::GRID_STAGGERED)
    info.note = "is a staggered grid, not a level set";
  else
    info.note = transform_problem(grid.transform(), nullptr);
  return info;
}

} // namespace levelray
