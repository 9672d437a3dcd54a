#include "levelray/io/mesh_formats.hpp"
#include "levelray/io/off_header.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

namespace levelray {

namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  const char* what; // "is ..."
};

// What people hand over by mistake, by its first bytes.
constexpr Signature foreign[] = {
    {"\x1F\x8B"sv, "gzip-compressed; gunzip it first"},
    {"BZh"sv, "bzip2-compressed; bunzip2 it first"},
    {"\xFD\x37zXZ"sv, "xz-compressed; unxz it first"},
    {"\x28\xB5\x2F\xFD"sv, "zstd-compressed; unzstd it first"},
    {"PK\x03\x04"sv, "a zip archive (or 3MF, USDZ); unpack it first"},
    {"version https://git-lfs"sv, "a git-LFS pointer, not the file itself; run git lfs pull"},
    {"glTF"sv, "binary glTF, which is not supported; save it as OBJ, PLY, STL or OFF"},
    {"Kaydara FBX"sv, "FBX, which is not supported; save it as OBJ, PLY, STL or OFF"},
    {"PXR-USDC"sv, "USD, which is not supported; save it as OBJ, PLY, STL or OFF"},
    {"#usda"sv, "USD, which is not supported; save it as OBJ, PLY, STL or OFF"},
    {"DRACO"sv, "Draco-compressed; decode it first"},
    {"\x20\x42\x44\x56"sv, "an OpenVDB grid, not a mesh"},
    {"\x89PNG"sv, "a PNG picture, not a mesh"},
    {"\x76\x2F\x31\x01"sv, "an OpenEXR picture, not a mesh"},
    {"\x7F"
     "ELF"sv,
     "a program, not a mesh"},
    {"%PDF"sv, "a PDF, not a mesh"},
    {"# vtk DataFile"sv, "VTK, which is not supported; save it as OBJ, PLY, STL or OFF"},
    {"<!DOCTYPE"sv, "a web page, not a mesh; the download may have failed"},
    {"<html"sv, "a web page, not a mesh; the download may have failed"},
    {"<?xml"sv, "XML, which is not supported; save it as OBJ, PLY, STL or OFF"},
};

bool is_utf16(std::string_view text) {
  if (text.substr(0, 2) == "\xFF\xFE"sv || text.substr(0, 2) == "\xFE\xFF"sv) return true;
  // Without a mark: every other byte of the beginning is 0.
  const std::string_view start = text.substr(0, 64);
  if (start.size() < 8) return false;
  for (const std::size_t zero : {0u, 1u}) {
    bool all = true;
    for (std::size_t i = 0; i < start.size(); ++i)
      all = all && ((start[i] == '\0') == (i % 2 == zero)) &&
            (start[i] == '\0' || is_space(start[i]) || start[i] >= ' ');
    if (all) return true;
  }
  return false;
}

} // namespace

std::string sniff_format(const MeshSource& source) {
  const std::string_view text(source.begin(), source.size());
  // The header of a binary STL may hold any words, those of other formats too; that the announced size is the
  // file's is no accident. No text has a count below 2^29 in that place.
  if (is_exact_binary_stl(source)) return "stl";
  for (const Signature& signature : foreign)
    if (text.substr(0, signature.bytes.size()) == signature.bytes)
      source.fail(fmt::format("is {}", signature.what));
  if (is_utf16(text)) source.fail(source.begin(), "is UTF-16 text; convert it to UTF-8");

  TextCursor cursor{source.begin(), source.end()};
  if (cursor.word() == "ply") {
    cursor.skip_blanks();
    if (cursor.at_line_end()) return "ply";
  }

  // Text STL: with a facet or an end close to its beginning.
  cursor.at = source.begin();
  cursor.skip_space();
  const std::string_view first = cursor.word();
  if (equal_ignoring_case(first, "solid")) {
    const std::string start(text.substr(0, 2048));
    for (const char* word : {"facet", "FACET", "Facet", "endsolid", "ENDSOLID"})
      if (start.find(word) != std::string::npos) return "stl";
  }

  cursor.at = source.begin();
  for (;;) {
    cursor.skip_space();
    if (cursor.at_end() || *cursor.at != '#') break;
    cursor.skip_rest_of_line();
  }
  const OffHeader off = find_off_header({cursor.at, static_cast<std::size_t>(cursor.end - cursor.at)});
  return off.found ? "off" : "";
}

} // namespace levelray
