// The suite `paper`: what Tables 1 to 4 of Jamriska 2010 measure, measured (measure/printed_tables.hpp has
// the printed figures).
//
// Tables 1 and 2 compare intersectors and normal schemes on a coarse torus; ours is the torus of the
// reference shapes, whose hits and normals are known, so that what the paper shows in pictures is told in
// numbers. Tables 3 and 4 compare ways to the same answers on models: min/max buffers for primary rays,
// looking ahead for the inside for shadow rays towards five lights. Every way's answers are compared bit for
// bit with the paper's plain traversal, before any time is taken.
//
// Ours differs from the paper: one thread, and processor time; a picture is hits and normals without shading;
// where the camera, the lights and the ground are, the paper does not say.
#pragma once

#include "levelray/measure/hit_judgement.hpp"
#include "levelray/measure/sampled_shape.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

struct PaperSettings {
  int image_size = 512; // image_size^2 primary rays
  double half_width_voxels = 3;
  int repetitions = 3; // of timings; 0: none
};

// Gets the fraction done.
using PaperProgress = std::function<void(double)>;

// A method in a picture of the torus. Times are NaN where none were taken.
struct PaperMethod {
  std::string method;
  double samples = 0, interpolations = 0; // in the cell that holds the hit, mean; or of a normal
  double ms = 0, ratio = 0;               // a picture; and by the first method's
  Confusion shape, grid;                  // of hits, against the torus, and against the grid's own surface
  ErrorStatistics error;                  // of hits: t against the torus, voxels; of normals: degrees
  ErrorStatistics grid_error;             // of hits: t against the grid's own surface, voxels
  // Of normals: by how many degrees the angle between those of neighbouring pixels differs from the torus'
  // own there.
  ErrorStatistics jumps;
};

struct PaperTorus {
  Sampling at;
  double voxel_pixels = 0;               // a voxel at the torus' centre, in pixels
  std::vector<PaperMethod> intersectors; // those of Table 1, and exact
  std::vector<PaperMethod> normals;      // those of Table 2, at hits of false-position-1
};

// Tables 1 and 2. Voxels of 1/resolution; the torus is 1 wide.
PaperTorus measure_paper_torus(int resolution, const PaperSettings& settings, const PaperProgress& progress);

// A way to the same answers.
struct PaperWay {
  std::string name;
  int size = 0;                // of the min/max buffers; or n, the blocks looked at ahead
  bool leaps = false;          // over empty space, which the paper does not do
  std::size_t base = 0;        // the way that it is to be quicker than
  CountSums counts = {};       // of all rays
  std::uint64_t different = 0; // answers that are not the first way's bit for bit
  double ms = 0, saved = 0;    // a picture; part of the base's time that is saved, median of the repetitions'
};

// A row of Tables 3 and 4. The first ways are the paper's columns, in its order. Nothing is timed where
// answers differ: NaN.
struct PaperScene {
  std::size_t primary_rays = 0, hits = 0, shadow_rays = 0;
  std::vector<PaperWay> primary, shadow;
};

// A model at a resolution; without a scene where the model is missing. Substitutes are ours, and nothing to
// compare with the paper.
struct PaperRow {
  std::string model;
  int resolution = 0;
  Vec3i voxels{0, 0, 0}; // along the sides of its bounds
  bool substitute = false;
  std::optional<PaperScene> scene;
};

// The grid's object has a longest side of about 1 around the origin (measure/study_scene.hpp) and stands on a
// ground at that height, a disc of radius 1.5 that receives shadows.
PaperScene measure_paper_scene(const BlockGrid& grid, double ground, const PaperSettings& settings,
                               const PaperProgress& progress);

} // namespace levelray
