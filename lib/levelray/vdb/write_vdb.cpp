#include "levelray/core/content_hash.hpp"
#include "levelray/core/error.hpp"
#include "levelray/vdb/to_openvdb.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <openvdb/io/Archive.h>

namespace levelray {

namespace {

// openvdb::io::File::write does not look whether its stream failed, so that a full disk passes for success.
// This archive writes the same bytes to a stream of ours, which throws.
class Writer : public openvdb::io::Archive {
 public:
  Writer() { setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK); }
  void write_to(std::ostream& stream, const openvdb::GridBase::ConstPtr& grid,
                const openvdb::MetaMap& metadata) const {
    Archive::write(stream, openvdb::GridCPtrVec{grid}, /*seekable=*/true, metadata);
  }
};

// Position and length of the identifier in a file: after the magic number (8 bytes), the file's version (4),
// the library's (4 + 4) and a flag (1).
constexpr std::streamoff uuid_offset = 21;
constexpr std::size_t uuid_length = 36;

// Replaces OpenVDB's random identifier by one that follows from the rest of the file.
void set_content_uuid(std::fstream& file) {
  ContentHash hash;
  const std::string blank(uuid_length, '0');
  file.seekp(uuid_offset);
  file.write(blank.data(), static_cast<std::streamsize>(uuid_length));
  file.flush();

  std::vector<char> buffer(std::size_t{1} << 20);
  file.seekg(0);
  file.exceptions(std::ios::badbit);
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), file.gcount() > 0)
    hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  file.clear();
  file.exceptions(std::ios::badbit | std::ios::failbit);

  const std::string uuid = hash.uuid();
  file.seekp(uuid_offset);
  file.write(uuid.data(), static_cast<std::streamsize>(uuid_length));
  file.close();
}

} // namespace

void write_vdb(const std::string& path, const BlockGrid& grid, const VdbWriteOptions& options) {
  constexpr float largest_half = 65504;
  float largest = grid.background;
  if (options.half)
    for (const float v : grid.values) largest = std::max(largest, std::fabs(v));
  if (options.half && !(largest <= largest_half))
    throw Error(
        ErrorKind::limit,
        fmt::format(
            "{}: distances up to {:.6g} do not fit 16-bit floats (at most {}); scale the mesh down or "
            "write 32-bit floats",
            path, largest, largest_half));
  initialize_openvdb();
  openvdb::FloatGrid::Ptr out;
  try {
    out = to_openvdb(grid);
  } catch (const Error& error) {
    throw Error(error.kind(), path + ": " + error.what());
  }
  out->setSaveFloatAsHalf(options.half);
  out->setIsInWorldSpace(true);
  out->setCreator(options.creator);

  errno = 0;
  try {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
    file.exceptions(std::ios::badbit | std::ios::failbit);
    openvdb::MetaMap metadata;
    if (!options.scene_hash.empty())
      metadata.insertMeta("levelray:scene_hash", openvdb::StringMetadata(options.scene_hash));
    Writer().write_to(file, out, metadata);
    file.flush();
    set_content_uuid(file);
  } catch (const std::ios::failure&) {
    const int reason = errno;
    throw Error(ErrorKind::cannot_write,
                fmt::format("{}: cannot write: {}", path, reason ? std::strerror(reason) : "output error"));
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorKind::cannot_write,
                fmt::format("{}: cannot write: {}", path, printable(error.what(), 200)));
  }
}

} // namespace levelray
