// Small sequences of meshes and level sets, and what the program says of them.
#pragma once

#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <map>
#include <sstream>

namespace levelray::test {

using Names = std::vector<std::string>;
using Arguments = std::vector<std::string>;

// Boxes in.0001.obj, in.0002.obj, ... that grow.
inline void write_boxes(const TemporaryFolder& folder, int first, int last) {
  char name[32];
  for (int frame = first; frame <= last; ++frame) {
    std::snprintf(name, sizeof name, "in.%04d.obj", frame);
    write_text(folder / name, box_obj(1 + 0.1 * frame, 1, 0.5));
  }
}

// The JSON lines of standard output.
inline std::vector<Json> json_lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (const Json json = Json::parse(line, nullptr, false); !json.is_discarded()) lines.push_back(json);
  return lines;
}

// The status of each frame in them.
inline std::map<int, std::string> statuses(const std::string& text) {
  std::map<int, std::string> all;
  for (const Json& line : json_lines(text))
    if (line.contains("frame")) all[line["frame"]] = line["status"];
  return all;
}

inline int count(const std::map<int, std::string>& statuses, const std::string& status) {
  int n = 0;
  for (const auto& [frame, s] : statuses) n += s == status;
  return n;
}

// Every file of a folder with its bytes.
inline std::map<std::string, std::string> contents(const TemporaryFolder& folder) {
  std::map<std::string, std::string> all;
  for (const std::string& name : folder.names()) all[name] = content_of(folder / name);
  return all;
}

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

} // namespace levelray::test
