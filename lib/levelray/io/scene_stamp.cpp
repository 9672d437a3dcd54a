#include "levelray/io/scene_stamp.hpp"

#include "levelray/core/content_hash.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace levelray {

namespace {

// The stamp is in the header, which is shorter than this; PNG has it at the end.
constexpr std::size_t header_limit = 65536;

std::string little_endian(std::uint32_t n) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(n >> 8 * i);
  return bytes;
}
std::string big_endian(std::uint32_t n) {
  const std::string bytes = little_endian(n);
  return {bytes.rbegin(), bytes.rend()};
}

// CRC-32 of ISO 3309, as PNG chunks end with (ISO/IEC 15948:2003, annex D).
std::uint32_t crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      t[n] = n;
      for (int bit = 0; bit < 8; ++bit) t[n] = (t[n] & 1 ? 0xEDB88320u : 0u) ^ t[n] >> 1;
    }
    return t;
  }();
  std::uint32_t crc = ~0u;
  for (const char c : bytes) crc = table[(crc ^ static_cast<unsigned char>(c)) & 0xFF] ^ crc >> 8;
  return ~crc;
}

std::string text_chunk(const std::string& keyword, const std::string& text) {
  const std::string body = "tEXt" + keyword + '\0' + text;
  return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(crc32(body));
}

// What precedes a text of 36 bytes in the headers of OpenEXR (name, type, size; OpenEXR file layout,
// "Attribute layout") and OpenVDB (openvdb/MetaMap.cc, writeMeta: each string after its length).
std::string exr_attribute(const std::string& name) {
  return name + '\0' + "string" + '\0' + little_endian(content_length);
}
std::string vdb_metadata(const std::string& name) {
  return little_endian(static_cast<std::uint32_t>(name.size())) + name + little_endian(6) + "string" +
         little_endian(content_length);
}

// Hashes a stream from its beginning, `size` bytes of it, those from `blank` on for content_length as zeros.
std::string content_of(std::istream& file, std::uint64_t size, std::uint64_t blank) {
  ContentHash hash;
  std::vector<char> buffer(std::size_t{1} << 20);
  file.clear();
  file.seekg(0);
  for (std::uint64_t at = 0; at < size;) {
    check_cancel();
    const auto wanted = static_cast<std::streamsize>(std::min<std::uint64_t>(buffer.size(), size - at));
    file.read(buffer.data(), wanted);
    const auto count = static_cast<std::uint64_t>(file.gcount());
    if (count == 0) return "";
    for (std::uint64_t i = std::max(at, blank); i < std::min(at + count, blank + content_length); ++i)
      buffer[i - at] = '0';
    hash.add(buffer.data(), count);
    at += count;
  }
  return hash.uuid();
}

std::string png_tail(const std::string& scene_hash, const std::string& content) {
  return text_chunk(scene_hash_name, scene_hash) + text_chunk(content_name, content) + big_endian(0) +
         "IEND" + big_endian(crc32("IEND"));
}

constexpr const char* not_ours = "was not written by a sequence of levelray";
constexpr const char* other_scene = "belongs to other inputs or options";
constexpr const char* damaged = "is cut or damaged";

std::string distrust_png(std::istream& file, std::uint64_t size, const std::string& scene_hash) {
  const std::string end = png_tail(scene_hash, std::string(content_length, '0'));
  if (size < end.size()) return damaged;
  std::string found(end.size(), '\0');
  file.seekg(static_cast<std::streamoff>(size - end.size()));
  file.read(found.data(), static_cast<std::streamsize>(found.size()));
  const std::size_t name = found.find(scene_hash_name), length = std::string(scene_hash_name).size() + 1;
  if (name == std::string::npos) return found.ends_with(end.substr(end.size() - 12)) ? not_ours : damaged;
  if (found.compare(name + length, content_length, scene_hash) != 0) return other_scene;
  // The content is hashed without the stamp, and everything in the stamp follows from it.
  const std::string content = content_of(file, size - end.size(), size);
  return found == png_tail(scene_hash, content) ? "" : damaged;
}

} // namespace

void seal_exr(std::string& bytes) {
  const std::string marker = exr_attribute(content_name);
  const std::size_t at = bytes.substr(0, header_limit).find(marker);
  if (at == std::string::npos)
    throw Error(ErrorKind::failed, "OpenEXR: the header has no place for its stamp");
  ContentHash hash;
  hash.add(bytes.data(), bytes.size());
  bytes.replace(at + marker.size(), content_length, hash.uuid());
}

void stamp_png(std::string& bytes, const std::string& scene_hash) {
  bytes.resize(bytes.size() - 12); // IEND
  ContentHash hash;
  hash.add(bytes.data(), bytes.size());
  bytes += png_tail(scene_hash, hash.uuid());
}

std::string distrust(const std::string& path, const std::string& scene_hash) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return "does not exist";
  if (status.type() != fs::file_type::regular) return "is no regular file";
  const std::uint64_t size = fs::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return "cannot be read";

  std::string header(std::min<std::uint64_t>(size, header_limit), '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (header.starts_with("\x89PNG\r\n\x1A\n")) return distrust_png(file, size, scene_hash);
  const bool is_exr = header.starts_with("\x76\x2F\x31\x01");
  const bool is_vdb = header.starts_with(" BDV");
  if (!is_exr && !is_vdb) return not_ours;

  const std::string name = is_exr ? exr_attribute(scene_hash_name) : vdb_metadata(scene_hash_name);
  const std::size_t found = header.find(name);
  if (found == std::string::npos) return not_ours;
  if (header.compare(found + name.size(), content_length, scene_hash) != 0) return other_scene;
  // OpenVDB's UUID lies after the magic number (8 bytes), the file's version (4), the library's (8) and a
  // flag (1).
  const std::string marker = exr_attribute(content_name);
  const std::size_t marked = is_exr ? header.find(marker) : 0;
  if (marked == std::string::npos) return not_ours;
  const std::size_t place = is_exr ? marked + marker.size() : 21;
  const std::string content = content_of(file, size, place);
  return header.compare(place, content_length, content) == 0 && !content.empty() ? "" : damaged;
}

} // namespace levelray
