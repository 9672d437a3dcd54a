#include "levelray/convert/mesh_to_grid.hpp"

#include "levelray/convert/assemble.hpp"
#include "levelray/convert/thicken.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>

namespace levelray {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string memory_text(double bytes) {
  if (bytes >= 0x1p40) return fmt::format("{:.3g} TiB", bytes * 0x1p-40);
  return bytes >= 0x1p30 ? fmt::format("{:.3g} GiB", bytes * 0x1p-30)
                         : fmt::format("{:.3g} MiB", bytes * 0x1p-20);
}

double longest_side(const Box3d& box) {
  const Vec3d size = box.size();
  return std::max({size.x, size.y, size.z});
}

// Sample (0,0,0) lies at the world's origin, as OpenVDB's tools have it, unless indices would grow so large
// that voxel-space doubles or OpenVDB's int32 coordinates suffer; then at a multiple of the voxel near the
// mesh.
GridTransform transform_for(const Box3d& bounds, double voxel_size) {
  GridTransform transform;
  transform.voxel_size = voxel_size;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(bounds.min[axis]), std::abs(bounds.max[axis])});
  if (largest / voxel_size > 1 << 20)
    for (int axis = 0; axis < 3; ++axis)
      transform.origin[axis] =
          std::round((bounds.min[axis] + bounds.max[axis]) / 2 / voxel_size) * voxel_size;
  return transform;
}

// The nodes that the band may touch, and one more on each side.
NodeBox node_box(const Box3d& bounds, const GridTransform& transform, double reach) {
  NodeBox box;
  const Vec3d lo = transform.to_voxel(bounds.min), hi = transform.to_voxel(bounds.max);
  for (int axis = 0; axis < 3; ++axis) {
    const int first = static_cast<int>(std::floor((lo[axis] - reach) / node_dim)) - 1;
    const int last = static_cast<int>(std::floor((hi[axis] + reach) / node_dim)) + 1;
    box.node_min[axis] = first;
    box.dims[axis] = last - first + 1;
  }
  return box;
}

double total_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles)
    area += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                .length() /
            2;
  return area;
}

double voxel_size_of(const PreparedMesh& mesh, const ConvertOptions& options) {
  const double longest = longest_side(mesh.report.bounds);
  if (options.voxel_size == 0) {
    if (options.resolution < 1)
      throw Error(ErrorKind::usage, fmt::format("resolution must be at least 1, not {}", options.resolution));
    return longest / options.resolution;
  }
  if (!(options.voxel_size > 0) || !std::isfinite(options.voxel_size))
    throw Error(ErrorKind::usage,
                fmt::format("voxel size must be a finite number > 0, not {}", options.voxel_size));
  if (options.voxel_size > longest)
    throw Error(ErrorKind::usage,
                fmt::format("voxel size {:.6g} is larger than the mesh, whose longest side is {:.6g}; "
                            "try --voxel {:.3g} or --resolution 256",
                            options.voxel_size, longest, longest / 256));
  return options.voxel_size;
}

// The sheet's radius in voxels; 0 where no sheet is asked for.
double thicken_voxels(const ConvertOptions& options, double voxel_size) {
  if (options.thicken == 0) return 0;
  if (!(options.thicken > 0) || !std::isfinite(options.thicken))
    throw Error(ErrorKind::usage,
                fmt::format("a sheet's radius must be a finite number > 0, not {}", options.thicken));
  if (options.sign != SignMethod::automatic && options.sign != SignMethod::unsigned_distance)
    throw Error(ErrorKind::usage,
                "a sheet is on both sides of the mesh: signs cannot be chosen for it (leave out --sign)");
  const double radius = options.thicken / voxel_size;
  if (!(2 * radius >= least_thickness_voxels))
    throw Error(
        ErrorKind::usage,
        fmt::format("a sheet {:.4g} thick is thinner than a voxel of {:.4g} and would be lost in places; try "
                    "--thicken {:.3g} or --voxel {:.3g}",
                    2 * options.thicken, voxel_size, 1.5 * voxel_size, options.thicken / 1.5));
  return radius;
}

// Why the signs are what they are, in words for the user.
std::string sign_reason(const PreparedMesh& mesh, SignMethod asked, SignMethod used) {
  const std::string facts =
      mesh.open_edges.empty()
          ? std::string("the mesh encloses its volume, so its winding number is an integer, counted exactly")
          : fmt::format("the mesh has {} open edges in {} holes: inside is where its generalised winding "
                        "number exceeds 1/2",
                        mesh.open_edges.size(), mesh.report.boundary_loops);
  if (asked == SignMethod::automatic || used == SignMethod::winding) return facts;
  switch (used) {
  case SignMethod::winding_abs:
    return "asked for: inside is where the winding number's magnitude exceeds 1/2";
  case SignMethod::flood:
    return "asked for: outside is what can be reached from outside without crossing the surface";
  case SignMethod::pseudonormal:
    return "asked for: the side of the nearest feature's pseudonormal";
  default:
    return "asked for: no sign, all distances positive";
  }
}

void check_inside(const PreparedMesh& mesh, const BlockGrid& grid, double voxel_size,
                  std::uint64_t thin_places, ConvertReport& report) {
  if (report.thickness > 0 && report.inside_samples == 0)
    throw Error(ErrorKind::bad_input,
                fmt::format("the sheet falls between the samples; try --thicken {:.3g} or --voxel {:.3g}",
                            1.5 * voxel_size, report.thickness / 3));
  if (report.sign == SignMethod::unsigned_distance) return;
  if (report.inside_samples == 0)
    throw Error(
        ErrorKind::bad_input,
        fmt::format("no enclosed volume: no sample lies inside ({}); use --thicken 1.5vx for a thin sheet, "
                    "--sign unsigned, a closed mesh, or a voxel smaller than {:.4g}",
                    mesh.report.closed ? "the mesh is closed but thinner than a voxel, or has no thickness"
                                       : fmt::format("the mesh has {} open edges", mesh.open_edges.size()),
                    voxel_size));
  const double share =
      static_cast<double>(report.inside_samples) / static_cast<double>(grid.active_sample_count());
  if (!mesh.open_edges.empty() && share < 0.2)
    report.warnings.push_back(fmt::format(
        "only {:.1f} % of the band lies inside: much of this open surface bounds no volume and is lost; "
        "--thicken 1.5vx makes a thin sheet of it",
        100 * share));
  // A few grazed bumps and creases are in every mesh; parts that are thin meet an edge twice in a good share
  // of their blocks.
  if (thin_places > grid.block_count() / 50)
    report.warnings.push_back(fmt::format(
        "the surface folds back within one voxel at {} places: parts thinner than {:.4g} may be lost; "
        "try --voxel {:.3g}",
        thin_places, voxel_size, voxel_size / 2));
}

} // namespace

const std::vector<std::string>& sign_method_names() {
  static const std::vector<std::string> names{"auto",        "pseudonormal", "winding",
                                              "winding-abs", "flood",        "unsigned"};
  return names;
}

ConvertPlan plan_conversion(const PreparedMesh& mesh, const ConvertOptions& options) {
  if (!(options.half_width_voxels >= 1) || options.half_width_voxels > 1000)
    throw Error(ErrorKind::usage,
                fmt::format("the band's half-width must be between 1 and 1000 voxels, not {}",
                            options.half_width_voxels));
  ConvertPlan plan;
  plan.voxel_size = voxel_size_of(mesh, options);
  const double radius = thicken_voxels(options, plan.voxel_size);
  if (!(radius + options.half_width_voxels <= 1000))
    throw Error(ErrorKind::usage,
                fmt::format("a sheet {:.4g} thick has {:.4g} voxels from side to side; at most 1990 "
                            "are supported",
                            2 * options.thicken, 2 * radius));
  const Vec3d size = mesh.report.bounds.size() / plan.voxel_size;
  const double band = 2 * (options.half_width_voxels + radius); // distances are computed for all of a sheet
  // Samples are floats in world units: distances up to the band's width and what lies beyond must stay
  // finite, and 2^-24 of a voxel must not be denormal (below 2^-126).
  if (!(plan.voxel_size >= 0x1p-100 && plan.voxel_size <= 0x1p100))
    throw Error(
        ErrorKind::limit,
        fmt::format("voxels of {:.4g}: distances are single precision numbers, which hold voxels from "
                    "{:.2g} to {:.2g}; scale the mesh",
                    plan.voxel_size, 0x1p-100, 0x1p100));

  // A sheet of area A has A * 2H samples within H, and blocks that meet the band hold about as many as a band
  // wider by 4.3 would, measured on closed meshes. Where the band is wide against the mesh, its rounded edges
  // and corners weigh more than that: Steiner's formula (1840) for the mesh's box, pi H^2 (a + b + c) + 4/3
  // pi H^3. Thin or folded surfaces have fewer, never more than the box holds.
  const double area = total_area(mesh.mesh) / (plan.voxel_size * plan.voxel_size);
  const auto samples_within = [&](double width, double spare) {
    const double h = width / 2;
    const double box = (size.x + width + spare) * (size.y + width + spare) * (size.z + width + spare);
    const double rounding = std::numbers::pi * h * h * (size.x + size.y + size.z + 4.0 / 3 * h);
    return std::min(area * width + rounding, box);
  };
  const double samples = samples_within(band, 1) + 100;
  const double blocks = samples_within(band + 4.3, 0) / 64 + 8;
  double nodes = 1;
  for (int axis = 0; axis < 3; ++axis) nodes *= std::ceil((size[axis] + band) / node_dim) + 3;

  // Per block: its values twice (band, grid), masks, components, and what allocators add; per node that the
  // surface touches (one for 23 blocks) its components and faces; per table entry sides and regions; per
  // triangle the voxel mesh and its bins. Measured on closed meshes from 256 to 1024 voxels: within 20 % of
  // the peak.
  const double bytes =
      blocks * (850 + 3000.0 / 23) + nodes * 64 + static_cast<double>(mesh.mesh.triangles.size()) * 200;
  constexpr double max_nodes = 2147483647.0;
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::limit,
                fmt::format("size {:.4g} x {:.4g} x {:.4g} with voxel {:.4g} needs about {:.2g} band samples "
                            "and {}; {}",
                            mesh.report.bounds.size().x, mesh.report.bounds.size().y,
                            mesh.report.bounds.size().z, plan.voxel_size, samples, memory_text(bytes), why));
  };
  if (!(nodes < max_nodes))
    refuse(fmt::format("the largest grid has {:.2g} nodes of 16^3, this one {:.2g}", max_nodes, nodes));
  if (options.max_memory != 0 && !(bytes <= static_cast<double>(options.max_memory)))
    refuse(
        fmt::format("the limit is {} (--max-memory)", memory_text(static_cast<double>(options.max_memory))));

  for (int axis = 0; axis < 3; ++axis) plan.dims[axis] = static_cast<int>(std::ceil(size[axis] + band)) + 1;
  plan.active_samples = static_cast<std::uint64_t>(samples);
  plan.bytes = static_cast<std::uint64_t>(bytes);
  plan.seconds = samples * 60e-9 + static_cast<double>(mesh.mesh.triangles.size()) * 1e-6;
  return plan;
}

namespace {

// How far the interpolant of exact samples may be from their field where that changes by no more than the way
// between two points, as distances do, and signed ones whose sign changes on the surface alone: it is a mean
// of corner values, each off by the distance to its corner at most, so by Cauchy and Schwarz
// h sqrt(sum x (1-x)) <= sqrt(3)/2 h. With the samples' own error, 1e-5 h (README.md) and a rounding to
// float.
double interpolation_error(double voxel_size, float background) {
  return voxel_size * (0.8660254037844387 + 1e-5) + 0x1p-24 * static_cast<double>(background);
}

} // namespace

ConvertedGrid mesh_to_grid(const PreparedMesh& mesh, const ConvertOptions& options) {
  const ConvertPlan plan = plan_conversion(mesh, options);
  const auto progress = [&](const char* stage, double done) {
    if (options.progress) options.progress(stage, done);
  };
  ConvertedGrid result;
  ConvertReport& report = result.report;
  report.sign = options.thicken > 0                     ? SignMethod::unsigned_distance
                : options.sign == SignMethod::automatic ? SignMethod::winding
                                                        : options.sign;
  report.sign_reason = options.thicken > 0 ? "a sheet is where the distance is below its radius"
                                           : sign_reason(mesh, options.sign, report.sign);
  report.thickness = 2 * options.thicken;

  // Distances: unsigned, per node, with what the sheets separate.
  const Clock::time_point distance_start = Clock::now();
  const GridTransform transform = transform_for(mesh.report.bounds, plan.voxel_size);
  const VoxelMesh voxel_mesh = make_voxel_mesh(mesh, transform);
  const double radius = thicken_voxels(options, plan.voxel_size);
  const double half_width = options.half_width_voxels + radius;
  const double reach = std::max(half_width, sign_reach);
  BandOptions band_options;
  band_options.half_width_voxels = half_width;
  band_options.counting = counting_for(report.sign);
  band_options.find_components = report.sign != SignMethod::unsigned_distance;

  std::optional<Pseudonormals> pseudonormals;
  if (report.sign == SignMethod::pseudonormal) band_options.pseudonormals = &pseudonormals.emplace(mesh.mesh);

  Band band;
  band.box = node_box(mesh.report.bounds, transform, reach);
  const NodeBins bins = bin_triangles(voxel_mesh, band.box, reach, sign_reach);
  band.node_at.assign(band.box.count(), Band::untouched);
  for (std::size_t i = 0; i < bins.node.size(); ++i)
    band.node_at[bins.node[i]] = static_cast<std::int32_t>(i);
  band.nodes.resize(bins.node.size());
  std::atomic<std::size_t> done{0};
  parallel_for(bins.node.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      band.nodes[i] = make_node_band(voxel_mesh, band.box.coord(bins.node[i]), bins.list(i), band_options);
    progress("distance", static_cast<double>(done += end - begin) / static_cast<double>(bins.node.size()));
  });
  report.distance_ms = ms_since(distance_start);

  // Signs.
  const Clock::time_point sign_start = Clock::now();
  const BoundaryWinding boundary(voxel_mesh);
  Regions regions;
  if (band_options.find_components) regions = join_regions(band, band_options.counting);
  std::vector<NodeSides> sides;
  if (radius > 0) {
    sides = thicken_band(band, radius);
  } else {
    sides.resize(band.box.count());
    parallel_for(sides.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        sides[n] = node_sides(band, regions, boundary, report.sign, n);
      progress("sign", static_cast<double>(end) / static_cast<double>(sides.size()));
    });
  }
  report.sign_ms = ms_since(sign_start);

  std::uint64_t thin_places = 0;
  for (const NodeBand& node : band.nodes) thin_places += static_cast<std::uint64_t>(node.thin_places);
  const Clock::time_point assemble_start = Clock::now();
  result.grid = assemble_grid(band, sides, transform, options.half_width_voxels, &report.inside_samples);
  report.distance_ms += ms_since(assemble_start);
  const bool by_winding = report.sign == SignMethod::winding || report.sign == SignMethod::winding_abs;
  if ((mesh.report.closed && by_winding) ||
      report.sign == SignMethod::unsigned_distance) // sheets are that, too
    result.grid.field_error = interpolation_error(plan.voxel_size, result.grid.background);
  if (radius > 0 && 2 * radius < safe_thickness_voxels * (1 - 1e-9))
    report.warnings.push_back(
        fmt::format("the sheet is {:.3g} voxels thick; below {:.3g} it may have holes: try "
                    "--thicken {:.3g} or --voxel {:.3g}",
                    2 * radius, safe_thickness_voxels, 1.5 * plan.voxel_size, options.thicken / 1.5));
  if (radius > 0 && mesh.open_edges.empty() && mesh.report.closed)
    report.warnings.push_back("the mesh is closed: its sheet is a hollow shell along the surface");
  if (boundary.many() && (report.sign == SignMethod::winding || report.sign == SignMethod::winding_abs))
    report.warnings.push_back(fmt::format("the surface has {} open edges: its winding number was estimated, "
                                          "and may decide wrongly where it is near one "
                                          "half; weld the mesh's vertices if it is meant to be closed",
                                          mesh.open_edges.size()));
  check_inside(mesh, result.grid, plan.voxel_size, thin_places, report);
  return result;
}

} // namespace levelray
