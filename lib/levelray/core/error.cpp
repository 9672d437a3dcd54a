#include "levelray/core/error.hpp"

namespace levelray {

namespace {

// Length in bytes of the UTF-8 sequence that starts at `at`, or 0 when it is not one (RFC 3629, section 4;
// overlong forms of three and four bytes pass, which matters to no terminal).
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(at);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : (lead & 0xF0) == 0xE0       ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
  return length;
}

} // namespace

std::string printable(const std::string& text, std::size_t max_bytes) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const bool control = length == 1 && (static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7F);
    const std::string piece = length == 0 || control ? "?" : text.substr(i, length);
    if (out.size() + piece.size() + 3 > max_bytes && i + piece.size() < text.size()) return out + "...";
    out += piece;
    i += length == 0 ? 1 : length;
  }
  return out;
}

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(printable(message, max_length)), kind_(kind) {}

} // namespace levelray
