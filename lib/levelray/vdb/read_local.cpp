#include "levelray/vdb/read_local.hpp"

#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/vdb/archive_reader.hpp"
#include "levelray/vdb/describe_grid.hpp"
#include "levelray/vdb/fog_volume.hpp"
#include "levelray/vdb/from_openvdb.hpp"
#include "levelray/vdb/select_grid.hpp"
#include "levelray/vdb/to_openvdb.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

std::vector<VdbGridInfo> describe(const ArchiveReader& reader) {
  std::vector<VdbGridInfo> infos;
  for (const ArchivedGrid& grid : reader.grids()) infos.push_back(describe_grid(grid));
  return infos;
}

// What --iso makes of a grid's note: fog volumes will do, level sets will not.
void look_for_density(VdbGridInfo& info) {
  if (info.grid_class == "fog volume" && info.note.starts_with(fog_volume_note))
    info.note.clear();
  else if (info.grid_class == "level set" && info.note.empty())
    info.note = "is a level set already; --iso is for densities";
}

} // namespace

std::vector<VdbGridInfo> list_vdb_here(const std::string& path) {
  initialize_openvdb();
  return describe(ArchiveReader(path));
}

VdbFile read_vdb_here(const std::string& path, const VdbReadOptions& options) {
  initialize_openvdb();
  ArchiveReader reader(path);
  VdbFile file;
  file.grids = describe(reader);

  std::vector<VdbGridInfo> candidates = file.grids;
  if (options.iso)
    for (VdbGridInfo& info : candidates) look_for_density(info);
  const std::size_t index = select_grid(candidates, options.grid, path);
  const VdbGridInfo& info = candidates[index];
  const std::string place = fmt::format("{}: grid \"{}\"", path, info.name);
  if (!info.note.empty())
    throw Error(ErrorKind::bad_input, fmt::format("{} {}; has: {}", place, info.note, grid_list(file.grids)));

  openvdb::GridBase::Ptr grid = reader.read_tree(index);
  const GridTransform transform = uniform_transform(grid->transform(), place);
  const auto take = [&](auto& typed) {
    if (options.iso) subtract_from_iso(typed, *options.iso);
    file.grid = from_openvdb(typed, transform, place, options.max_memory, file.warnings);
  };
  if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
    take(*floats);
  else if (const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid))
    take(*doubles);
  else
    throw Error(ErrorKind::bad_input, place + " changed its type while it was read");
  if (info.grid_class != "level set" && !options.iso)
    file.warnings.insert(
        file.warnings.begin(),
        fmt::format("grid \"{}\" has no class; it is taken for a level set, because it has values of both "
                    "signs",
                    info.name));
  if (!info.name.empty()) file.grid.name = info.name;
  return file;
}

} // namespace levelray
