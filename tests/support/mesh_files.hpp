// Small mesh files for tests of the program.
#pragma once

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

namespace levelray::test {

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// A closed, outward box from (0,0,0) to (x,y,z), of 12 triangles.
inline std::string box_obj(double x, double y, double z) {
  std::ostringstream text;
  text.precision(17);
  for (int c = 0; c < 8; ++c)
    text << "v " << (c & 1 ? x : 0) << " " << (c & 2 ? y : 0) << " " << (c & 4 ? z : 0) << "\n";
  return text.str() + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

// A closed, outward ball of radius 1 around the origin, of 2 n^2 quads less the poles.
inline std::string ball_obj(int n) {
  std::string text = "v 0 0 1\n";
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double theta = std::numbers::pi * i / n, phi = std::numbers::pi * j / n;
      text += "v " + std::to_string(std::sin(theta) * std::cos(phi)) + " " +
              std::to_string(std::sin(theta) * std::sin(phi)) + " " + std::to_string(std::cos(theta)) + "\n";
    }
  text += "v 0 0 -1\n";
  const auto at = [&](int i, int j) { return std::to_string(2 + (i - 1) * 2 * n + j % (2 * n)); };
  const std::string south = std::to_string(2 + (n - 1) * 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    text += "f 1 " + at(1, j) + " " + at(1, j + 1) + "\n";
    for (int i = 1; i + 1 < n; ++i)
      text += "f " + at(i, j) + " " + at(i + 1, j) + " " + at(i + 1, j + 1) + " " + at(i, j + 1) + "\n";
    text += "f " + south + " " + at(n - 1, j + 1) + " " + at(n - 1, j) + "\n";
  }
  return text;
}

} // namespace levelray::test
