// One knob: the cheapest configuration whose traced surface is within a tolerance of the mesh, found by
// trying and proven afterwards by rays that had no part in the choice.
//
// What is promised: of all rays (lines of space, or those of a camera) that meet the mesh or the traced
// surface, the two are within the tolerance of each other for 99.9 % (measure/surface_judge.hpp says what a
// ray's error is and why no maximum can be promised). A configuration is taken where two independent sets of
// rays, each of 20000 that meet the mesh, both demonstrate that with a chance of error of 1 in 40; the first
// one guides the search, the second is the verification, and what is reported.
//
// How it is chosen. Measured costs say that the voxel size decides: a conversion takes work in proportion to
// 1 / voxel^2, while the intersectors that find every surface differ by a sixth. So the largest voxel that
// meets the tolerance with `exact` is sought, and then, in the order of their measured costs
// (measure/method_costs.hpp), the cheapest intersector that still does. Where conversions are short against a
// picture, voxels up to 1.4 times finer are tried as well, and taken where the conversion and a picture's
// rays cost a tenth less by their counted steps: `midpoint`, which saves a quarter of a ray's time for errors
// of half a voxel, may then do, and where flat faces lie against the blocks makes a factor of up to 2. Errors
// are modelled as a power of the voxel size whose order is that between the last two trials: first order
// where creases rule, second where the mesh is smooth against the voxels. The search ends when the error is
// within an eighth of the tolerance, or voxels a twelfth larger have failed. Normals do not move the surface;
// a surface within a tolerance T of another may be tilted by atan(T / voxel) over a voxel, and the cheapest
// smooth scheme is taken whose median angle to the mesh's is no larger. 16-bit storage is taken when values
// rounded to it still meet the tolerance by both sets of rays.
//
// Nothing depends on times measured at run time: the same input gives the same choice everywhere.
#pragma once

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/ray.hpp"
#include "levelray/trace/level_set.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

struct ToleranceRequest {
  // The tolerance that holds for a level set, world units: one length, or a multiple of its voxel, or what a
  // camera makes of it.
  std::function<double(const LevelSet&)> world;
  // The first `count` verification rays of a seed, unit directions; empty: random_chords of the mesh.
  std::function<std::vector<WorldRay>(const LevelSet&, std::uint64_t seed, std::size_t count)> rays;
  double picture_rays = 512 * 512; // that will be traced, to weigh their cost against the conversion's
  double guess = 0;                // about the tolerance, world units; 0: not known
  // Of convert, voxel_size and resolution count only with fixed_voxel. Memory is limited by max_memory.
  ConvertOptions convert;
  bool fixed_voxel = false;
  double band =
      0; // world units; > 0: half the band's width instead of convert.half_width_voxels, at least a voxel
  double least_voxel = 0;           // world units
  std::string intersector, normals; // empty: to be chosen
  bool stored = false;              // the grid will be written
  std::optional<bool> half;         // with 16-bit floats; nothing: to be chosen
};

struct ToleranceTrial {
  double voxel_size = 0;
  std::string intersector;
  bool half = false;
  double world = 0;        // the tolerance
  double demonstrated = 0; // SurfaceErrors::demonstrated of the first set of rays; infinite: nothing to trace
};

// Of the verification rays, world units.
struct AchievedError {
  double p999 = 0, largest = 0, demonstrated = 0;
  std::uint64_t rays = 0;       // judged
  std::uint64_t lost = 0;       // of them, by the intersector; `largest` is that of the others
  std::uint64_t not_judged = 0; // hits on what closes a hole of the mesh
};

enum class ToleranceEnd {
  met,
  fixed,      // not by the voxel size, intersector or storage that was asked for
  limited,    // finer voxels would exceed max_memory, or least_voxel
  unreachable // finer voxels do not help: parts of the mesh bound nothing, or are thinner than an eighth of
              // the tolerance
};

struct ToleranceResult {
  ToleranceEnd end = ToleranceEnd::met;
  std::optional<ConvertedGrid> converted; // of the choice, unless refused; its values are rounded with `half`
  double voxel_size = 0, world = 0;       // the tolerance
  std::string intersector, normals;
  double normals_median_degrees = 0;
  bool half = false;
  AchievedError achieved; // by the choice; when refused, by the closest there is
  double closest = 0;     // refused: the smallest tolerance that was demonstrated, world units
  std::vector<ToleranceTrial> tried;
};

// Throws what mesh_to_grid throws; Error(usage) for unsigned distances, which no ray meets, unknown methods,
// and worlds that are not > 0.
ToleranceResult convert_to_tolerance(const PreparedMesh& mesh, const ToleranceRequest& request);

// Of a grid that is there: the truth is the interpolant of its samples, and only intersector, normals
// and storage are chosen. `converted` stays empty.
ToleranceResult trace_to_tolerance(const BlockGrid& grid, const ToleranceRequest& request);

} // namespace levelray
