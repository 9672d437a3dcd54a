// Meshes of the suite `extremes`: whatever is wrong with them, the samples are right or the mesh is refused.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/mesh_judge.hpp"

#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <numbers>

namespace levelray {

namespace {

TriangleMesh box(const Vec3d& min, const Vec3d& max) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

// n by m quads; outward.
TriangleMesh torus(std::uint32_t n, std::uint32_t m, double big = 1, double small = 0.4) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
      const double r = big + small * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), small * std::sin(v));
      const std::uint32_t a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m,
                          d = i * m + (j + 1) % m;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

// n by m quads between poles; outward.
TriangleMesh ball(std::uint32_t n, std::uint32_t m, double radius) {
  TriangleMesh mesh;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return j == 0 ? 0 : j == m ? 1 : 2 + (j - 1) * n + i % n;
  };
  mesh.vertices.resize(2 + std::size_t{n} * (m - 1));
  mesh.vertices[0] = Vec3d(0, 0, radius), mesh.vertices[1] = Vec3d(0, 0, -radius);
  for (std::uint32_t j = 1; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const double u = 2 * std::numbers::pi * i / n, v = std::numbers::pi * j / m;
      mesh.vertices[at(i, j)] =
          Vec3d(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v)) * radius;
    }
  for (std::uint32_t j = 0; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      if (j > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (j + 1 < m) mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by, double scale = 1) {
  for (Vec3d& v : mesh.vertices) v = v * scale + by;
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, int every) { // every so many faces
  for (std::size_t i = 0; i < mesh.triangles.size(); i += static_cast<std::size_t>(every))
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return mesh;
}

// A strip that closes with a half turn.
TriangleMesh moebius(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1 + w * std::cos(u / 2);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
    }
    const std::uint32_t a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    mesh.triangles.push_back({a, c, d});
    mesh.triangles.push_back({a, d, b});
  }
  return mesh;
}

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

TriangleMesh with_five_holes() {
  TriangleMesh mesh = torus(20, 12);
  for (const std::size_t hole : {400u, 300u, 211u, 120u, 31u}) // from the back, single quads and triangles
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(hole),
                         mesh.triangles.begin() + static_cast<std::ptrdiff_t>(hole + 1 + hole % 2));
  return mesh;
}

// Triangles of no area along edges, in corners, and a needle of 1e-12 across a face.
TriangleMesh with_degenerates() {
  TriangleMesh mesh = torus(16, 8);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; i += 9) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[0], t[1]});
    mesh.triangles.push_back({t[2], t[2], t[2]});
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2);
    mesh.triangles.push_back({t[0], middle, t[1]});
  }
  return mesh;
}

// A box whose upper face has a fan around a point 1e-12 from its edge: closed, with slivers.
TriangleMesh with_slivers() {
  TriangleMesh mesh = box(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6));
  mesh.triangles.resize(10); // without the upper face 4 5 7 6
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.37, 1e-12, 0.6);
  for (const auto& [a, b] : {std::pair{4u, 5u}, {5u, 7u}, {7u, 6u}, {6u, 4u}})
    mesh.triangles.push_back({a, b, middle});
  return mesh;
}

// The upper face's quads meet the sides' edges in vertices that those do not have.
TriangleMesh with_t_junctions() {
  TriangleMesh mesh = box(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6));
  mesh.triangles.resize(10);
  mesh.vertices.emplace_back(0.5, 0, 0.6);   // 8
  mesh.vertices.emplace_back(0.5, 0.8, 0.6); // 9
  for (const Triangle& t : {Triangle{4, 8, 9}, {4, 9, 6}, {8, 5, 7}, {8, 7, 9}}) mesh.triangles.push_back(t);
  return mesh;
}

TriangleMesh boxes_with_a_common_edge() {
  TriangleMesh mesh = box(Vec3d(0, 0, 0), Vec3d(1, 1, 1));
  const TriangleMesh other = box(Vec3d(1, 1, 0), Vec3d(1.7, 1.7, 1)); // on the vertical edge at (1, 1)
  return joined(mesh, other);                                         // whose vertices weld
}

ExtremeOutcome ten_million(const ExtremeSettings&) {
  // 2237 * 2 * 2235 triangles. The facets lie within r (1 - cos(pi / 2237)) of the ball, twice that at a
  // quad's diagonal, so that distances to it are those to the triangles to 2e-6.
  ExtremeTally tally("voxel");
  const TriangleMesh mesh = ball(2237, 2236, 1);
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
                   {"torus, every fifth face turned", turned(torus(16, 8), 5), torus(16, 8)}};
             }),
      judged("inverted", "All faces turned round: the solid that was meant.",
             [] {
               return std::vector<Case>{{"torus inside out", turned(torus(16, 8), 1), torus(16, 8)}};
             }),
      judged("duplicates", "Faces that are there twice, or three times.",
             [] {
               TriangleMesh mesh = torus(16, 8);
               for (std::size_t i = 0; i < 120; i += 7) mesh.triangles.push_back(mesh.triangles[i]);
               for (std::size_t i = 0; i < 50; i += 21) mesh.triangles.push_back(mesh.triangles[i]);
               return std::vector<Case>{{"torus, some faces repeated", mesh, torus(16, 8)}};
             }),
      judged("degenerates", "Triangles that are points and segments.",
             [] {
               return std::vector<Case>{{"torus with faces without area", with_degenerates(), torus(16, 8)}};
             }),
      judged("slivers", "Triangles 1e-12 high.",
             [] {
               return std::vector<Case>{{"box with slivers", with_slivers(), {}}};
             }),
      judged("self-intersections", "Solids through each other: their union.",
             [] {
               return std::vector<Case>{
                   {"two boxes",
                    joined(box(Vec3d(0, 0, 0), Vec3d(1, 1, 1)),
                           box(Vec3d(0.4, 0.3, 0.55), Vec3d(1.5, 0.8, 1.4))),
                    {}},
                   {"box and torus",
                    joined(torus(16, 8), box(Vec3d(0.5, -0.5, -0.2), Vec3d(1.6, 0.6, 0.7))),
                    {}}};
             }),
      judged("t-junctions", "Edges that meet others' middles: closed to the eye, open by its edges.",
             [] {
               return std::vector<Case>{
                   {"box with T-junctions", with_t_junctions(), box(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6))}};
             }),
      judged("non-manifold", "Two boxes that share an edge.",
             [] {
               return std::vector<Case>{{"boxes with a common edge", boxes_with_a_common_edge(), {}}};
             }),
      judged("nested-shells", "A hollow ball, whose cavity's shell looks inward.",
             [] {
               return std::vector<Case>{
                   {"hollow ball", joined(ball(14, 8, 1), turned(ball(12, 6, 0.6), 1)), {}}};
             }),
      judged("gap-1e-6", "Two boxes 1e-6 apart, and one cracked by 1e-6 all round.",
             [] {
               const TriangleMesh apart = joined(box(Vec3d(0, 0, 0), Vec3d(0.5, 0.7, 0.6)),
                                                 box(Vec3d(0.5 + 1e-6, 0, 0), Vec3d(1, 0.7, 0.6)));
               TriangleMesh lid = box(Vec3d(0, 0, 0), Vec3d(1, 0.7, 0.6)), cracked = lid;
               cracked.triangles.resize(10);
               lid.triangles.erase(lid.triangles.begin(), lid.triangles.begin() + 10);
               return std::vector<Case>{{"boxes 1e-6 apart", apart, {}},
                                        {"box whose lid hovers 1e-6 above it",
                                         joined(cracked, moved(lid, Vec3d(0, 0, 1e-6))),
                                         {}}};
             }),
      judged("coordinates-1e7", "Coordinates of 1e7, at voxels of about 0.2 and 2e-4.",
             [] {
               const Vec3d utm(1e7 / 2 + 0.37, 1e7 - 0.11, 812.3);
               return std::vector<Case>{{"torus at 1e7", moved(torus(16, 8), utm), {}},
                                        {"torus of 3e-3 at 1e7", moved(torus(16, 8), utm, 1e-3), {}}};
             }),
      judged("sizes-1e-20-and-1e20", "Meshes of 1e-20 and 1e20.",
             [] {
               return std::vector<Case>{{"torus of 1e-20", moved(torus(16, 8), Vec3d(0, 0, 0), 1e-20), {}},
                                        {"torus of 1e20", moved(torus(16, 8), Vec3d(0, 0, 0), 1e20), {}}};
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
            [] { return moebius(24); }),
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
              [] { return moved(torus(8, 6), Vec3d(0, 0, 0), 1e60); }),
      refused("voxel-2^-110", "Voxels that single precision cannot hold are refused.",
              "distances are single precision numbers",
              [] { return moved(torus(8, 6), Vec3d(0, 0, 0), 0x1p-110); }),
  };
}

} // namespace levelray
