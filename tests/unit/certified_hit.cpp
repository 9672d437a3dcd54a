// Certificates where the truth is known by hand, and of hits in difficult places.
#include "levelray/trace/certified_hit.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/trace/ray_values.hpp"
#include "support/catch.hpp"
#include "support/reference_tracer.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

namespace {

BlockGrid unit_plate(double half) {
  return sample_grid(
      [=](const Vec3d& p) {
        return std::max({std::fabs(p.x) - half, std::fabs(p.y) - 12, std::fabs(p.z) - 12});
      },
      1, 3, Box3d(Vec3d(-9, -18, -17), Vec3d(8, 17, 18)));
}

WorldRay ray_of(const Vec3d& origin, const Vec3d& direction) {
  WorldRay ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

} // namespace

TEST_CASE("values along a ray are those of the interpolant, at any scale and from far away") {
  const BlockGrid grid = unit_plate(1.75);
  for (const double length : {1.0, 0x1p-700, 0x1p900}) {
    const RayValues values(grid, ray_of(Vec3d(-20, 0.25, 0.5), Vec3d(length, 0, 0)));
    CHECK(values.at(20 / length).value == -1.75);
    CHECK(values.at(18.25 / length).value == 0); // |x| = 1.75
    CHECK(values.at(18 / length).value == 0.25);
    CHECK(values.at(18.25 / length).error <= 0x1p-90);
    CHECK(values.at(1 / length).value == 3); // beyond the band, and then beyond the grid
    CHECK(values.at(1e30 / length).value == 3);
  }
  // 2^40 voxels away a double knows places to 2^-12; the sums do not round.
  const RayValues far(grid, ray_of(Vec3d(-0x1p40, 0.25, 0.5), Vec3d(1 + 0x1p-50, 0, 0)));
  CHECK(far.at(0x1p40 - 2).value == 0.25 - 0x1p-10 + 0x1p-49);
  CHECK(far.at(std::numeric_limits<double>::quiet_NaN()).error == std::numeric_limits<double>::infinity());
}

TEST_CASE("a hit on a plane is certified within a few units in the last place") {
  for (const double half : {1.75, 2.0}) {
    const BlockGrid grid = unit_plate(half);
    const LevelSet level_set(grid);
    const WorldRay ray = ray_of(Vec3d(-20, 0.25, 0.5), Vec3d(1, 0, 0));
    const Hit hit = closest_hit(level_set, ray);
    const CertifiedHit certified = certify(level_set, ray, hit);
    CHECK(certified.proof == Proof::crossing);
    CHECK(certified.t_lo < 20 - half);
    CHECK(certified.t_hi >= 20 - half);
    CHECK(certified.t_hi - certified.t_lo <= 1e-14);
    CHECK(certified.error <= 1e-11);
  }
}

TEST_CASE("a ray that begins on the surface is said to") {
  const BlockGrid grid = unit_plate(2);
  const LevelSet level_set(grid);
  const WorldRay ray = ray_of(Vec3d(-2, 0.25, 0.5), Vec3d(1, 0, 0));
  const CertifiedHit certified = certify(level_set, ray, closest_hit(level_set, ray));
  CHECK(certified.proof == Proof::beginning);
  CHECK(certified.t_lo == 0);
  CHECK(certified.t_hi <= 1e-15);
  CHECK(certified.error <= 1e-15);
}

TEST_CASE("a touch is a proven root where f is exactly 0, and else a graze") {
  const BlockGrid grid = unit_plate(2);
  const LevelSet level_set(grid);
  // Along the face x = 2: f = 0 from y = -12 on, for want of other terms.
  const WorldRay along = ray_of(Vec3d(2, -30, 0.5), Vec3d(0, 1, 0));
  const CertifiedHit face = certify(level_set, along, closest_hit(level_set, along));
  CHECK(face.proof == Proof::crossing);
  CHECK(face.t_lo < 18);
  CHECK(face.t_hi == 18);
  // Past the face, 2^-60 off it: f = 2^-60 there, which the tracer may take for 0 and RayValues does not.
  const WorldRay past = ray_of(Vec3d(2 + 0x1p-51, -30, 0.5), Vec3d(0, 1, 0));
  Hit hit = closest_hit(level_set, past);
  const bool took_it_for_a_hit = bool(hit);
  hit.status = HitStatus::hit;
  hit.t = 25;
  const CertifiedHit graze = certify(level_set, past, hit);
  CAPTURE(took_it_for_a_hit);
  CHECK(graze.proof == Proof::graze);
  CHECK(graze.clear_to <= 18.1);
  CHECK(graze.error >= 6.9);
}

TEST_CASE("a miss is proven up to the end, or up to where the surface comes within rounding") {
  const BlockGrid grid = unit_plate(2);
  const LevelSet level_set(grid);
  WorldRay ray = ray_of(Vec3d(2.5, -30, 0.5), Vec3d(0, 1, 0));
  ray.t_max = 100;
  CertifiedHit certified = certify(level_set, ray, closest_hit(level_set, ray));
  CHECK(certified.proof == Proof::miss);
  CHECK(certified.clear_to == 100);
  ray.origin.x = 2 + 0x1p-51;
  certified = certify(level_set, ray, Hit{});
  CHECK(certified.clear_to <= 18.1);
}

TEST_CASE("hits of the approximate intersectors are certified with the error that they have") {
  const BlockGrid grid = torus_grid(10, 1.5);
  const LevelSet level_set(grid);
  const ReferenceTracer reference(grid);
  for (const std::string_view name : {"midpoint", "false-position-1", "exact"}) {
    RandomRays random(7);
    std::size_t hits = 0, violated = 0, unproven = 0;
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const WorldRay ray = random.through(active_box(grid));
      const Hit hit = closest_hit(level_set, ray, name);
      const ReferenceHit truth = reference.closest(ray);
      if (!hit || !truth.hit) continue;
      ++hits;
      const CertifiedHit certified = certify(level_set, ray, hit);
      if (certified.proof == Proof::refuted) {
        violated += !(static_cast<double>(truth.t) >= certified.clear_to) || name == "exact";
        continue;
      }
      violated += !(std::fabs(hit.t - static_cast<double>(truth.t)) <= certified.error);
      if (certified.proof != Proof::crossing) {
        ++unproven;
        continue;
      }
      const RayValues values(grid, ray);
      violated += !values.at(certified.t_lo).surely_positive() ||
                  !values.at(certified.t_hi).surely_not_positive() || !(certified.t_lo < certified.t_hi);
      worst = std::max(worst, certified.error);
    }
    CAPTURE(name, hits, worst);
    CHECK(hits > 300);
    CHECK(violated == 0);
    if (name == "exact") {
      CHECK(unproven == 0);
      CHECK(worst < 1e-5); // a graze of depth 1e-12 would have it
    }
  }
}

TEST_CASE("the original sphere lies in the bracket that the field's error gives") {
  const double radius = 9;
  const Vec3d centre(-2.3, 1.7, 0.4);
  const BlockGrid grid =
      sample_grid(sphere_field(centre, radius), 1, 3, Box3d(Vec3d(-15, -13, -14), Vec3d(13, 14, 30)));
  const LevelSet level_set(grid);
  RandomRays random(3);
  std::size_t outside = 0, bounded = 0;
  for (int i = 0; i < 3000; ++i) {
    const WorldRay ray = random.through(active_box(grid));
    const Hit hit = closest_hit(level_set, ray);
    if (!hit) continue;
    // h^2/8 (3 curvatures of at most 1/(R-2)): second derivatives of the distance within a cell of the
    // surface.
    const SurfaceBracket bracket = bracket_original(level_set, ray, hit, 3.0 / 8 / (radius - 2));
    const Vec3d o = ray.origin - centre;
    const double b = o.dot(ray.direction), c = b * b - o.dot(o) + radius * radius;
    if (c <= 0) continue; // the sphere itself is missed
    const double t = -b - std::sqrt(c);
    outside += !(bracket.t_lo <= t && t <= bracket.t_hi);
    bounded += bracket.t_hi < t + 1;
  }
  CHECK(outside == 0);
  CHECK(bounded > 500);
}

TEST_CASE("nothing is proven, and soon, of rays whose places rounding blurs by voxels") {
  BlockGrid grid = unit_plate(1.75);
  grid.field_error = 0.9;
  const LevelSet level_set(grid);
  for (const double away : {1e15, 1e30, 1e200}) {
    const WorldRay ray = ray_of(Vec3d(-away, 0.25, 0.5), Vec3d(1, 0, 0));
    const Hit hit = closest_hit(level_set, ray);
    CHECK(bracket_original(level_set, ray, hit).t_lo <= ray.t_min);
  }
  // A field that may be off by more than any sample says nothing either.
  const WorldRay ray = ray_of(Vec3d(-20, 0.25, 0.5), Vec3d(1, 0, 0));
  CHECK(bracket_original(level_set, ray, closest_hit(level_set, ray), 100).t_lo <= ray.t_min);
}
