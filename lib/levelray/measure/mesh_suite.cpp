#include "levelray/measure/mesh_suite.hpp"

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/hit_judgement.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/sampled_shape.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/certified_hit.hpp"
#include "levelray/trace/field_probe.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <random>

namespace levelray {

namespace {

struct SurfacePoint {
  Vec3d position, normal;
};

Vec3d face_normal(const TriangleMesh& mesh, std::uint32_t triangle) { // twice the area long
  const Triangle& t = mesh.triangles[triangle];
  return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; } // [0,1)

 private:
  std::mt19937_64 engine_;
};

// Points spread evenly over the area.
std::vector<SurfacePoint> points_on(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> sums;
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    sums.push_back(area += face_normal(mesh, t).length());
  Random random(seed);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < count && area > 0; ++i) {
    // Stratified along the sum of areas, so that no part is left out.
    const double at = area * (static_cast<double>(i) + random.unit()) / static_cast<double>(count);
    const auto found = std::upper_bound(sums.begin(), sums.end(), at);
    const std::uint32_t t = static_cast<std::uint32_t>(std::min(found, sums.end() - 1) - sums.begin());
    double u = random.unit(), v = random.unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Triangle& c = mesh.triangles[t];
    const Vec3d a = mesh.vertices[c[0]];
    points.push_back({a + (mesh.vertices[c[1]] - a) * u + (mesh.vertices[c[2]] - a) * v,
                      face_normal(mesh, t).normalized()});
  }
  return points;
}

// The next place of the mesh along a direction; the point's own triangle and those that touch it there are
// not met, because the ray begins a little off: 2^-30 of the mesh's size.
double next_place(const TriangleBvh& bvh, const Vec3d& from, const Vec3d& direction, double size) {
  WorldRay ray;
  ray.origin = from;
  ray.direction = direction;
  ray.t_min = 0x1p-30 * size;
  const auto hit = bvh.first_hit(ray);
  return hit ? hit->t : -1;
}

Thickness thickness_of(const TriangleBvh& bvh, const std::vector<SurfacePoint>& points, double size,
                       const std::vector<double>& voxel_sizes) {
  std::vector<double> inward(points.size()), outward(points.size());
  parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      inward[i] = next_place(bvh, points[i].position, -points[i].normal, size);
      outward[i] = next_place(bvh, points[i].position, points[i].normal, size);
    }
  });
  return thickness_statistics(std::move(inward), std::move(outward), voxel_sizes);
}

// The winding number by the crossings of a ray: exact for closed meshes.
int winding_by_ray(const TriangleBvh& bvh, const Vec3d& p) {
  WorldRay ray;
  ray.origin = p;
  ray.direction = Vec3d(0.36, 0.48, 0.8);
  int sum = 0;
  bvh.all_hits(ray, [&](const TriangleHit& hit) { sum += hit.front ? -1 : 1; });
  return sum;
}

// One resolution.
class Round {
 public:
  Round(const PreparedMesh& mesh, const TriangleBvh& bvh, const std::vector<SurfacePoint>& points,
        int resolution, const MeshSuiteSettings& settings, MeshSuiteResult& result)
      : mesh_(mesh), bvh_(bvh), points_(points), settings_(settings), result_(result),
        rays_(random_chords(mesh.report.bounds, settings.points, settings.seed)) {
    ConvertOptions options;
    options.resolution = resolution;
    options.half_width_voxels = settings.half_width_voxels;
    options.max_memory = settings.max_memory;
    const auto start = std::chrono::steady_clock::now();
    grid_ = mesh_to_grid(mesh, options).grid;
    row_.convert_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    row_.resolution = resolution;
    row_.voxel_size = grid_.transform.voxel_size;
  }

  void run() {
    const LevelSet level_set(grid_);
    row_.megabytes = static_cast<double>(grid_.bytes() + level_set.bytes()) * 1e-6;
    zero_set_to_mesh(level_set);
    mesh_to_zero_set();
    if (mesh_.report.closed) signs();
    if (grid_.field_error) brackets(level_set);
    result_.surfaces.push_back(row_);

    const ThreadLimit one_thread(1);
    intersectors(level_set);
    normals(level_set);
  }

 private:
  double distance(const Vec3d& p) const { return std::sqrt(bvh_.closest_point(p)->distance_squared); }

  void zero_set_to_mesh(const LevelSet& level_set) {
    std::vector<std::vector<Vec3d>> found(rays_.size());
    parallel_for(rays_.size(), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<SurfacePlace> places;
      for (std::size_t i = begin; i < end; ++i) {
        all_hits(level_set, rays_[i], places);
        for (const SurfacePlace& place : places) found[i].push_back(rays_[i].at(place.t));
      }
    });
    std::vector<Vec3d> places;
    for (const auto& of_ray : found) places.insert(places.end(), of_ray.begin(), of_ray.end());
    std::vector<double> errors = distances(places);
    double squares = 0;
    for (const double e : errors) squares += e * e;
    if (!errors.empty()) {
      row_.from_zero_set_rms = std::sqrt(squares / static_cast<double>(errors.size()));
      row_.farthest =
          places[static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin())];
    }
    row_.from_zero_set = error_statistics(std::move(errors));
  }

  void mesh_to_zero_set() {
    std::vector<double> errors(points_.size());
    parallel_for(points_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        errors[i] = std::fabs(probe_field(grid_, points_[i].position).value);
    });
    if (!errors.empty())
      row_.most_off =
          points_[static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin())]
              .position;
    row_.from_mesh = error_statistics(std::move(errors));
  }

  void signs() {
    Random random(settings_.seed + 1);
    const Box3d box = mesh_.report.bounds;
    std::vector<Vec3d> places;
    for (std::size_t i = 0; i < settings_.points; ++i) {
      Vec3d p;
      if (i % 2) { // anywhere in the box, or within 8 voxels of the surface
        for (int a = 0; a < 3; ++a) p[a] = box.min[a] + (box.max[a] - box.min[a]) * random.unit();
      } else {
        const SurfacePoint& on = points_[i % points_.size()];
        p = on.position + on.normal * (row_.voxel_size * 16 * (random.unit() - 0.5));
      }
      places.push_back(p);
    }
    const std::vector<double> away = distances(places);
    std::vector<char> wrong(places.size(), 0);
    parallel_for(places.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (away[i] > row_.voxel_size)
          wrong[i] = (winding_by_ray(bvh_, places[i]) != 0) != (probe_field(grid_, places[i]).value < 0);
    });
    for (std::size_t i = 0; i < places.size(); ++i) {
      row_.signs += away[i] > row_.voxel_size;
      row_.wrong_signs += wrong[i] != 0;
    }
  }

  // The true first place of a ray on the mesh against what the grid can prove about it. 1e-6 voxel is far
  // above what rounding does to either, some 2^-50 of the coordinates, and far below the field's error.
  void brackets(const LevelSet& level_set) {
    std::vector<Hit> hits(rays_.size());
    closest_hits(level_set, rays_, Exact::name, hits);
    std::vector<char> kept(rays_.size(), 0), known(rays_.size(), 0);
    parallel_for(rays_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SurfaceBracket bracket = bracket_original(level_set, rays_[i], hits[i]);
        const auto truth = bvh_.first_hit(rays_[i]);
        const double t = truth ? truth->t : rays_[i].t_max, rounding = 1e-6 * row_.voxel_size;
        kept[i] = t >= bracket.t_lo - rounding && t <= bracket.t_hi + rounding;
        known[i] = bracket.t_hi < std::numeric_limits<double>::infinity();
      }
    });
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      ++row_.brackets;
      row_.bracketed += known[i];
      row_.unbracketed += !kept[i];
    }
  }

  std::vector<double> distances(const std::vector<Vec3d>& places) const {
    std::vector<double> result(places.size());
    parallel_for(places.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) result[i] = distance(places[i]);
    });
    return result;
  }

  TradeRow trade_row(const std::string& method, bool is_normals) const {
    TradeRow row;
    row.resolution = row_.resolution, row.method = method, row.is_normals = is_normals;
    row.megabytes = row_.megabytes;
    return row;
  }

  void intersectors(const LevelSet& level_set) {
    std::vector<Hit> hits(rays_.size());
    exact_.resize(rays_.size());
    closest_hits(level_set, rays_, Exact::name, exact_);
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.trade.size();
    for (const std::string& name : method_names<Intersectors>()) {
      closest_hits(level_set, rays_, name, hits);
      TradeRow row = trade_row(name, false);
      row.lost = judge_against_grid(row_.voxel_size, exact_, hits).confusion.lost();
      std::vector<Vec3d> places;
      for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i]) places.push_back(rays_[i].at(hits[i].t));
      row.error = error_statistics(distances(places));
      result_.trade.push_back(row);
      works.push_back([this, &level_set, &hits, name] {
        in_batches(rays_.size(), [&](std::size_t begin, std::size_t count) {
          closest_hits(level_set, {&rays_[begin], count}, name, {&hits[begin], count});
        });
      });
    }
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); ++i)
      result_.trade[first + i].ns = times[i].median / static_cast<double>(rays_.size());
  }

  // Against the normal of the face nearest to the hit: facets of curved surfaces count as they are.
  void normals(const LevelSet& level_set) {
    std::vector<Vec3d> truth(rays_.size());
    double found = 0;
    for (std::size_t i = 0; i < exact_.size(); ++i)
      if (exact_[i]) {
        truth[i] =
            face_normal(mesh_.mesh, bvh_.closest_point(rays_[i].at(exact_[i].t))->triangle).normalized();
        found += 1;
      }
    std::vector<Vec3f> normals(rays_.size());
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.trade.size();
    for (const std::string& name : method_names<NormalSchemes>()) {
      hit_normals(level_set, rays_, exact_, name, normals);
      std::vector<double> angles;
      for (std::size_t i = 0; i < exact_.size(); ++i)
        if (exact_[i] && truth[i].length() > 0) {
          const Vec3d n(normals[i]);
          angles.push_back(std::atan2(truth[i].cross(n).length(), truth[i].dot(n)) * 180 /
                           3.14159265358979323846);
        }
      TradeRow row = trade_row(name, true);
      row.error = error_statistics(std::move(angles));
      result_.trade.push_back(row);
      works.push_back([this, &level_set, &normals, name] {
        in_batches(rays_.size(), [&](std::size_t begin, std::size_t count) {
          hit_normals(level_set, {&rays_[begin], count}, {&exact_[begin], count}, name,
                      {&normals[begin], count});
        });
      });
    }
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); ++i)
      result_.trade[first + i].ns = times[i].median / std::max(found, 1.0);
  }

  const PreparedMesh& mesh_;
  const TriangleBvh& bvh_;
  const std::vector<SurfacePoint>& points_;
  const MeshSuiteSettings& settings_;
  MeshSuiteResult& result_;
  const std::vector<WorldRay> rays_;
  BlockGrid grid_;
  SurfaceRow row_;
  std::vector<Hit> exact_;
};

} // namespace

MeshSuiteResult run_mesh_suite(const PreparedMesh& mesh, const MeshSuiteSettings& settings,
                               const std::function<void(double)>& progress) {
  MeshSuiteResult result;
  const TriangleBvh bvh(mesh.mesh);
  const std::vector<SurfacePoint> points = points_on(mesh.mesh, settings.points, settings.seed);
  double done = 0;
  for (const int resolution : settings.resolutions) {
    check_cancel();
    Round(mesh, bvh, points, resolution, settings, result).run();
    progress(++done / static_cast<double>(settings.resolutions.size()));
  }
  std::vector<double> voxel_sizes;
  for (const SurfaceRow& row : result.surfaces) voxel_sizes.push_back(row.voxel_size);
  result.thickness = thickness_of(bvh, points, mesh.report.bounds.size().length(), voxel_sizes);
  mark_front(result.trade);
  return result;
}

} // namespace levelray
