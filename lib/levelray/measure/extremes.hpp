// The suite `extremes`: rays, cells, grids, shapes, meshes, machines and invariants at the edge of what there
// is, each a row with a verdict.
//
// A row is right (`green`), or the library turned it down as its documentation says (`refused`), or wrong
// (`red`), with the first counter-example, floating-point numbers in hexadecimal, so that it can be rerun.
// What is expected is computed by means of the row's own: answers of rays by ray_judge.hpp, distances and
// signs of meshes by sums over all triangles, symmetries by doing things twice. The rows of this folder are
// those of the numerics; adapters have their own (io/extreme_mesh_files.hpp, vdb/extreme_vdb_files.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace levelray {

struct ExtremeSettings {
  // The intersector that rows about rays trace with. All of them promise what `exact` does but for lost and
  // approximate surfaces, which the rows show then: that is how they are known to be able to fail.
  std::string intersector = "exact";
  std::uint64_t seed = 1; // of random rays
};

enum class ExtremeVerdict { green, refused, red };
const char* verdict_name(ExtremeVerdict verdict);

struct ExtremeOutcome {
  ExtremeVerdict verdict = ExtremeVerdict::green;
  std::uint64_t cases = 0; // tried
  double worst = 0;        // error, in `unit`s
  std::string unit;        // "" where there is no error to be measured
  std::string detail;      // of a refusal the error's line; of a red row the first counter-example
};

struct ExtremeRow {
  std::string group, name, expected; // the last a sentence
  std::function<ExtremeOutcome(const ExtremeSettings&)> run;
};

struct ExtremeResult {
  std::string group, name, expected;
  ExtremeOutcome outcome;
  double seconds = 0; // of processor time
};

// All rows of this folder, in the order of their groups: rays, cells, grids, shapes, meshes, system,
// invariants, oracle.
std::vector<ExtremeRow> extreme_rows();
// The rows of each group, from the files of that name.
std::vector<ExtremeRow> extreme_ray_rows();
std::vector<ExtremeRow> extreme_cell_rows();
std::vector<ExtremeRow> extreme_grid_rows();
std::vector<ExtremeRow> extreme_shape_rows();
std::vector<ExtremeRow> extreme_mesh_rows();
std::vector<ExtremeRow> extreme_system_rows();
std::vector<ExtremeRow> extreme_invariant_rows();
std::vector<ExtremeRow> extreme_oracle_rows();

// Runs a row; what it throws is its failure. Stops where parallel loops would (core/parallel.hpp).
ExtremeResult run_extreme(const ExtremeRow& row, const ExtremeSettings& settings = {});

// Counts cases, and keeps the worst error and the first counter-example.
class ExtremeTally {
 public:
  explicit ExtremeTally(std::string unit = "") : unit_(std::move(unit)) {}

  void add(std::uint64_t cases = 1) { cases_ += cases; }
  void error(double size) {
    if (!(size <= worst_)) worst_ = size; // NaN too
  }
  // Whether the case is right; `what` makes the counter-example's text and is called at most once.
  template <class What>
  bool check(bool right, What&& what) {
    if (!right && example_.empty()) example_ = what();
    return right;
  }
  bool failed() const { return !example_.empty(); }
  std::uint64_t cases() const { return cases_; }
  ExtremeOutcome outcome() const; // red also where there was no case at all

 private:
  std::string unit_, example_;
  std::uint64_t cases_ = 0;
  double worst_ = 0;
};

// Refused if work() throws an Error whose text contains `text`, else red.
ExtremeOutcome expect_refusal(const std::string& text, const std::function<void()>& work);

} // namespace levelray
