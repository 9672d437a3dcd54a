// The suite `openvdb`: the same grids and the same rays through OpenVDB's LevelSetRayIntersector and through
// our intersectors, in turns; and boxes, whose distance is known, through OpenVDB's mesh converter and ours.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/field/reference_shapes.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/vdb/peer.hpp"
#include "measure_analytic.hpp"
#include "measure_document.hpp"

#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr const char* openvdb_name = "OpenVDB";
constexpr std::string_view our_normals = "interpolation-of-differences";

struct TracerRow {
  Sampling at;
  std::string method;
  Confusion shape, grid;
  ErrorStatistics t, grid_t, degrees; // voxels, voxels, degrees
  double primary_ns = 0, chord_ns = 0, megabytes = 0;
};

std::vector<Hit> hits_of(const std::vector<PeerHit>& found) {
  std::vector<Hit> hits(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    hits[i].status = found[i].hit ? HitStatus::hit : HitStatus::miss;
    hits[i].t = found[i].t;
  }
  return hits;
}

// All tracers on one sampling. Each finds hits and normals, because OpenVDB's does both at once.
std::vector<TracerRow> trace(const SampledShape& s, int repetitions) {
  const OpenVdbLevelSet peer = OpenVdbLevelSet::from_grid(s.grid);
  std::vector<TracerRow> rows;
  std::vector<std::function<void()>> works;
  std::vector<Hit> hits(s.rays.size());
  std::vector<Vec3f> normals(s.rays.size());
  std::vector<PeerHit> found(s.rays.size());
  const auto judged = [&](const std::string& method, const std::vector<Hit>& answers) {
    TracerRow row;
    row.at = s.at, row.method = method;
    const Judgement shape = judge_against_shape(s.reference, s.rays, s.truth, answers);
    const Judgement grid = judge_against_grid(s.at.voxel_size, s.exact, answers);
    row.shape = shape.confusion, row.grid = grid.confusion;
    row.t = error_statistics(shape.t_errors_voxels), row.grid_t = error_statistics(grid.t_errors_voxels);
    row.degrees = error_statistics(normal_errors_degrees(s.shape, s.rays, answers, normals));
    return row;
  };

  for (const std::string& name : method_names<Intersectors>()) {
    closest_hits(s.level_set, s.rays, name, hits);
    hit_normals(s.level_set, s.rays, hits, our_normals, normals);
    rows.push_back(judged(name, hits));
    rows.back().megabytes = static_cast<double>(s.grid.bytes() + s.level_set.bytes()) * 1e-6;
    for (const std::vector<WorldRay>* rays : {&s.primary, &s.chords})
      works.push_back([&, rays, name] {
        in_batches(rays->size(), [&](std::size_t begin, std::size_t count) {
          const std::span<const WorldRay> some(&(*rays)[begin], count);
          closest_hits(s.level_set, some, name, {&hits[begin], count});
          hit_normals(s.level_set, some, {&hits[begin], count}, our_normals, {&normals[begin], count});
        });
      });
  }
  peer.trace(s.rays, found);
  for (std::size_t i = 0; i < found.size(); ++i) normals[i] = Vec3f(found[i].normal);
  rows.push_back(judged(openvdb_name, hits_of(found)));
  rows.back().megabytes = static_cast<double>(peer.bytes()) * 1e-6;
  for (const std::vector<WorldRay>* rays : {&s.primary, &s.chords})
    works.push_back([&, rays] { peer.trace(*rays, found); });

  const std::vector<TimeSpread> times = interleaved_times(works, repetitions);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].primary_ns = times[2 * i].median / static_cast<double>(s.primary.size());
    rows[i].chord_ns = times[2 * i + 1].median / static_cast<double>(s.chords.size());
  }
  return rows;
}

// The box as 12 triangles, outward.
TriangleMesh mesh_of(const OrientedBox& box) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) {
    const Vec3d local((c & 1 ? 1 : -1) * box.half.x, (c & 2 ? 1 : -1) * box.half.y,
                      (c & 4 ? 1 : -1) * box.half.z);
    mesh.vertices.push_back(box.frame.centre + box.frame.to_world_direction(local));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

struct ConverterRow {
  Sampling at;
  std::string method;
  std::uint64_t active = 0, wrong_signs = 0, missing = 0; // samples
  ErrorStatistics error;                                  // of active samples, voxels
  double ms = 0;
};

// Compares the samples closer to the surface than the band with the box's distance.
ConverterRow compare(const BlockGrid& grid, const OrientedBox& box, double half_width_voxels) {
  ConverterRow row;
  const double h = grid.transform.voxel_size;
  std::vector<double> errors;
  Box3i range = grid.active_bounds();
  for (int a = 0; a < 3; ++a) range.min[a] -= 2, range.max[a] += 2;
  for (int k = range.min.z; k <= range.max.z; ++k)
    for (int j = range.min.y; j <= range.max.y; ++j)
      for (int i = range.min.x; i <= range.max.x; ++i) {
        const double truth = box.value(grid.transform.to_world(Vec3d(i, j, k)));
        // Half a thousandth of a voxel from the band's end and from the surface, so that rounding decides
        // nothing.
        if (!(std::fabs(truth) < (half_width_voxels - 5e-4) * h)) continue;
        const double value = static_cast<double>(grid.value(i, j, k));
        const bool active = std::fabs(value) < static_cast<double>(grid.background);
        ++(active ? row.active : row.missing);
        if (std::fabs(truth) > 5e-4 * h && std::signbit(value) != std::signbit(truth)) ++row.wrong_signs;
        if (active) errors.push_back(std::fabs(value - truth) / h);
      }
  row.error = error_statistics(errors);
  return row;
}

std::vector<ConverterRow> convert(const std::string& name, const OrientedBox& box, int resolution,
                                  const AnalyticSettings& settings) {
  const TriangleMesh mesh = mesh_of(box);
  const PreparedMesh prepared = prepare_mesh(mesh);
  ConvertOptions options;
  options.voxel_size = 1.0 / resolution;
  options.half_width_voxels = settings.half_width_voxels;
  const auto ours = [&] { return mesh_to_grid(prepared, options).grid; };
  const BlockGrid own = ours();
  const auto theirs = [&] {
    return OpenVdbLevelSet::from_mesh(mesh, options.voxel_size, options.half_width_voxels,
                                      own.transform.origin);
  };
  std::vector<ConverterRow> rows{compare(own, box, settings.half_width_voxels),
                                 compare(theirs().to_grid(), box, settings.half_width_voxels)};
  const std::vector<TimeSpread> times =
      interleaved_times({[&] { ours(); }, [&] { theirs(); }}, settings.repetitions);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].at = {name, resolution, options.voxel_size};
    rows[i].method = i == 0 ? "levelray" : openvdb_name;
    rows[i].ms = times[i].median * 1e-6;
  }
  return rows;
}

Json tracer_table(const std::vector<TracerRow>& rows) {
  Table table("tracers", "Hits; errors in voxels and degrees, against the shape",
              hit_columns("tracer", true,
                          {{"t_mean", "t mean"},
                           {"t_p99", "t p99"},
                           {"t_p999", "t p99.9"},
                           {"t_max", "t max"},
                           {"angle_mean", "angle mean"},
                           {"angle_p99", "angle p99"},
                           {"angle_max", "angle max"},
                           {"primary_ns", "ns/primary"},
                           {"chord_ns", "ns/random"},
                           {"megabytes", "MB"}}));
  for (const TracerRow& r : rows)
    table.add(hit_row(r.at, r.method, r.shape, true,
                      {r.t.mean, r.t.p99, r.t.p999, r.t.max, r.degrees.mean, r.degrees.p99, r.degrees.max,
                       r.primary_ns, r.chord_ns, r.megabytes}));
  return table.json();
}

Json grid_table(const std::vector<TracerRow>& rows) {
  Table table(
      "tracers-grid", "The same hits against the grid's own surface, as the exact intersector finds it",
      hit_columns("tracer", false,
                  {{"t_mean", "t mean"}, {"t_p99", "t p99"}, {"t_p999", "t p99.9"}, {"t_max", "t max"}}));
  for (const TracerRow& r : rows)
    table.add(
        hit_row(r.at, r.method, r.grid, false, {r.grid_t.mean, r.grid_t.p99, r.grid_t.p999, r.grid_t.max}));
  return table.json();
}

Json converter_table(const std::vector<ConverterRow>& rows) {
  Table table("converters", "Boxes of 12 triangles, converted; errors of samples in voxels",
              {{"shape", "shape"},
               {"resolution", "resolution"},
               {"method", "converter"},
               {"active", "active"},
               {"missing", "missing", 3, true},
               {"wrong_signs", "wrong signs", 3, true},
               {"mean", "mean"},
               {"p99", "p99"},
               {"max", "max"},
               {"ms", "ms"}});
  for (const ConverterRow& r : rows)
    table.add({r.at.shape, r.at.resolution, r.method, r.active, r.missing, r.wrong_signs, r.error.mean,
               r.error.p99, r.error.max, r.ms});
  return table.json();
}

} // namespace

void measure_openvdb(const MeasureOptions& options, Progress& progress, Json& document) {
  const AnalyticSettings settings = analytic_settings(options);
  const std::vector<Reference> shapes = chosen_references(settings);
  const ThreadLimit one_thread(1); // of both programs
  progress.begin("measuring", 0, "");
  std::vector<TracerRow> tracers;
  std::vector<ConverterRow> converters;
  ConvergenceCurves curves;
  Confusion all;
  double done = 0;
  for (const Reference& shape : shapes)
    for (const int resolution : settings.resolutions) {
      check_cancel();
      const SampledShape sampled(shape, resolution, settings);
      for (const TracerRow& row : trace(sampled, settings.repetitions)) {
        const double h = row.at.voxel_size;
        curves.add(shape, row.method, "t", h, row.t.mean * h, row.t.p50 * h);
        if (row.method == Exact::name || row.method == openvdb_name)
          curves.add(shape, row.method == Exact::name ? std::string(our_normals) : row.method, "normal", h,
                     row.degrees.mean, row.degrees.p50);
        tracers.push_back(row);
        if (row.method != openvdb_name) continue;
        all.hits += row.grid.hits, all.misses += row.grid.misses, all.leaks += row.grid.leaks;
        all.phantoms += row.grid.phantoms, all.wrong += row.grid.wrong;
      }
      std::apply(
          [&](const auto&... each) {
            const auto one = [&]<class Shape>(const Shape& box) {
              if constexpr (std::is_base_of_v<OrientedBox, Shape>)
                if (Shape::name == shape.name)
                  for (const ConverterRow& row : convert(shape.name, box, resolution, settings))
                    converters.push_back(row);
            };
            (one(each), ...);
          },
          ReferenceShapes{});
      progress.report(++done / static_cast<double>(shapes.size() * settings.resolutions.size()));
    }

  document["title"] = "levelray measure: beside OpenVDB";
  document["options"] = analytic_options_json(settings);
  for (const TracerRow& row : tracers)
    if (row.method == Exact::name && row.shape.lost())
      document["failures"].push_back(fmt::format("{}: {} at {}: {}, more than sampling explains", row.method,
                                                 row.at.shape, row.at.resolution, faults_text(row.shape)));
  for (const ConverterRow& row : converters)
    if (row.method != openvdb_name && (row.wrong_signs || row.missing))
      document["failures"].push_back(fmt::format("conversion: {} at {}: {} wrong signs, {} missing samples",
                                                 row.at.shape, row.at.resolution, row.wrong_signs,
                                                 row.missing));
  if (all.lost())
    document["findings"].push_back(
        fmt::format("OpenVDB's tracer: {} of {} rays against the grid's own surface", faults_text(all),
                    with_commas(all.rays())));
  document["notes"] = {
      "Both trace the same values, bit by bit, with the same rays, in turns, on one thread; times are "
      "processor time, "
      "medians, and include normals, which OpenVDB's tracer computes with every hit "
      "(LevelSetRayIntersector, linear search by one interpolation). Its normals are compared with our "
      "interpolation of differences.",
      "Errors of t are against the shape itself, and include what sampling does to it; see the suite "
      "analytic for the "
      "rule by which rays are unresolved. The table against the grid's own surface excuses nothing.",
      "Boxes are the shapes whose mesh is exact. OpenVDB's converter is meshToLevelSet; its positions are "
      "32-bit."};
  const std::vector<Convergence> finished = curves.finish();
  document["sections"].push_back(
      {{"id", "hits"},
       {"title", "Hits"},
       {"text", "Mean error of t along the ray, in units of the shape, against the voxel "
                "size."},
       {"plots", convergence_plots(finished, "t", "mean |t error|")},
       {"tables", {tracer_table(tracers), grid_table(tracers)}}});
  document["sections"].push_back({{"id", "normals"},
                                  {"title", "Normals"},
                                  {"text", "Mean angle to the shape's normal, against the voxel size."},
                                  {"plots", convergence_plots(finished, "normal", "mean angle, degrees")},
                                  {"tables", Json::array()}});
  if (!converters.empty())
    document["sections"].push_back({{"id", "conversion"},
                                    {"title", "Conversion"},
                                    {"text", "Samples within the band against the distance to the box."},
                                    {"plots", Json::array()},
                                    {"tables", {converter_table(converters)}}});
}

} // namespace levelray
