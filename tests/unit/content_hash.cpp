#include "levelray/core/content_hash.hpp"

#include "support/catch.hpp"

#include <set>

using namespace levelray;

TEST_CASE("a content's identifier depends on every byte and not on how they are cut") {
  std::string bytes(1000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i >> 3);
  const auto id = [](const std::string& text, std::size_t piece) {
    ContentHash hash;
    for (std::size_t at = 0; at < text.size(); at += piece)
      hash.add(text.data() + at, std::min(piece, text.size() - at));
    return hash.uuid();
  };
  const std::string whole = id(bytes, bytes.size());
  CHECK(whole.size() == 36);
  CHECK(whole[8] == '-');
  CHECK(whole[14] == '8');
  CHECK(std::string("89ab").find(whole[19]) != std::string::npos);
  for (const std::size_t piece : {1, 3, 7, 8, 9, 64, 999}) CHECK(id(bytes, piece) == whole);

  std::set<std::string> ids{whole};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ 1);
    ids.insert(id(other, 1000));
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) ids.insert(id(bytes.substr(0, length), 1000));
  CHECK(ids.size() == 2001);
}
