// Preparing soups that nobody would draw: few vertices, many triangles, so that edges with many faces,
// repeated and opposite faces, pinched vertices and one-sided patches all come up.
#include "levelray/core/error.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/mesh/weld.hpp"
#include "levelray/mesh/winding_number.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>

using namespace levelray;

namespace {

using Chain =
    std::map<std::pair<std::uint32_t, std::uint32_t>, int>; // (low, high) to times up minus times down

void add_edge(Chain& chain, std::uint32_t from, std::uint32_t to) {
  chain[std::minmax(from, to)] += from < to ? 1 : -1;
}

Chain boundary_of(const std::vector<Triangle>& triangles) {
  Chain chain;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) add_edge(chain, t[k], t[(k + 1) % 3]);
  return chain;
}

int length_of(const Chain& chain) {
  int sum = 0;
  for (const auto& entry : chain) sum += std::abs(entry.second);
  return sum;
}

TriangleMesh random_soup(std::mt19937_64& random, std::uint32_t vertices, std::size_t triangles) {
  TriangleMesh mesh;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::uint32_t v = 0; v < vertices; ++v)
    mesh.vertices.emplace_back(uniform(random), uniform(random), uniform(random));
  if (vertices > 5) mesh.vertices.back() = mesh.vertices.front();
  std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
  for (std::size_t t = 0; t < triangles; ++t)
    mesh.triangles.push_back({any(random), any(random), any(random)});
  return mesh;
}

// A triangle's corners from the lowest on, in its orientation.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

} // namespace

TEST_CASE("random soups keep their faces and their chain gets no longer") {
  const std::uint64_t seed = 50;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  int shortened = 0, dropped = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const TriangleMesh mesh =
        random_soup(random, 4 + static_cast<std::uint32_t>(i) % 9, 1 + static_cast<std::size_t>(i) % 40);
    CAPTURE(i);
    PreparedMesh prepared, trusted;
    try {
      prepared = prepare_mesh(mesh);
      trusted = prepare_mesh(mesh, {true});
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::bad_input);
      ++refused;
      continue;
    }
    const WeldedMesh welded = weld(mesh);
    const Chain before = boundary_of(welded.mesh.triangles), after = boundary_of(prepared.mesh.triangles);

    // The open edges cancel the boundary, edge by edge.
    Chain closed = after;
    for (const auto& e : prepared.open_edges) add_edge(closed, e[0], e[1]);
    CHECK(length_of(closed) == 0);
    CHECK(static_cast<int>(prepared.open_edges.size()) == length_of(after));

    // A closed mesh stays closed, unless it is double-sided; and without repeated faces no chain gets longer.
    const bool repeats = prepared.report.duplicate_triangles + prepared.report.opposite_triangles > 0;
    const bool double_sided =
        std::any_of(prepared.warnings.begin(), prepared.warnings.end(), [](const std::string& w) {
          return w.find("doubled in both orientations") != std::string::npos;
        });
    if ((length_of(before) == 0 && !double_sided) || !repeats) CHECK(length_of(after) <= length_of(before));
    shortened += length_of(after) < length_of(before);

    // Faces only turn, or go when another over the same vertices stays; and none turns when trusted.
    std::map<Triangle, int> given, kept, given_oriented;
    for (const Triangle& t : welded.mesh.triangles) ++given[sorted(t)], ++given_oriented[canonical(t)];
    for (const Triangle& t : prepared.mesh.triangles) ++kept[sorted(t)];
    CHECK(given.size() == kept.size());
    for (const auto& [t, count] : kept) CHECK(count <= given[t]);
    for (const Triangle& t : trusted.mesh.triangles) CHECK(given_oriented[canonical(t)] > 0);
    CHECK(trusted.report.flipped_triangles == 0);
    dropped += prepared.mesh.triangles.size() < welded.mesh.triangles.size();

    // Capped, it winds whole numbers of times around a point (40 triangles and caps of 120: 1e-12 is twenty
    // times their rounding of ten ulp of 2 pi each, over 4 pi).
    TriangleMesh capped = prepared.mesh;
    const auto apex = static_cast<std::uint32_t>(capped.vertices.size());
    capped.vertices.emplace_back(0.41, 0.52, 1.7);
    for (const auto& e : prepared.open_edges) capped.triangles.push_back({e[0], e[1], apex});
    const double w = winding_number(capped, Vec3d(0.47, 0.53, 0.49));
    CHECK(std::abs(w - std::round(w)) < 1e-12);
  }
  CHECK(shortened > 1000);
  CHECK(dropped > 300);
  CHECK(refused < 500);
}
