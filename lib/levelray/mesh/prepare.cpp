#include "levelray/mesh/prepare.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/mesh/duplicates.hpp"
#include "levelray/mesh/orientation.hpp"
#include "levelray/mesh/shells.hpp"
#include "levelray/mesh/topology.hpp"
#include "levelray/mesh/weld.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>

namespace levelray {

namespace {

// Removes the triangles whose ascending numbers are given.
void drop(std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& numbers) {
  std::size_t kept = 0, next = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (next < numbers.size() && numbers[next] == t)
      ++next;
    else
      triangles[kept++] = triangles[t];
  triangles.resize(kept);
}

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

// Makes the mesh consistent and turns shells outward; fills in the report's orientation and volume.
void orient(PreparedMesh& out, EdgeTable& edges, bool trust) {
  TriangleMesh& mesh = out.mesh;
  const auto [shell_of, shell_count] = find_shells(mesh.triangles.size(), edges);

  Consistency consistency = make_consistent(mesh, edges);
  std::vector<bool> repaired(shell_count, false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (consistency.flip[t]) {
      turn(mesh.triangles[t]);
      repaired[shell_of[t]] = true;
    }
  // Turning a triangle moves its half-edges among its numbers 3t..3t+2, so the groups have to be made anew.
  if (consistency.flips > 0) edges = build_edge_table(mesh.triangles, mesh.vertices.size());

  const std::vector<Shell> shells = measure_shells(mesh, edges, shell_of, shell_count, repaired);
  bool any_turned = false, any_kept = false;
  for (const Shell& s : shells) (s.turn ? any_turned : any_kept) |= s.sign != 0;
  out.report.orientation = !consistency.orientable                             ? Orientation::non_orientable
                           : consistency.flips > 0 || (any_turned && any_kept) ? Orientation::mixed
                           : any_turned                                        ? Orientation::inverted
                           : any_kept                                          ? Orientation::outward
                                                                               : Orientation::undefined;
  if (trust) { // put back what was turned, and measure that
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (consistency.flip[t]) turn(mesh.triangles[t]);
    if (consistency.flips > 0) edges = build_edge_table(mesh.triangles, mesh.vertices.size());
    for (const Shell& s :
         consistency.flips > 0 ? measure_shells(mesh, edges, shell_of, shell_count, repaired) : shells)
      out.report.volume += s.volume;
    return;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool turned = shells[shell_of[t]].turn;
    if (turned) turn(mesh.triangles[t]);
    out.report.flipped_triangles += turned != (consistency.flip[t] != 0);
  }
  if (any_turned) edges = build_edge_table(mesh.triangles, mesh.vertices.size());
  for (const Shell& s : shells) out.report.volume += s.turn ? -s.volume : s.volume;
}

// The boundary chain, and the largest of its connected parts.
void find_open_edges(PreparedMesh& out, const EdgeTable& edges) {
  for (const OpenEdge& open : find_boundary_chain(out.mesh.triangles, edges)) {
    const std::uint32_t h = edges.of(open.edge)[0];
    const auto [low, high] =
        std::minmax({edge_start(out.mesh.triangles, h), edge_end(out.mesh.triangles, h)});
    for (int i = 0; i < std::abs(open.excess); ++i)
      out.open_edges.push_back(open.excess > 0 ? std::array{high, low} : std::array{low, high});
  }
  out.report.longest_hole = largest_part(out.mesh, out.open_edges);
}

// "1 hole", "2 holes".
std::string counted(std::uint64_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

void warn(PreparedMesh& out, const Duplicates& duplicates, const PrepareOptions& options) {
  const MeshReport& r = out.report;
  const auto add = [&](std::string text) { out.warnings.push_back(std::move(text)); };
  const auto faces = [](std::uint64_t n) { return counted(n, "face", "faces"); };
  const auto edges = [](std::uint64_t n) { return counted(n, "edge", "edges"); };
  if (!out.open_edges.empty() && !options.sheet) {
    std::string text = "the mesh is not closed: ";
    if (r.boundary_edges > 0)
      text += counted(r.boundary_edges, "boundary edge", "boundary edges") + " in " +
              counted(r.boundary_loops, "hole", "holes") + ", ";
    if (out.open_edges.size() != r.boundary_edges)
      text += edges(out.open_edges.size()) + " without a counterpart, ";
    add(text + fmt::format("the largest hole is {:.4g} wide; inside and outside are a judgement there",
                           r.longest_hole));
  }
  if (r.non_manifold_edges > 0 || r.non_manifold_vertices > 0) {
    std::string text;
    if (r.non_manifold_edges > 0) text = edges(r.non_manifold_edges) + " with more than two faces";
    if (r.non_manifold_vertices > 0)
      text += (text.empty() ? "" : ", ") + counted(r.non_manifold_vertices, "vertex", "vertices") +
              " where fans of faces touch";
    add(text);
  }
  if (r.orientation == Orientation::non_orientable && !options.sheet)
    add("a part of the mesh is one-sided and has no inside (Moebius strip)");
  const char* const trusted = "; left as it is, as asked";
  if (options.sheet) {
    // Whatever the orientation is, it does not matter.
  } else if (r.orientation == Orientation::mixed || r.winding_clashes > 0) {
    std::string text = "faces are oriented inconsistently";
    if (r.winding_clashes > 0)
      text += fmt::format(", {} between two faces {}", edges(r.winding_clashes),
                          r.winding_clashes == 1 ? "clashes" : "clash");
    add(text + (options.trust_orientation ? trusted : "; " + faces(r.flipped_triangles) + " turned"));
  } else if (r.orientation == Orientation::inverted) {
    add("the mesh is inside out" +
        (options.trust_orientation ? trusted : fmt::format("; all {} faces turned", r.flipped_triangles)));
  }
  if (duplicates.dropped_same > 0)
    add(counted(duplicates.dropped_same, "duplicate face", "duplicate faces") + " dropped");
  if (duplicates.kept_same > 0)
    add(counted(duplicates.kept_same, "duplicate face", "duplicate faces") +
        " kept, because the mesh is closed with them only");
  if (duplicates.dropped_opposite > 0)
    add(counted(duplicates.dropped_opposite, "face is", "faces are") +
        " doubled in both orientations, which encloses nothing; one of each kept");
  if (duplicates.kept_opposite > 0)
    add(counted(duplicates.kept_opposite, "pair", "pairs") +
        " of opposite faces without thickness, which enclose nothing");
}

} // namespace

const char* orientation_name(Orientation orientation) {
  switch (orientation) {
  case Orientation::outward:
    return "outward";
  case Orientation::inverted:
    return "inverted";
  case Orientation::mixed:
    return "mixed";
  case Orientation::non_orientable:
    return "non-orientable";
  case Orientation::undefined:
    break;
  }
  return "undefined";
}

PreparedMesh prepare_mesh(const TriangleMesh& mesh, const PrepareOptions& options) {
  if (mesh.triangles.empty()) throw Error(ErrorKind::bad_input, "no triangles: the mesh is empty");
  PreparedMesh out;
  MeshReport& report = out.report;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();

  // Weld.
  WeldedMesh welded = weld(mesh);
  report.merged_vertices = welded.merged_vertices;
  report.unreferenced_vertices = welded.unreferenced_vertices;
  report.degenerate_triangles = welded.collapsed_triangles;
  if (welded.mesh.triangles.empty()) {
    const Box3d bounds = mesh.bounds();
    throw Error(ErrorKind::bad_input,
                bounds.size() == Vec3d(0)
                    ? "mesh has no extent: all its vertices are at one point"
                    : fmt::format("no triangles with three different corners: all {} are degenerate",
                                  mesh.triangles.size()));
  }
  out.mesh = std::move(welded.mesh);
  for (const Vec3d& v : out.mesh.vertices) report.bounds.extendBy(v);
  // Volumes and squares of areas are third and fourth powers of lengths: doubles hold them, with room for
  // triangles far smaller than the mesh, for lengths from 1e-50 to 1e50.
  const Vec3d size = report.bounds.size();
  if (const double side = std::max({size.x, size.y, size.z}); !(side >= 1e-50 && side <= 1e50))
    throw Error(
        ErrorKind::limit,
        fmt::format("the mesh's longest side is {:.4g}, which must be from 1e-50 to 1e50; scale the mesh",
                    side));
  const std::uint64_t without_area = count_without_area(out.mesh);
  if (without_area == out.mesh.triangles.size())
    throw Error(ErrorKind::bad_input,
                fmt::format("no triangles with an area: all {} are degenerate", mesh.triangles.size()));
  report.degenerate_triangles += without_area;

  // Tell the facts.
  EdgeTable edges = build_edge_table(out.mesh.triangles, out.mesh.vertices.size());
  count_topology(out.mesh, edges, report);

  // Drop repeated faces.
  const Duplicates duplicates = find_duplicates(out.mesh.triangles, edges, !options.trust_orientation);
  report.duplicate_triangles = duplicates.same;
  report.opposite_triangles = duplicates.opposite;
  if (!duplicates.dropped.empty()) {
    drop(out.mesh.triangles, duplicates.dropped);
    edges = build_edge_table(out.mesh.triangles, out.mesh.vertices.size());
  }

  orient(out, edges, options.trust_orientation);
  find_open_edges(out, edges);
  warn(out, duplicates, options);
  return out;
}

} // namespace levelray
