// Shapes of the suite `extremes`: as small, thin, sharp and close as they come.
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_trial.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

// Directions that fill the sphere evenly: Fibonacci's lattice (Gonzalez 2010, section 3.1).
Vec3d tilt(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), angle = i * 2.399963229728653;
  return Vec3d(r * std::cos(angle), r * std::sin(angle), z);
}

using Field = std::function<double(const Vec3d&)>;
struct Shape {
  std::string name;
  Field field; // voxels
  double extent;
};

ExtremeRow judged(const char* name, const char* expected, std::function<std::vector<Shape>()> shapes,
                  std::size_t rays = 12) {
  return {"shapes", name, expected, [=](const ExtremeSettings& settings) {
            ExtremeTally tally("voxel");
            for (const Shape& shape : shapes()) {
              const BlockGrid grid = grid_of_field(shape.field, shape.extent);
              RayTrial trial(grid, shape.name, settings, tally, 1, 60);
              trial.judge_all_kinds(rays);
            }
            return tally.outcome();
          }};
}

// The interpolant's hits against the ball itself, too: by reference.hpp a value is off by h^2 / 8 times the
// sum of the second derivatives, 2 / (R - sqrt 3) within a cell of the surface, and 2^-24 of the band.
ExtremeOutcome balls(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const double radius : {0.3, 0.5, 0.87, 1.0, 1.5, 2.0, 3.0, 7.0, 30.0, 1e2, 1e3, 1e4}) {
    // Large ones: what is left of them beside their pole, in a box.
    const bool whole = radius <= 100;
    const Vec3d centre = whole ? Vec3d(0.2, -0.3, 0.1) : Vec3d(0.3, 0.2, -radius);
    const BlockGrid grid = grid_of_field(
        [=](const Vec3d& p) {
          const double d = ball_distance(p, centre, radius);
          return whole ? d : std::max(d, box_distance(p, Vec3d(20, 20, 6)));
        },
        whole ? radius + 1 : 21);
    RayTrial trial(grid, fmt::format("ball of radius {}", radius), settings, tally, 1, 100);
    trial.judge_all_kinds(15);
    if (radius < 3) continue;
    const double off = 0.25 / (radius - std::sqrt(3.0)) + 3 * 0x1p-24;
    for (int i = 0; i < 200; ++i) {
      const WorldRay ray = trial.random_ray();
      const Hit hit = closest_hit(trial.level_set(), ray, settings.intersector);
      const Vec3d p = ray.at(hit.t);
      if (!hit || (!whole && box_distance(p, Vec3d(20, 20, 6)) > -2.5)) continue;
      tally.check(std::fabs(ball_distance(p, centre, radius)) <= off, [&] {
        return trial.describe(ray) + fmt::format(": hit {:a} is {:.3g} from the ball, more than {:.3g}",
                                                 hit.t, ball_distance(p, centre, radius), off);
      });
    }
  }
  return tally.outcome();
}

std::vector<Shape> slabs() {
  std::vector<Shape> shapes;
  const double thicknesses[] = {0.1, 0.2, 0.35, 0.5, 0.7, 0.8, 1.0, 1.3, 1.7, 2.0};
  for (int i = 0; i < 100; ++i) {
    const double thickness = thicknesses[i % 10];
    const Vec3d w = tilt(i, 100);
    const Vec3d off(0.013 * (i % 7), 0.021 * (i % 11), 0.017 * (i % 13));
    shapes.push_back({fmt::format("slab {} thick, tilt {}", thickness, i),
                      [=](const Vec3d& p) { return box_distance(p - off, Vec3d(6, 6, thickness / 2), w); },
                      10});
  }
  return shapes;
}

std::vector<Shape> gaps() {
  std::vector<Shape> shapes;
  const double gap_sizes[] = {0.5, 0.75, 1, 1.25, 1.5, 2};
  for (int i = 0; i < 36; ++i) {
    const double gap = gap_sizes[i % 6];
    const Vec3d w = i < 6 ? Vec3d(0, 0, 1) : tilt(i, 36);
    shapes.push_back({fmt::format("sheets with a gap of {}, tilt {}", gap, i),
                      [=](const Vec3d& p) {
                        const Vec3d up = w * (gap / 2 + 0.75), half(6, 6, 0.75);
                        return std::min(box_distance(p - up, half, w), box_distance(p + up, half, w));
                      },
                      11});
  }
  return shapes;
}

// A wedge of one degree between two planes through the y axis, cut off by a box.
double wedge(const Vec3d& p) {
  const double angle = 3.14159265358979 / 180;
  return std::max(
      {p.z - p.x * std::tan(angle / 2), -p.z - p.x * std::tan(angle / 2), box_distance(p, Vec3d(14, 5, 5))});
}

double cone(const Vec3d& p, double angle, const Vec3d& axis) {
  const double z = p.dot(axis), r = std::sqrt(std::max(0.0, p.dot(p) - z * z));
  return std::max(r * std::cos(angle) - z * std::sin(angle), z - 12);
}

// Menger's sponge, `width` voxels wide: 0 outside at a level where the middle third of two axes is cut out.
double menger(const Vec3d& p, double width, int levels) {
  double d = box_distance(p, Vec3d(1, 1, 1) * (width / 2));
  double piece = width;
  for (int level = 0; level < levels; ++level, piece /= 3) {
    Vec3d q;
    for (int a = 0; a < 3; ++a) {
      const double x = p[a] + width / 2;
      q[a] =
          std::fabs(x - piece * std::floor(x / piece) - piece / 2) - piece / 6; // of the middle third's bar
    }
    const double bars = std::min({std::max(q.x, q.y), std::max(q.y, q.z), std::max(q.z, q.x)});
    d = std::max(d, -bars);
  }
  return d;
}

ExtremeOutcome checkerboard(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const float size : {1.f, 0x1p-20f}) {
    const BlockGrid grid = grid_of_samples(
        Vec3i(-6, -6, -6), Vec3i(13, 13, 13),
        [=](int i, int j, int k) { return (i + j + k) % 2 ? size : -size; }, 3);
    RayTrial trial(grid, fmt::format("checkerboard of samples of +-{:a}", size), settings, tally);
    trial.judge_all_kinds(100);
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_shape_rows() {
  const Vec3d axis = Vec3d(0.3, 0.9, 0.4).normalized();
  return {
      {"shapes", "balls",
       "Balls of radius 0.3 to 1e4 voxels; from 3 on within the error of interpolation of the ball itself.",
       balls},
      judged("slabs", "Slabs 0.1 to 2 voxels thick at 100 tilts.", slabs, 6),
      judged("gaps", "Two sheets with a gap of 0.5 to 2 voxels, aligned and at 30 tilts.", gaps, 8),
      judged("tori", "Tori with tubes of 0.5 to 3 voxels.",
             [=] {
               std::vector<Shape> shapes;
               for (const double tube : {0.5, 0.7, 1.0, 1.5, 2.0, 3.0})
                 shapes.push_back({fmt::format("torus, tube {}", tube),
                                   [=](const Vec3d& p) { return torus_distance(p, 9, tube, axis); }, 13});
               return shapes;
             }),
      judged("gyroids", "Gyroid sheets 0.5 to 3 voxels thick.",
             [] {
               std::vector<Shape> shapes;
               for (const double thickness : {0.5, 1.0, 1.5, 3.0})
                 shapes.push_back({fmt::format("gyroid {} thick", thickness),
                                   [=](const Vec3d& p) { return gyroid_field(p, thickness, 12); }, 13});
               return shapes;
             }),
      judged("cone-tips", "Cones of 2 to 90 degrees, tip on a sample and off.",
             [=] {
               std::vector<Shape> shapes;
               for (const double degrees : {2, 10, 30, 60, 90})
                 for (const double off : {0.0, 0.37})
                   shapes.push_back({fmt::format("cone of {} degrees, tip at {}", degrees, off),
                                     [=](const Vec3d& p) {
                                       return cone(p - Vec3d(off, off, off), degrees / 360 * 3.14159265358979,
                                                   axis);
                                     },
                                     19});
               return shapes;
             }),
      judged(
          "wedge", "A wedge of 1 degree, whose edge the samples lose.",
          [] {
            return std::vector<Shape>{{"wedge", wedge, 15}};
          },
          40),
      judged("cubes", "Cubes along the axes, faces on samples and between them, and turned.",
             [] {
               std::vector<Shape> shapes;
               for (const double half : {5.0, 5.5, 5.3})
                 shapes.push_back({fmt::format("cube of {}", 2 * half),
                                   [=](const Vec3d& p) { return box_distance(p, Vec3d(half, half, half)); },
                                   7});
               for (int i = 0; i < 6; ++i)
                 shapes.push_back(
                     {fmt::format("cube, tilt {}", i),
                      [=](const Vec3d& p) { return box_distance(p, Vec3d(5, 5, 5), tilt(i, 6)); }, 10});
               return shapes;
             }),
      judged(
          "menger", "Menger's sponge, down to parts of 1 voxel, on samples and off.",
          [] {
            return std::vector<Shape>{
                {"sponge of 27 voxels", [](const Vec3d& p) { return menger(p, 27, 3); }, 15},
                {"sponge of 27.3 voxels, off",
                 [](const Vec3d& p) { return menger(p - Vec3d(0.21, 0.34, 0.13), 27.3, 3); }, 15}};
          },
          50),
      {"shapes", "checkerboard", "A checkerboard of single samples: every cell a saddle in all directions.",
       checkerboard},
      judged("touching-balls", "Balls that touch in a sample, in a face, nearly, and overlap a little.",
             [] {
               std::vector<Shape> shapes;
               for (const double gap : {0.0, 1e-6, -1e-6, 0.1, -0.1, 0.5})
                 for (const double shift : {0.0, 0.5})
                   shapes.push_back({fmt::format("balls {} apart, shifted by {}", gap, shift),
                                     [=](const Vec3d& p) {
                                       const Vec3d off(5 + gap / 2, 0, 0), q = p - Vec3d(shift, 0, 0);
                                       return std::min(ball_distance(q, off, 5), ball_distance(q, -off, 5));
                                     },
                                     12});
               return shapes;
             }),
  };
}

} // namespace levelray
