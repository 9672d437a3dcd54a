// OpenVDB files in and out. OpenVDB's headers stay inside this folder.
#pragma once

#include "levelray/convert/redistance.hpp"
#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

struct VdbWriteOptions {
  bool half = false; // store 16-bit floats
  std::string creator = "levelray";
  std::string scene_hash; // file metadata "levelray:scene_hash" (io/scene_stamp.hpp); empty: none
};

// Writes `grid` as an OpenVDB level set to `path` itself (use write_file_atomically around it). The bytes
// follow from the grid alone. Throws Error(cannot_write); Error(limit) for voxel sizes that OpenVDB cannot
// represent.
void write_vdb(const std::string& path, const BlockGrid& grid, const VdbWriteOptions& options = {});

// Throws Error(limit) for a voxel size, in world units, that OpenVDB cannot represent: what write_vdb would
// say, to be asked before long work.
void check_vdb_voxel_size(double voxel_size);
double smallest_vdb_voxel_size(); // that it accepts, to rounding

// When to make distances of a grid's values (convert/redistance.hpp): never, where they are none
// (FieldFacts::is_distance), or always.
enum class Redistance { never, automatic, always };

struct VdbReadOptions {
  std::string grid; // name, "name[i]" for the i-th of that name, or "[i]" for the i-th grid; empty: the only
                    // level set
  bool trust_input = false;                          // read in this process instead of a limited child
  std::uint64_t max_memory = std::uint64_t{8} << 30; // bytes, for the child and for the grid
  double timeout_seconds = 60;
  // Take a fog volume for a solid whose surface is where the density has this value, > 0: what is read is
  // iso - density. Only fog volumes and grids without a class are looked for then.
  std::optional<float> iso;
  Redistance redistance = Redistance::never;
  double redistance_half_width_voxels = 3;
};

// One line about each grid of a file.
struct VdbGridInfo {
  std::string name, type, grid_class, note; // note: why it cannot be traced, empty when it can
  std::uint64_t active_samples = 0;
  double voxel_size = 0;
};

struct VdbFile {
  BlockGrid grid;
  FieldFacts facts;                            // of the grid as it was read
  std::optional<RedistanceReport> redistanced; // when it was
  std::vector<VdbGridInfo> grids;              // of the whole file
  std::vector<std::string> warnings;
};

// Reads a level set (or with `iso` a fog volume): float, double or half, uniform scale. Throws
// Error(bad_input) with the reason and the candidates, Error(limit) over memory or time.
VdbFile read_vdb(const std::string& path, const VdbReadOptions& options = {});
std::vector<VdbGridInfo> list_vdb(const std::string& path, const VdbReadOptions& options = {});

} // namespace levelray
