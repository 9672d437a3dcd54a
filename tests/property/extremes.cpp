// The rows of `levelray measure --suite extremes`: every one green or a documented refusal. Here they run
// under sanitizers, too.
#include "levelray/measure/extremes.hpp"
#include "levelray/io/extreme_mesh_files.hpp"
#include "levelray/vdb/extreme_vdb_files.hpp"
#include "support/catch.hpp"

using namespace levelray;

namespace {

void run(const std::vector<ExtremeRow>& rows) {
  for (const ExtremeRow& row : rows) {
    const ExtremeResult result = run_extreme(row);
    INFO(result.group << ": " << result.name << ": " << result.outcome.detail);
    CHECK(result.outcome.verdict != ExtremeVerdict::red);
    CHECK(result.outcome.cases > 0);
    if (result.outcome.verdict == ExtremeVerdict::refused) CHECK_FALSE(result.outcome.detail.empty());
  }
}

} // namespace

TEST_CASE("every extreme is right or a documented refusal") {
  SECTION("rays") {
    run(extreme_ray_rows());
  }
  SECTION("cells") {
    run(extreme_cell_rows());
  }
  SECTION("grids") {
    run(extreme_grid_rows());
  }
  SECTION("shapes") {
    run(extreme_shape_rows());
  }
  SECTION("meshes") {
    run(extreme_mesh_rows());
  }
  SECTION("system") {
    run(extreme_system_rows());
  }
  SECTION("invariants") {
    run(extreme_invariant_rows());
  }
  SECTION("oracle") {
    run(extreme_oracle_rows());
  }
}

// A judge that cannot say no is worth nothing: intersectors that lose surfaces, or are approximate, are found
// out, most rows about rays being red for them.
TEST_CASE("extremes tell intersectors apart that promise less than exact") {
  for (const char* intersector : {"midpoint", "false-position-1", "newton"}) {
    ExtremeSettings settings;
    settings.intersector = intersector;
    int red = 0;
    for (const ExtremeRow& row : extreme_ray_rows())
      red += run_extreme(row, settings).outcome.verdict == ExtremeVerdict::red;
    CAPTURE(intersector, red);
    CHECK(red >= 6);
  }
}
