// OpenEXR files of rendered images.
#pragma once

#include "levelray/render/camera.hpp"
#include "levelray/render/image.hpp"

#include <optional>
#include <string>

namespace levelray {

struct ExrOptions {
  const Camera* camera = nullptr; // when given: worldToCamera, worldToNDC and the screen window
  std::string software;           // e.g. "levelray 1.2.3"; empty: no such attribute
  std::string comments;           // e.g. what the channels mean; empty: none
  bool all_float = false;         // R, G, B, A as float, too: values as they are
  std::optional<int> frame{};     // attribute levelray:frame
  std::string scene_hash{};       // when given, the file is stamped: io/scene_stamp.hpp
};

// The bytes of a scan-line OpenEXR file with ZIP compression: channels R, G, B, A as half (values beyond its
// range become the largest finite half), id as unsigned integer, all others as float. The same image and
// options give the same bytes; nothing tells the time or the machine. Throws Error(failed) for images that
// OpenEXR refuses.
std::string encode_exr(const Image& image, const ExrOptions& options);

// The version of the library beneath, e.g. "3.1.5".
const char* openexr_version();

} // namespace levelray
