#include "levelray/vdb/archive_reader.hpp"

#include "levelray/core/error.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

// OpenVDB's texts quote the file, and may be kilobytes of blanks: one line of at most 160 bytes.
std::string clean(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!blank)
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  }
  return printable(out, 160);
}

// Runs `read` and gives what goes wrong a place.
template <class Read>
void guarded(const std::string& place, const Read& read) {
  try {
    read();
  } catch (const std::ios_base::failure&) {
    throw Error(ErrorKind::bad_input,
                place + ": the file ends early or points beyond its end (truncated or damaged)");
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorKind::bad_input, place + ": " + clean(error.what()));
  } catch (const std::length_error&) {
    throw Error(ErrorKind::bad_input, place + ": an impossible length (damaged file)");
  }
}

} // namespace

ArchiveReader::ArchiveReader(const std::string& path) : path_(path) {
  stream_.open(path, std::ios::in | std::ios::binary);
  if (!stream_) throw Error(ErrorKind::bad_input, path + ": cannot be opened");
  stream_.exceptions(std::ios::badbit | std::ios::failbit);
  guarded(path, [&] {
    readHeader(stream_);
    metadata_ = std::make_shared<openvdb::io::StreamMetadata>(); // the stream does not keep it alive
    metadata_->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/false);
    setFormatVersion(stream_);
    setLibraryVersion(stream_);
    setDataCompression(stream_);
    openvdb::MetaMap().readMeta(stream_);
    read_descriptors();
  });
  if (!inputHasGridOffsets()) return;
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    if (!grids_[i].problem.empty()) continue;
    try {
      guarded(path, [&] { read_metadata(i); });
    } catch (const Error& error) {
      grids_[i].grid = nullptr;
      grids_[i].problem = std::string(error.what()).substr(path.size() + 2);
    }
  }
}

void ArchiveReader::read_descriptors() {
  const std::int32_t count = readGridCount(stream_);
  if (count < 0) throw Error(ErrorKind::bad_input, fmt::format("{}: announces {} grids", path_, count));
  for (std::int32_t i = 0; i < count; ++i) {
    openvdb::io::GridDescriptor descriptor;
    ArchivedGrid grid;
    try {
      grid.grid = descriptor.read(stream_);
    } catch (const openvdb::LookupError&) { // a type nobody registered: its positions come next
      if (!inputHasGridOffsets()) throw;
      grid.problem = fmt::format("of unknown type \"{}\"", clean(descriptor.gridType()));
      std::int64_t positions[3];
      stream_.read(reinterpret_cast<char*>(positions), sizeof positions);
      descriptor.setGridPos(positions[0]);
      descriptor.setBlockPos(positions[1]);
      descriptor.setEndPos(positions[2]);
    }
    grid.name = descriptor.gridName();
    grid.type = descriptor.gridType();
    if (inputHasGridOffsets())
      descriptor.seekToEnd(stream_);
    else
      readGrid(grid.grid, descriptor, stream_);
    descriptors_.push_back(descriptor);
    grids_.push_back(std::move(grid));
  }
}

// In the order of openvdb::io::Archive::readGrid.
void ArchiveReader::read_metadata(std::size_t index) {
  constexpr std::uint32_t transform_before_tree = 216; // OPENVDB_FILE_VERSION_GRID_INSTANCING
  stream_.clear();
  descriptors_[index].seekToGrid(stream_);
  readGridCompression(stream_);
  grids_[index].grid->readMeta(stream_);
  if (fileVersion() >= transform_before_tree) grids_[index].grid->readTransform(stream_);
}

openvdb::GridBase::Ptr ArchiveReader::read_tree(std::size_t index) {
  const std::string place = fmt::format("{}: grid \"{}\"", path_, printable(grids_[index].name, 60));
  const openvdb::io::GridDescriptor& own = descriptors_[index];

  // An instance shares the tree of another grid.
  std::size_t source = index;
  if (own.isInstance()) {
    source = 0;
    while (source < descriptors_.size() && descriptors_[source].uniqueName() != own.instanceParentName())
      ++source;
    if (source == descriptors_.size() || descriptors_[source].isInstance() || !grids_[source].grid ||
        grids_[source].type != grids_[index].type)
      throw Error(ErrorKind::bad_input, place + ": shares the tree of a grid that is not there");
  }
  if (inputHasGridOffsets()) {
    guarded(place, [&] {
      stream_.clear();
      grids_[source].grid = openvdb::GridBase::createGrid(grids_[source].type);
      grids_[source].grid->setSaveFloatAsHalf(descriptors_[source].saveFloatAsHalf());
      descriptors_[source].seekToGrid(stream_);
      readGrid(grids_[source].grid, descriptors_[source], stream_);
    });
  }
  if (source != index) grids_[index].grid->setTree(grids_[source].grid->baseTreePtr());
  return grids_[index].grid;
}

} // namespace levelray
