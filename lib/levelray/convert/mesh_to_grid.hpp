// From a triangle mesh to a narrow-band signed distance field on a block grid.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/mesh/prepare.hpp"

#include <functional>

namespace levelray {

enum class SignMethod { automatic, pseudonormal, winding, winding_abs, flood, unsigned_distance };
// The CLI's words, in the order of the enum: auto, pseudonormal, winding, winding-abs, flood, unsigned.
const std::vector<std::string>& sign_method_names();

struct ConvertOptions {
  double voxel_size = 0;        // world units; 0: longest side of the bounds / resolution
  int resolution = 256;         // voxels along the longest side
  double half_width_voxels = 3; // >= 1
  SignMethod sign = SignMethod::automatic;
  // 0: the mesh bounds solids. > 0 (world units): the result is the sheet of all points within this distance
  // of the mesh, twice as thick, whatever the mesh's topology; `sign` must be automatic or unsigned.
  double thicken = 0;
  std::uint64_t max_memory = 0; // bytes; 0: no limit
  std::function<void(const char* stage, double done)>
      progress; // called from any thread, done in [0,1]; may be empty
};

// What the conversion will need, estimated from the mesh's area before any work.
struct ConvertPlan {
  double voxel_size = 0;
  Vec3i dims{0, 0, 0}; // samples along the box of the band
  std::uint64_t active_samples = 0;
  std::uint64_t bytes = 0; // peak, besides the mesh
  double seconds = 0;      // on one thread of a current machine; a rough guess
};

struct ConvertReport {
  SignMethod sign = SignMethod::winding; // the method used
  std::string sign_reason;               // why, in words
  std::uint64_t inside_samples = 0;      // active samples inside
  double thickness = 0;                  // of the sheet, world units; 0: none was asked for
  double distance_ms = 0, sign_ms = 0;
  std::vector<std::string> warnings;
};

struct ConvertedGrid {
  BlockGrid grid;
  ConvertReport report;
};

// Throws Error(usage) for sizes that make no sense and sheets thinner than a voxel, Error(limit) where the
// grid would exceed max_memory or the index range.
ConvertPlan plan_conversion(const PreparedMesh& mesh, const ConvertOptions& options);

// Every sample within the half-width of the mesh holds its Euclidean distance to the nearest triangle, exact
// to rounding (convert/README.md derives 1e-5 voxel), with a sign decided apart. The result does not depend
// on the number of threads. With `thicken` = R the samples hold that distance less R, for all within the
// half-width of the sheet's boundary. Throws Error(bad_input) where no volume is enclosed (unless `unsigned`
// or thickened), and what plan_conversion throws.
ConvertedGrid mesh_to_grid(const PreparedMesh& mesh, const ConvertOptions& options);

} // namespace levelray
