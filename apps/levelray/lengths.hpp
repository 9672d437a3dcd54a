// Numbers with units, as options take them.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>
#include <string>

namespace levelray {

// A length as the user said it: "0.5mm", "2e-3", "0.5%", "3vx".
struct Length {
  enum class Unit { plain, voxels, percent, millimetres, centimetres, metres, inches };
  double value = 0;
  Unit unit = Unit::plain;
};

// The unit that the input's coordinates are in, as `--units` takes it: "mm", "cm", "m", "in", or ""
// (unknown).
Length::Unit parse_unit(const std::string& text);

// A positive number followed by nothing or by mm, cm, m, in, %, vx. Throws Error(usage), naming the option.
Length parse_length(const std::string& option, const std::string& text);

// What lengths are measured with.
struct LengthScale {
  Length::Unit input = Length::Unit::plain; // of the input's coordinates
  double diagonal = 0;                      // of the bounding box, input units; what % is of
  double voxel_size = 0;                    // input units; what vx counts; 0: not known yet
};

// The length in input units. Throws Error(usage) where the scale does not tell: millimetres of an input
// without units, voxels before there are any.
double resolve_length(const std::string& option, const Length& length, const LengthScale& scale);

// Bytes: a number and nothing, B, kB, MB, GB, TB (powers of 1000) or KiB, MiB, GiB, TiB (powers of 1024).
// Throws Error(usage).
std::uint64_t parse_bytes(const std::string& option, const std::string& text);

// "x,y,z": three finite numbers. Throws Error(usage).
Vec3d parse_vector(const std::string& option, const std::string& text);

// A finite number with nothing after it, read without regard to the locale; false otherwise.
bool parse_number(std::string_view text, double* value, std::string_view* rest);

} // namespace levelray
