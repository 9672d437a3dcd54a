#include "paper_models.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "options.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <tuple>

namespace levelray {

namespace {

struct KnownModel {
  const char* name;
  std::vector<std::string> stems; // best first
  const char* source;
};

const std::vector<KnownModel>& known_models() {
  static const std::vector<KnownModel> models{
      {"bunny",
       {"stanford bunny closed", "bunny closed", "bun zipper", "stanford bunny", "bunny", "bunny00"},
       "graphics.stanford.edu/data/3Dscanrep, bunny/reconstruction/bun_zipper.ply"},
      {"dragon",
       {"stanford dragon closed", "dragon closed", "dragon vrip", "stanford dragon", "dragon"},
       "graphics.stanford.edu/data/3Dscanrep, dragon_recon/dragon_vrip.ply"},
      {"buddha",
       {"happy buddha closed", "buddha closed", "happy vrip", "happy buddha", "happybuddha",
        "stanford buddha", "buddha"},
       "graphics.stanford.edu/data/3Dscanrep, happy_recon/happy_vrip.ply"}};
  return models;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    const char low = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if ((low >= 'a' && low <= 'z') || (low >= '0' && low <= '9'))
      words.back() += low;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// Whether the name begins with the stem's words, of which "closed" may stand anywhere later: "dragon 80k
// closed".
bool fits(const std::vector<std::string>& name, std::vector<std::string> stem) {
  const bool closed = stem.back() == "closed";
  if (closed) stem.pop_back();
  if (name.size() < stem.size() || !std::equal(stem.begin(), stem.end(), name.begin())) return false;
  return !closed || std::find(name.begin(), name.end(), "closed") != name.end();
}

} // namespace

int model_rank(const std::string& model, const std::string& file_name) {
  const std::string extension = extension_of(file_name);
  const std::vector<std::string>& formats = mesh_format_names();
  if (extension.empty() || std::find(formats.begin(), formats.end(), extension.substr(1)) == formats.end())
    return -1;
  const std::vector<std::string> words = words_of(std::filesystem::path(file_name).stem().string());
  for (const KnownModel& known : known_models())
    for (std::size_t i = 0; known.name == model && i < known.stems.size(); ++i)
      if (fits(words, words_of(known.stems[i]))) return static_cast<int>(i);
  return -1;
}

std::vector<PaperModel> find_paper_models(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw Error(ErrorKind::bad_input, "--models " + printable(folder, 300) + ": no such folder");
  constexpr int deepest = 4;
  std::vector<PaperModel> models;
  std::vector<std::tuple<int, std::size_t, std::string>> best; // rank, length, path
  for (const KnownModel& known : known_models()) {
    models.push_back({known.name, "", known.source});
    best.emplace_back(std::numeric_limits<int>::max(), 0, "");
  }
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, failure), end;
  for (; !failure && at != end; at.increment(failure)) {
    check_cancel();
    std::error_code unknown;
    if (at->is_directory(unknown)) {
      if (at.depth() >= deepest) at.disable_recursion_pending();
      continue;
    }
    if (!at->is_regular_file(unknown)) continue;
    const std::string name = at->path().filename().string();
    for (std::size_t i = 0; i < models.size(); ++i) {
      const int rank = model_rank(models[i].name, name);
      if (rank >= 0) best[i] = std::min(best[i], std::make_tuple(rank, name.size(), at->path().string()));
    }
  }
  for (std::size_t i = 0; i < models.size(); ++i) models[i].path = std::get<2>(best[i]);
  return models;
}

} // namespace levelray
