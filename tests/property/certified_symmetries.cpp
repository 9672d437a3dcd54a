// Threads, accelerations and scales change no bit of a hit; symmetries of the grid change t within the bounds
// that certify gives.
#include "levelray/core/parallel.hpp"
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/certified_hit.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

namespace {

std::vector<Shape> shapes() {
  return {{"sphere", sphere_grid(9)},
          {"torus with a tube of radius 1", torus_grid(10, 1)},
          {"plate 0.8 voxel thick", slab_grid(0.8, 12)},
          {"gyroid", gyroid_grid(14)}};
}

std::vector<WorldRay> rays_for(const BlockGrid& grid, unsigned seed, std::size_t count) {
  RandomRays random(seed);
  std::vector<WorldRay> rays;
  for (std::size_t i = 0; i < count; ++i) {
    rays.push_back(random.through(active_box(grid)));
    if (i % 5 == 0) rays.back().origin = random.in_box(active_box(grid));
    if (i % 7 == 0) rays.back().t_max = random.uniform(0, 60);
  }
  return rays;
}

struct Traced {
  std::vector<Hit> hits;
  std::vector<CertifiedHit> certified;
  std::vector<std::vector<SurfacePlace>> places;
};

Traced trace(const BlockGrid& grid, const std::vector<WorldRay>& rays, Traversal traversal, int threads) {
  const ThreadLimit limit(threads);
  const LevelSet level_set(grid);
  Traced traced{std::vector<Hit>(rays.size()), std::vector<CertifiedHit>(rays.size()),
                std::vector<std::vector<SurfacePlace>>(rays.size())};
  PrimaryOptions options;
  options.traversal = traversal;
  parallel_for(rays.size(), 100, [&](std::size_t begin, std::size_t end) {
    closest_hits(level_set, {&rays[begin], end - begin}, options, {&traced.hits[begin], end - begin});
    for (std::size_t i = begin; i < end; ++i) {
      traced.certified[i] = certify(level_set, rays[i], traced.hits[i]);
      all_hits(level_set, rays[i], traced.places[i]);
    }
  });
  return traced;
}

std::size_t differences(const Traced& a, const Traced& b, double scale) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.hits.size(); ++i) {
    const Hit &x = a.hits[i], &y = b.hits[i];
    const CertifiedHit &p = a.certified[i], &q = b.certified[i];
    different += x.status != y.status || x.t * scale != y.t || x.t_outside * scale != y.t_outside ||
                 x.cell != y.cell || x.from_inside != y.from_inside;
    different += p.proof != q.proof;
    if (x) different += p.t_lo * scale != q.t_lo || p.t_hi * scale != q.t_hi || p.error * scale != q.error;
    different += a.places[i].size() != b.places[i].size();
    for (std::size_t k = 0; k < a.places[i].size() && k < b.places[i].size(); ++k)
      different += a.places[i][k].t * scale != b.places[i][k].t || a.places[i][k].kind != b.places[i][k].kind;
  }
  return different;
}

} // namespace

TEST_CASE("threads and leaps change no bit of hits, certificates and places") {
  for (const Shape& shape : shapes()) {
    const std::vector<WorldRay> rays = rays_for(shape.grid, 71, 3000);
    const Traced one = trace(shape.grid, rays, Traversal::leaps, 1);
    CAPTURE(shape.name);
    for (const int threads : {1, 2, 7})
      for (const Traversal traversal : {Traversal::leaps, Traversal::plain}) {
        CAPTURE(threads, static_cast<int>(traversal));
        CHECK(differences(one, trace(shape.grid, rays, traversal, threads), 1) == 0);
      }
  }
}

TEST_CASE("powers of two scale certificates and places and change nothing else") {
  for (const Shape& shape : shapes()) {
    const std::vector<WorldRay> rays = rays_for(shape.grid, 73, 2000);
    const Traced here = trace(shape.grid, rays, Traversal::leaps, 2);
    for (const double scale : {0x1p-30, 0x1p17}) {
      BlockGrid grid = shape.grid;
      grid.transform.voxel_size *= scale;
      grid.background *= static_cast<float>(scale);
      for (float& value : grid.values) value *= static_cast<float>(scale);
      std::vector<WorldRay> scaled = rays;
      for (WorldRay& ray : scaled) ray.origin *= scale, ray.t_max *= scale;
      CAPTURE(shape.name, scale);
      CHECK(differences(here, trace(grid, scaled, Traversal::leaps, 2), scale) == 0);
    }
  }
}

TEST_CASE("permuted and mirrored grids have the same hits, within the sum of the certified bounds") {
  const struct {
    int order[3], sign[3];
  } symmetries[] = {{{0, 1, 2}, {-1, 1, 1}},
                    {{0, 1, 2}, {-1, -1, -1}},
                    {{1, 2, 0}, {1, 1, 1}},
                    {{2, 1, 0}, {1, 1, 1}},
                    {{2, 0, 1}, {-1, 1, -1}}};
  for (const Shape& shape : shapes()) {
    const std::vector<WorldRay> rays = rays_for(shape.grid, 79, 1500);
    const Traced here = trace(shape.grid, rays, Traversal::leaps, 2);
    const Box3i bounds = shape.grid.active_bounds();
    for (const auto& symmetry : symmetries) {
      Box3d box;
      for (const Vec3i& corner : {bounds.min - Vec3i(2, 2, 2), bounds.max + Vec3i(2, 2, 2)}) {
        Vec3d p;
        for (int a = 0; a < 3; ++a) p[a] = symmetry.sign[a] * corner[symmetry.order[a]];
        box.extendBy(p);
      }
      const BlockGrid grid = sample_grid(
          [&](const Vec3d& p) {
            int source[3];
            for (int a = 0; a < 3; ++a)
              source[symmetry.order[a]] = symmetry.sign[a] * static_cast<int>(std::lround(p[a]));
            return double(shape.grid.value(source[0], source[1], source[2]));
          },
          1, 3, box);
      std::vector<WorldRay> moved = rays;
      for (std::size_t i = 0; i < rays.size(); ++i)
        for (int a = 0; a < 3; ++a) {
          moved[i].origin[a] = symmetry.sign[a] * rays[i].origin[symmetry.order[a]];
          moved[i].direction[a] = symmetry.sign[a] * rays[i].direction[symmetry.order[a]];
        }
      const Traced there = trace(grid, moved, Traversal::leaps, 2);
      std::size_t different = 0, beyond_bounds = 0, hits = 0, places = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        different +=
            bool(here.hits[i]) != bool(there.hits[i]) || here.places[i].size() != there.places[i].size();
        places += here.places[i].size();
        if (!here.hits[i] || !there.hits[i]) continue;
        ++hits;
        beyond_bounds += !(std::fabs(here.hits[i].t - there.hits[i].t) <=
                           here.certified[i].error + there.certified[i].error);
      }
      CAPTURE(shape.name, symmetry.order[0], symmetry.sign[0], hits, places);
      CHECK(different == 0);
      CHECK(beyond_bounds == 0);
      CHECK(hits > 50);
    }
  }
}
