#include "levelray/vdb/select_grid.hpp"

#include "levelray/core/error.hpp"

#include <charconv>
#include <fmt/format.h>

namespace levelray {

namespace {

// Splits "name[i]" into name and i; false when it does not end so.
bool split_index(const std::string& text, std::string& name, std::size_t& index) {
  const std::size_t open = text.rfind('[');
  if (open == std::string::npos || text.back() != ']') return false;
  const char* last = text.data() + text.size() - 1;
  const auto [end, error] = std::from_chars(text.data() + open + 1, last, index);
  if (error != std::errc() || end != last || open + 2 == text.size()) return false;
  name = text.substr(0, open);
  return true;
}

std::vector<std::size_t> named(const std::vector<VdbGridInfo>& grids, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < grids.size(); ++i)
    if (grids[i].name == name) found.push_back(i);
  return found;
}

bool is_scalar(const VdbGridInfo& grid) {
  return grid.type == "float" || grid.type == "double";
}

// How to name grid `index`.
std::string example(const std::vector<VdbGridInfo>& grids, std::size_t index) {
  const std::string& name = grids[index].name;
  return !name.empty() && named(grids, name).size() == 1 ? '"' + name + '"' : fmt::format("[{}]", index);
}

} // namespace

std::string grid_list(const std::vector<VdbGridInfo>& grids) {
  std::string list;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VdbGridInfo& g = grids[i];
    const std::string item =
        fmt::format("{}{}{} [{}]", i ? ", " : "", g.name, g.name.empty() ? fmt::format("[{}]", i) : "",
                    is_scalar(g) && g.grid_class != "unknown" ? g.grid_class : g.type);
    if (list.size() + item.size() > 240) return list + fmt::format(", and {} more", grids.size() - i);
    list += item;
  }
  return list;
}

std::size_t select_grid(const std::vector<VdbGridInfo>& grids, const std::string& wanted,
                        const std::string& path) {
  if (grids.empty()) throw Error(ErrorKind::bad_input, path + ": holds no grids");
  const auto fail = [&](const std::string& reason) {
    throw Error(ErrorKind::bad_input, fmt::format("{}: {}; has: {}", path, reason, grid_list(grids)));
  };

  if (wanted.empty()) {
    std::vector<std::size_t> level_sets, possible;
    for (std::size_t i = 0; i < grids.size(); ++i) {
      if (!grids[i].note.empty()) continue;
      possible.push_back(i);
      if (grids[i].grid_class == "level set") level_sets.push_back(i);
    }
    if (level_sets.size() == 1) return level_sets[0];
    if (level_sets.empty() && possible.size() == 1) return possible[0];
    if (level_sets.size() > 1 || possible.size() > 1)
      fail("several grids could be meant; name one, such as " +
           example(grids, level_sets.empty() ? possible[0] : level_sets[0]));
    if (grids.size() == 1) return 0;      // whose note is the reason
    for (const VdbGridInfo& grid : grids) // one that nearly is
      if (is_scalar(grid)) fail(fmt::format("no level set: grid \"{}\" {}", grid.name, grid.note));
    fail("no level set");
  }

  std::vector<std::size_t> found = named(grids, wanted);
  if (found.size() == 1) return found[0];
  const std::string shown = printable(wanted, 60);
  if (found.size() > 1)
    fail(fmt::format("{0} grids are called \"{1}\"; choose {1}[0] to {1}[{2}]", found.size(), shown,
                     found.size() - 1));
  std::string name;
  std::size_t index = 0;
  if (split_index(wanted, name, index)) {
    if (name.empty() && index < grids.size()) return index;
    found = named(grids, name);
    if (index < found.size()) return found[index];
  }
  fail(fmt::format("no grid \"{}\"", shown));
  return 0;
}

} // namespace levelray
