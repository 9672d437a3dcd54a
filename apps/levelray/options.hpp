// Groups of options that several subcommands share.
#pragma once

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include "lengths.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace levelray {

using Json = nlohmann::ordered_json; // keys in the order they are documented

// Of every subcommand.
struct CommonOptions {
  int threads = 0; // 0: all
  bool quiet = false;
  std::string json;           // a path, "-" for standard output, or empty
  bool keep_warnings = false; // no option: the caller tells the warnings of what it loads
  static CommonOptions silent();

  void add_to(CLI::App& command);
  // Results for people go to standard output, unless JSON does or nothing shall.
  bool talks() const { return !quiet && json != "-"; }
};

// How a mesh or a .vdb is read.
struct InputOptions {
  std::string path, format, units, grid, max_memory;
  double read_timeout = 60; // seconds, for a .vdb
  bool drop_bad = false, salvage = false, trust_orientation = false, strict = false, trust_input = false;

  void add_to(CLI::App& command);
  MeshReadOptions mesh_options() const;
  VdbReadOptions vdb_options() const; // how to read it as it is
  Json json() const;                  // as given
  Json lasting_json() const;          // of it, what may decide what is read: neither the path nor limits
  // The same for one file of many, of which no more than this is left: bytes of memory, seconds.
  InputOptions of_frame(const std::string& frame_path, std::uint64_t memory, double seconds) const;
  // In bytes: as given (0: no limit, a number beyond all machines), or four fifths of the machine's memory.
  std::uint64_t memory_limit() const;
};

// How a mesh, or a .vdb whose values are no distances, becomes a grid.
struct ConversionOptions {
  std::string voxel, band = "3vx", sign = "auto", thicken, redistance = "auto", iso;
  int resolution = 256;

  void add_to(CLI::App& command);
  // Whether anything differs from the defaults that is for meshes only.
  bool given_for_meshes() const {
    return !voxel.empty() || sign != "auto" || resolution != 256 || !thicken.empty();
  }
  // How to read a .vdb: with --redistance and, in voxels, the --band that this makes. Throws Error(usage).
  VdbReadOptions vdb_options(const InputOptions& input) const;
  // Checks what can be checked without the mesh: throws Error(usage).
  void check() const;
  Json json() const;       // as given: everything that the grid depends on besides the input
  float iso_value() const; // of --iso, when it is given. Throws Error(usage)
  // In the units of a mesh with these bounds.
  ConvertOptions resolve(const Box3d& bounds, const InputOptions& input) const;
};

// Throws Error(usage) for an output that cannot be meant: its folder is missing, it is the input, or another
// output of the same run, or its extension is none of `extensions` (".exr"; empty: any). Throws
// Error(cannot_write) when it cannot be created.
void check_output(const std::string& path, const std::string& input,
                  const std::vector<std::string>& extensions, std::vector<std::string>& outputs_so_far);

// The extension in lower case, with its dot.
std::string extension_of(const std::string& path);

} // namespace levelray
