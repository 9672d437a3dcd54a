// The grids of an OpenVDB file, one by one. Everything here may crash, hang or run out of memory on a bad
// file, because OpenVDB may; see read_vdb for the limited process it runs in.
#pragma once

#include <fstream>
#include <map>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <string>
#include <vector>

namespace levelray {

// One grid of the file. `grid` has metadata and transform only, until read_tree.
struct ArchivedGrid {
  std::string name;
  std::string type;            // the tree's type name, as in the file
  openvdb::GridBase::Ptr grid; // null when its type or metadata cannot be read; then `problem` says why
  std::string problem;
};

// openvdb::io::File reads on at the end of a truncated file and stops at the first grid of unknown type. This
// reads the same format through OpenVDB's own grid readers from a stream that throws, and keeps to itself
// what it cannot read.
class ArchiveReader : private openvdb::io::Archive {
 public:
  // Reads the header and the metadata of all grids. Throws Error(bad_input) naming the file.
  explicit ArchiveReader(const std::string& path);

  const std::vector<ArchivedGrid>& grids() const { return grids_; }

  // Reads the tree of grid `index` and returns the whole grid. Throws Error(bad_input) naming file and grid.
  openvdb::GridBase::Ptr read_tree(std::size_t index);

 private:
  void read_descriptors();
  void read_metadata(std::size_t index);

  std::string path_;
  std::ifstream stream_;
  openvdb::io::StreamMetadata::Ptr metadata_;
  std::vector<openvdb::io::GridDescriptor> descriptors_;
  std::vector<ArchivedGrid> grids_;
};

} // namespace levelray
