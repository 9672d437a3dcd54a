// Meshes of the suite `extremes`: whatever is wrong with them, the samples are right or the mesh is refused.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/measure/mesh_judge.hpp"

#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <numbers>

namespace levelray {

namespace {

struct Case {
  std::string name;
  TriangleMesh mesh;
  // Whose winding number decides what is inside; empty: the mesh's own.
  TriangleMesh meant;
};

// Compares every sample of the grid's box with the triangles: magnitudes within the band to the 1e-5 voxel of
// convert/README.md, a float's rounding and that of coordinates; sides by the winding number, above one half
// being inside, unless it is one half to 1e-6 or the sample on the surface to rounding.
void judge(const Case& what, const BlockGrid& grid, double thickness, ExtremeTally& tally) {
  const TriangleMesh& meant = what.meant.triangles.empty() ? what.mesh : what.meant;
  const Box3d bounds = what.mesh.bounds();
  const double h = grid.transform.voxel_size, background = double{grid.background};
  Vec3i low, size;
  double coordinates = 0;
  for (int a = 0; a < 3; ++a) {
    const double margin = background + thickness / 2 + 2 * h;
    low[a] = static_cast<int>(std::floor((bounds.min[a] - margin - grid.transform.origin[a]) / h));
    size[a] =
        static_cast<int>(std::ceil((bounds.max[a] + margin - grid.transform.origin[a]) / h)) - low[a] + 1;
    coordinates = std::max({coordinates, std::fabs(bounds.min[a]), std::fabs(bounds.max[a])});
  }
  std::mutex mutex;
  const auto count =
      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const int at = static_cast<int>(n);
      const Vec3i i = low + Vec3i(at % size.x, at / size.x % size.y, at / size.x / size.y);
      const Vec3d p = grid.transform.to_world(Vec3d(i));
      const Extended d = mesh_distance(what.mesh, p);
      const double value = double{grid.value(i.x, i.y, i.z)};
      const Extended field = thickness > 0 ? d - thickness / 2 : d;
      const double expected = static_cast<double>(std::min<Extended>(std::fabs(field), background));
      const double error = std::fabs(std::fabs(value) - expected);
      const double rounding = 0x1p-50 * coordinates;
      bool right_side = static_cast<double>(std::fabs(field)) <= rounding + 1e-5 * h;
      if (!right_side) {
        const Extended winding = thickness > 0 ? (field < 0 ? 1 : 0) : mesh_winding(meant, p);
        right_side = std::fabs(winding - 0.5L) < 1e-6L || (value < 0) == (winding > 0.5L);
      }
      const std::lock_guard lock(mutex);
      tally.add();
      tally.error(error / h);
      tally.check(error <= 1e-5 * h + 0x1p-23 * expected + rounding && right_side, [&] {
        return fmt::format("{}: sample ({}, {}, {}) is {:a}; its distance is {:a}, its side {}", what.name,
                           i.x, i.y, i.z, value, expected, right_side ? "right" : "wrong");
      });
    }
  });
}

ExtremeRow judged(const char* name, const char* expected, std::function<std::vector<Case>()> cases) {
  return {"meshes", name, expected, [=](const ExtremeSettings&) {
            ExtremeTally tally("voxel");
            for (const Case& each : cases()) {
              ConvertOptions options;
              options.resolution = 15;
              judge(each, mesh_to_grid(prepare_mesh(each.mesh), options).grid, 0, tally);
            }
            return tally.outcome();
          }};
}

// Right as a sheet; as a solid refused where no sample has a winding number above 1/2, else right, too: bent
// sheets have some on their hollow side. Of what cannot be oriented the winding number is the repaired
// mesh's.
ExtremeRow sheet(const char* name, const char* expected, std::function<TriangleMesh()> mesh) {
  return {"meshes", name, expected, [=](const ExtremeSettings&) {
            ExtremeTally tally("voxel");
            ConvertOptions options;
            options.resolution = 20;
            std::string refusal;
            const PreparedMesh solid = prepare_mesh(mesh());
            try {
              judge({"open solid", mesh(), solid.mesh}, mesh_to_grid(solid, options).grid, 0, tally);
            } catch (const Error& error) {
              refusal = error.what();
              const bool expected_words = refusal.find("no enclosed volume") != std::string::npos;
              tally.check(expected_words, [&] { return refusal; });
            }
            PrepareOptions as_sheet;
            as_sheet.sheet = true;
            const PreparedMesh prepared = prepare_mesh(mesh(), as_sheet);
            options.thicken = 1.5 * plan_conversion(prepared, options).voxel_size;
            judge({"sheet", mesh(), {}}, mesh_to_grid(prepared, options).grid, 2 * options.thicken, tally);
            ExtremeOutcome outcome = tally.outcome();
            if (outcome.verdict == ExtremeVerdict::green && !refusal.empty()) {
              outcome.verdict = ExtremeVerdict::refused;
              outcome.detail = refusal;
            }
            return outcome;
          }};
}

ExtremeOutcome ten_million(const ExtremeSettings&) {
  // 2237 * 2 * 2235 triangles. The facets lie within r (1 - cos(pi / 2237)) of the ball, twice that at a
  // quad's diagonal, so that distances to it are those to the triangles to 2e-6.
  ExtremeTally tally("voxel");
  const TriangleMesh mesh = ball_mesh(2237, 2236, 1);
  tally.check(mesh.triangles.size() >= 9'999'000,
              [&] { return fmt::format("only {} triangles", mesh.triangles.size()); });
  const PreparedMesh prepared = prepare_mesh(mesh);
  tally.check(prepared.report.closed && prepared.report.shells == 1,
              [] { return std::string("is said to be open"); });
  ConvertOptions options;
  options.resolution = 48;
  const BlockGrid grid = mesh_to_grid(prepared, options).grid;
  const double h = grid.transform.voxel_size, facets = 2 * (1 - std::cos(std::numbers::pi / 2236));
  for (int k = -30; k <= 30; ++k)
    for (int j = -30; j <= 30; ++j)
      for (int i = -30; i <= 30; ++i) {
        const double d = grid.transform.to_world(Vec3d(i, j, k)).length() - 1,
                     background = double{grid.background};
        const double error = std::fabs(double{grid.value(i, j, k)} - std::clamp(d, -background, background));
        tally.add();
        tally.error(error / h);
        tally.check(error <= facets + 1e-5 * h + 0x1p-23 * background, [&] {
          return fmt::format("sample ({}, {}, {}) of the ball's grid is {:a}", i, j, k, grid.value(i, j, k));
        });
      }
  return tally.outcome();
}

ExtremeRow refused(const char* name, const char* expected, const char* text,
                   std::function<TriangleMesh()> mesh, double voxel_size = 0) {
  return {"meshes", name, expected, [=](const ExtremeSettings&) {
            return expect_refusal(text, [&] {
              ConvertOptions options;
              options.resolution = 15, options.voxel_size = voxel_size;
              mesh_to_grid(prepare_mesh(mesh()), options);
            });
          }};
}

} // namespace

std::vector<ExtremeRow> extreme_mesh_rows() {
  return {
      judged(
          "holes",
          "Five holes, as the original Stanford bunny has: inside is where the winding number exceeds 1/2.",
          [] {
            return std::vector<Case>{{"torus with five holes", with_five_holes(), {}}};
          }),
      judged("flipped-faces", "Some faces turned round: the solid that was meant.",
             [] {
               return std::vector<Case>{
                   {"torus, every fifth face turned", turned_faces(torus_mesh(16, 8), 5), torus_mesh(16, 8)}};
             }),
      judged("inverted", "All faces turned round: the solid that was meant.",
             [] {
               return std::vector<Case>{
                   {"torus inside out", turned_faces(torus_mesh(16, 8), 1), torus_mesh(16, 8)}};
             }),
      judged("duplicates", "Faces that are there twice, or three times.",
             [] {
               TriangleMesh mesh = torus_mesh(16, 8);
               for (std::size_t i = 0; i < 120; i += 7) mesh.triangles.push_back(mesh.triangles[i]);
               for (std::size_t i = 0; i < 50; i += 21) mesh.triangles.push_back(mesh.triangles[i]);
               return std::vector<Case>{{"torus, some faces repeated", mesh, torus_mesh(16, 8)}};
             }),
      judged("degenerates", "Triangles that are points and segments.",
             [] {
               return std::vector<Case>{
                   {"torus with faces without area", with_degenerates(), torus_mesh(16, 8)}};
             }),
      judged("slivers", "Triangles 1e-12 high.",
             [] {
               return std::vector<Case>{{"box with slivers", with_slivers(), {}}};
             }),
      judged("self-intersections", "Solids through each other: their union.",
             [] {
               return std::vector<Case>{
                   {"two boxes",
                    joined_meshes(box_mesh(Vec3d(0, 0, 0), Vec3d(1, 1, 1)),
                                  box_mesh(Vec3d(0.4, 0.3, 0.55), Vec3d(1.5, 0.8, 1.4))),
                    {}},
                   {"box and torus",
                    joined_meshes(torus_mesh(16, 8), box_mesh(Vec3d(0.5, -0.5, -0.2), Vec3d(1.6, 0.6, 0.7))),
                    {}}};
             }),
      judged("t-junctions", "Edges that meet others' middles: closed to the eye, open by its edges.",
             [] {
               return std::vector<Case>{{"box with T-junctions", with_t_junctions(),
                                         box_mesh(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6))}};
             }),
      judged("non-manifold", "Two boxes that share an edge.",
             [] {
               return std::vector<Case>{{"boxes with a common edge", boxes_with_a_common_edge(), {}}};
             }),
      judged("nested-shells", "A hollow ball, whose cavity's shell looks inward.",
             [] {
               return std::vector<Case>{
                   {"hollow ball",
                    joined_meshes(ball_mesh(14, 8, 1), turned_faces(ball_mesh(12, 6, 0.6), 1)),
                    {}}};
             }),
      judged("gap-1e-6", "Two boxes 1e-6 apart, and one cracked by 1e-6 all round.",
             [] {
               const TriangleMesh apart =
                   joined_meshes(box_mesh(Vec3d(0, 0, 0), Vec3d(0.5, 0.7, 0.6)),
                                 box_mesh(Vec3d(0.5 + 1e-6, 0, 0), Vec3d(1, 0.7, 0.6)));
               TriangleMesh lid = box_mesh(Vec3d(0, 0, 0), Vec3d(1, 0.7, 0.6)), cracked = lid;
               cracked.triangles.resize(10);
               lid.triangles.erase(lid.triangles.begin(), lid.triangles.begin() + 10);
               return std::vector<Case>{{"boxes 1e-6 apart", apart, {}},
                                        {"box whose lid hovers 1e-6 above it",
                                         joined_meshes(cracked, moved_mesh(lid, Vec3d(0, 0, 1e-6))),
                                         {}}};
             }),
      judged("coordinates-1e7", "Coordinates of 1e7, at voxels of about 0.2 and 2e-4.",
             [] {
               const Vec3d utm(1e7 / 2 + 0.37, 1e7 - 0.11, 812.3);
               return std::vector<Case>{
                   {"torus at 1e7", moved_mesh(torus_mesh(16, 8), utm), {}},
                   {"torus of 3e-3 at 1e7", moved_mesh(torus_mesh(16, 8), utm, 1e-3), {}}};
             }),
      judged("sizes-1e-20-and-1e20", "Meshes of 1e-20 and 1e20.",
             [] {
               return std::vector<Case>{
                   {"torus of 1e-20", moved_mesh(torus_mesh(16, 8), Vec3d(0, 0, 0), 1e-20), {}},
                   {"torus of 1e20", moved_mesh(torus_mesh(16, 8), Vec3d(0, 0, 0), 1e20), {}}};
             }),
      {"meshes", "ten-million", "A ball of 10 million triangles, within its facets' height of the ball.",
       ten_million},
      sheet("open-sheet", "A flat sheet encloses nothing: refused as a solid, right with --thicken.",
            [] {
              return TriangleMesh{{{0, 0, 0}, {1, 0, 0.2}, {1.1, 0.8, 0.5}, {0.1, 0.8, 0.3}},
                                  {{0, 1, 2}, {0, 2, 3}}};
            }),
      sheet("bent-sheet",
            "A bent sheet: inside where its winding number exceeds 1/2, and right with --thicken.",
            [] {
              return TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {1, 0.8, 0}, {0, 0.8, 0.4}}, {{0, 1, 2}, {0, 2, 3}}};
            }),
      sheet("moebius",
            "A Moebius strip, which cannot be oriented: no promise as a solid but its repair's winding "
            "number, right with --thicken.",
            [] { return moebius_mesh(24); }),
      sheet("single-triangle", "One triangle: refused as a solid, right with --thicken.",
            [] {
              return TriangleMesh{{{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.4}}, {{0, 1, 2}}};
            }),
      refused("empty", "A mesh without triangles is refused.", "no triangles: the mesh is empty",
              [] { return TriangleMesh{}; }),
      refused("no-area", "A mesh whose triangles have no area is refused.", "no triangles with an area",
              [] {
                return TriangleMesh{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}};
              }),
      refused("size-1e60", "Sizes beyond 1e50 are refused.", "must be from 1e-50 to 1e50",
              [] { return moved_mesh(torus_mesh(8, 6), Vec3d(0, 0, 0), 1e60); }),
      refused("voxel-2^-110", "Voxels that single precision cannot hold are refused.",
              "distances are single precision numbers",
              [] { return moved_mesh(torus_mesh(8, 6), Vec3d(0, 0, 0), 0x1p-110); }),
  };
}

} // namespace levelray
