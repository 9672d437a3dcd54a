// A movie of a sequence's frames, encoded by the program `ffmpeg`.
#pragma once

#include "levelray/core/vec.hpp"

#include <string>
#include <vector>

namespace levelray {

struct MovieOptions {
  std::string path; // .mp4, .mov or .mkv; empty: none
  double fps = 24;
  Vec3d background{0.2, 0.2, 0.2}; // sRGB
};

// Throws Error(usage) when the movie's name or rate is not one that can be.
void check_movie(const MovieOptions& options);

// Whether there is a program of that name in PATH.
bool has_program(const std::string& name);

// Reads the pictures, our own and of one size, and pipes them to ffmpeg, which makes H.264 of them (yuv420p,
// BT.709, an odd size padded to even). The same pictures give the same bytes with the same ffmpeg. The movie
// replaces an older one when it is complete. Throws Error(failed) when ffmpeg is missing or fails, with what
// it said; Error(bad_input), Error(cannot_write).
void write_movie(const MovieOptions& options, const std::vector<std::string>& pictures);

} // namespace levelray
