// The models of Jamriska 2010, found in a folder by the names under which they are passed around.
#pragma once

#include <string>
#include <vector>

namespace levelray {

struct PaperModel {
  std::string name;   // "bunny", "dragon" or "buddha", as in measure/printed_tables.hpp
  std::string path;   // empty: not found
  std::string source; // where one gets it
};

// How well a file's name fits a model, 0 best; -1: it does not. Case and the signs between words do not
// matter, and more words may follow: "stanford-bunny-closed.obj", "Dragon_vrip_res2.ply". Closed versions
// come first, because what is inside needs no guess then, next the names of the Stanford 3D Scanning
// Repository, and last plain ones.
int model_rank(const std::string& model, const std::string& file_name);

// The best-fitting mesh file for each model in the folder and below it, the repository's folders being three
// deep. Of equals the shortest name, then the first path. Throws Error(bad_input) where there is no such
// folder.
std::vector<PaperModel> find_paper_models(const std::string& folder);

} // namespace levelray
