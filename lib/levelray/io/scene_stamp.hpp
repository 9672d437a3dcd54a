// What tells an output that is whole and up to date from every other file.
//
// A stamped file carries the hash of all that decided its bytes (the scene hash) and a hash of its own
// content, both as the text of ContentHash::uuid: in OpenEXR as the string attributes `levelray:scene_hash`
// and `levelray:content`, in PNG as tEXt chunks of these keywords before IEND, in OpenVDB as file metadata
// and as the file's UUID. A file is trusted when its bytes give the content that it states: what is cut,
// damaged or somebody else's does not. The check looks for the stamp at its known place and decodes nothing.
// No protection against forgery.
#pragma once

#include <string>

namespace levelray {

inline constexpr const char* scene_hash_name = "levelray:scene_hash";
inline constexpr const char* content_name = "levelray:content";
inline constexpr std::size_t content_length = 36; // of both texts

// Fills in the content of an OpenEXR file whose attribute `levelray:content` holds 36 zeros.
void seal_exr(std::string& bytes);

// Adds both chunks to a PNG file.
void stamp_png(std::string& bytes, const std::string& scene_hash);

// Why the file at `path` is not the one that `scene_hash` stands for: "does not exist", "is damaged", …;
// empty when it is that file, whole. The kind of file is told by its first bytes. Never throws for what the
// file holds.
std::string distrust(const std::string& path, const std::string& scene_hash);

} // namespace levelray
