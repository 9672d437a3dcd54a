#include "levelray/io/reader_stream.hpp"

namespace levelray {

namespace {

constexpr std::uint64_t opening = 0x32524456524C5645;
constexpr std::uint64_t closing = 0x21646E652D656874;
enum Status : std::uint8_t { status_error = 0, status_read = 1 };

} // namespace

StreamOut::StreamOut(const ByteSink& write, std::uint64_t layout) : write_(write) {
  value(opening);
  value(status_read);
  value(layout);
}

void StreamOut::text(const std::string& s) {
  const auto length = static_cast<std::uint32_t>(std::min<std::size_t>(s.size(), stream_text_limit));
  value(length);
  write_(s.data(), length);
}

std::uint32_t StreamOut::count(std::size_t n) {
  const auto kept = static_cast<std::uint32_t>(std::min<std::size_t>(n, stream_list_limit));
  value(kept);
  return kept;
}

void StreamOut::close() {
  value(closing);
}

void send_error(const ByteSink& write, ErrorKind kind, const std::string& text) {
  const auto put = [&](const auto& v) { write(&v, sizeof v); };
  const auto length = static_cast<std::uint32_t>(std::min<std::size_t>(text.size(), stream_text_limit));
  put(opening);
  put(status_error);
  put(static_cast<std::int32_t>(kind));
  put(length);
  write(text.data(), length);
  put(closing);
}

StreamIn::StreamIn(const ByteSource& read, const std::string& path, std::uint64_t layout)
    : read_(read), path_(path) {
  check(value<std::uint64_t>() == opening, "its first bytes");
  const auto status = value<std::uint8_t>();
  if (status == status_error) {
    const auto kind = value<std::int32_t>();
    const std::string message = text();
    for (const ErrorKind known : {ErrorKind::bad_input, ErrorKind::limit, ErrorKind::failed})
      if (kind == static_cast<std::int32_t>(known)) throw Error(known, message);
    fail("an error of unknown kind");
  }
  check(status == status_read, "its status");
  check(value<std::uint64_t>() == layout, "its layout");
}

void StreamIn::fail(const char* what) const {
  throw Error(ErrorKind::bad_input, path_ + ": the reader process answered nonsense (" + what +
                                        "); the file is damaged or hostile");
}

std::string StreamIn::text() {
  const auto length = value<std::uint32_t>();
  check(length <= stream_text_limit, "a text's length");
  std::string s(length, '\0');
  read_(s.data(), length);
  return printable(s, stream_text_limit);
}

std::uint32_t StreamIn::count() {
  const auto n = value<std::uint32_t>();
  check(n <= stream_list_limit, "a list's length");
  return n;
}

void StreamIn::close() {
  check(value<std::uint64_t>() == closing, "its last bytes");
}

} // namespace levelray
