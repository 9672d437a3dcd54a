#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/io/limited_process.hpp"
#include "levelray/vdb/level_set_check.hpp"
#include "levelray/vdb/read_local.hpp"
#include "levelray/vdb/reader_process.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

// Turns down what is plainly no OpenVDB file, before OpenVDB sees it.
void check_is_vdb(const std::string& path) {
  check_first_bytes(path, std::string_view(" BDV\0\0\0\0", 8), "an OpenVDB file");
}

// Makes distances of the grid's values, and says what that did.
std::string redistance_file(VdbFile& file, const std::string& path, const VdbReadOptions& options) {
  RedistanceOptions how;
  how.half_width_voxels = options.redistance_half_width_voxels;
  how.max_memory = options.max_memory;
  RedistanceReport report;
  try {
    file.grid = redistance(file.grid, how, &report);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::usage) throw;
    throw Error(error.kind(),
                fmt::format("{}: grid \"{}\" {}", path, printable(file.grid.name, 60), error.what()));
  }
  file.redistanced = report;
  return fmt::format(
      "redistanced, which moved the surface by {:.2g} voxel (rms; at most {:.2g}); the median is {:.2f} now",
      report.rms_moved_voxels, report.largest_moved_voxels, report.after.gradient_median);
}

} // namespace

VdbFile read_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  VdbFile file =
      options.trust_input ? read_vdb_here(path, options) : read_in_child(path, options, /*list_only=*/false);
  complete_blocks(file.grid, options.max_memory);
  file.facts = field_facts(file.grid);
  const bool wanted = options.redistance == Redistance::always ||
                      (options.redistance == Redistance::automatic && !file.facts.is_distance());
  // Of a grid that was redistanced, band and background are new: only why it was is of interest.
  if (wanted) {
    const std::string done = redistance_file(file, path, options);
    if (!file.facts.is_distance()) file.warnings.push_back(describe_field(file.facts) + "; " + done);
    return file;
  }
  for (std::string& remark : level_set_remarks(file.grid, file.facts))
    file.warnings.push_back(std::move(remark));
  return file;
}

std::vector<VdbGridInfo> list_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  return options.trust_input ? list_vdb_here(path) : read_in_child(path, options, /*list_only=*/true).grids;
}

} // namespace levelray
