#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/vdb/level_set_check.hpp"
#include "levelray/vdb/read_local.hpp"
#include "levelray/vdb/reader_process.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace levelray {

namespace {

// Turns down what is plainly no OpenVDB file, before OpenVDB sees it.
void check_is_vdb(const std::string& path) {
  const auto fail = [&](const std::string& reason) {
    throw Error(ErrorKind::bad_input, path + ": " + reason);
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("no such file");
  if (status.type() == std::filesystem::file_type::directory) fail("is a directory");
  if (status.type() != std::filesystem::file_type::regular) fail("is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(std::string("cannot be opened: ") + std::strerror(errno));
  constexpr std::array<char, 8> magic{' ', 'B', 'D', 'V', 0, 0, 0, 0};
  std::array<char, 8> head{};
  stream.read(head.data(), head.size());
  if (stream.gcount() == 0) fail("empty file");
  if (head != magic) fail("not an OpenVDB file");
}

} // namespace

VdbFile read_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  VdbFile file =
      options.trust_input ? read_vdb_here(path, options) : read_in_child(path, options, /*list_only=*/false);
  complete_blocks(file.grid, options.max_memory);
  for (std::string& remark : level_set_remarks(file.grid)) file.warnings.push_back(std::move(remark));
  return file;
}

std::vector<VdbGridInfo> list_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  return options.trust_input ? list_vdb_here(path) : read_in_child(path, options, /*list_only=*/true).grids;
}

} // namespace levelray
