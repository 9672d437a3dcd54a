#include "levelray/io/soup_builder.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace levelray {

namespace {
constexpr std::uint32_t look_interval = 1 << 14;
constexpr std::uint64_t max_vertices = std::numeric_limits<std::uint32_t>::max();

// Coordinates written with six digits are off by up to 5e-6 of their size, and so is a corner from the plane
// it was meant to be in; half of that again comes from the plane's own corners. More than 1e-5 is bent.
constexpr double planar_tolerance = 1e-5;

bool finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Whether a triangle's area cannot be told from 0. An edge's component has a relative error of 2^-53, a
// product of two 3 * 2^-53, their difference another 2^-53 of itself: together below 8 * 2^-53 of |e||f|.
bool without_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d e = b - a, f = c - a, n = e.cross(f);
  const double bound = 0x1p-50 * e.length() * f.length();
  return std::abs(n.x) <= bound && std::abs(n.y) <= bound && std::abs(n.z) <= bound;
}
} // namespace

SoupBuilder::SoupBuilder(MeshSource& source, const MeshReadOptions& options)
    : source_(source), options_(options) {}

void SoupBuilder::reserve(std::uint64_t vertices, std::uint64_t triangles) {
  const double bytes = double(vertices) * sizeof(Vec3d) + double(triangles) * sizeof(Triangle);
  if (bytes > double(options_.max_memory))
    source_.fail_limit(fmt::format("the mesh needs about {}, the limit is {}; raise --max-memory",
                                   bytes_text(bytes), bytes_text(double(options_.max_memory))));
  mesh_.vertices.reserve(static_cast<std::size_t>(vertices));
  mesh_.triangles.reserve(static_cast<std::size_t>(triangles));
}

void SoupBuilder::look_around() {
  until_look_ = look_interval;
  check_cancel();
  const double bytes =
      double(mesh_.vertices.size()) * sizeof(Vec3d) + double(mesh_.triangles.size()) * sizeof(Triangle) +
      double(deferred_.size()) * sizeof(Deferred) + double(deferred_corners_.size()) * sizeof(std::uint64_t);
  if (bytes > double(options_.max_memory))
    source_.fail_limit(fmt::format("the mesh needs more than the limit of {}; raise --max-memory",
                                   bytes_text(double(options_.max_memory))));
  if (mesh_.vertices.size() + look_interval > max_vertices)
    source_.fail_limit("more than 4294967295 vertices; split the mesh");
}

void SoupBuilder::add_vertex(double x, double y, double z, const char* at) {
  if (until_look_-- == 0) look_around();
  const Vec3d position(x + 0.0, y + 0.0, z + 0.0); // -0 + 0 is +0
  if (!finite(position)) {
    if (!options_.drop_bad)
      source_.fail(at,
                   "non-finite coordinate (nan, inf or too large); --drop-bad drops the faces that use it");
    bad_vertices_.add(at);
  }
  mesh_.vertices.push_back(position);
}

void SoupBuilder::push_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (until_look_-- == 0) look_around();
  mesh_.triangles.push_back({a, b, c});
}

bool SoupBuilder::is_bad(std::uint32_t vertex) const {
  return !finite(mesh_.vertices[vertex]);
}

void SoupBuilder::add_strip_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == b || b == c || c == a) return;
  if (bad_vertices_.number != 0 && (is_bad(a) || is_bad(b) || is_bad(c)))
    dropped_faces_.add(bad_vertices_.first);
  else
    push_triangle(a, b, c);
}

void SoupBuilder::add_polygon(const std::vector<std::uint64_t>& corners, const char* at) {
  bool known = true;
  for (const std::uint64_t corner : corners) known = known && corner < mesh_.vertices.size();
  if (!known) {
    if (until_look_-- == 0) look_around();
    deferred_.push_back({at, deferred_corners_.size()});
    deferred_corners_.insert(deferred_corners_.end(), corners.begin(), corners.end());
    return;
  }
  corners_.clear();
  for (const std::uint64_t corner : corners) corners_.push_back(static_cast<std::uint32_t>(corner));
  add_known_polygon(at);
}

void SoupBuilder::add_known_polygon(const char* at) {
  if (corners_.size() < 3) return short_faces_.add(at);
  if (bad_vertices_.number != 0)
    for (const std::uint32_t corner : corners_)
      if (is_bad(corner)) return dropped_faces_.add(at);

  // Remove corners that repeat the one before them, around the end too.
  const std::size_t before = corners_.size();
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  while (corners_.size() > 1 && corners_.back() == corners_.front()) corners_.pop_back();
  if (corners_.size() != before) repeated_corners_.add(at);
  if (corners_.size() < 3) return;
  if (corners_.size() == 3) return push_triangle(corners_[0], corners_[1], corners_[2]);

  points_.clear();
  double magnitude = 0;
  for (const std::uint32_t corner : corners_) {
    const Vec3d& p = mesh_.vertices[corner];
    points_.push_back(p);
    magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  const PolygonTriangulator::Result result = triangulator_.triangulate(points_, pieces_);
  if (triangulator_.work() > PolygonTriangulator::max_work)
    source_.fail_limit("its polygons have too many corners to triangulate; triangulate the mesh before");
  if (!result.simple) not_simple_.add(at);
  if (result.deviation > planar_tolerance * magnitude) {
    if (result.deviation > largest_deviation_) {
      largest_deviation_ = result.deviation;
      not_planar_.first = at;
    }
    ++not_planar_.number;
  }
  for (const Triangle& piece : pieces_) {
    const std::uint32_t a = corners_[piece[0]], b = corners_[piece[1]], c = corners_[piece[2]];
    if (a != b && b != c && c != a) push_triangle(a, b, c);
  }
}

void SoupBuilder::truncated(const char* at, const std::string& reason) {
  if (!options_.salvage) source_.fail(at, reason + "; --salvage takes what is there");
  cut_ = true;
  warn(source_.place(at) + ": " + reason + "; what is there was taken");
}

void SoupBuilder::add_deferred() {
  for (std::size_t i = 0; i < deferred_.size(); ++i) {
    const std::size_t stop =
        i + 1 < deferred_.size() ? deferred_[i + 1].first_corner : deferred_corners_.size();
    corners_.clear();
    bool lost = false;
    for (std::size_t k = deferred_[i].first_corner; k < stop; ++k) {
      const std::uint64_t corner = deferred_corners_[k];
      lost = corner >= mesh_.vertices.size();
      if (lost && cut_) break; // its vertices were cut off
      if (lost)
        source_.fail(deferred_[i].at,
                     fmt::format("vertex index {}, file has {} vertices", corner + 1, mesh_.vertices.size()));
      corners_.push_back(static_cast<std::uint32_t>(corner));
    }
    if (lost)
      lost_faces_.add(deferred_[i].at);
    else
      add_known_polygon(deferred_[i].at);
  }
}

// Compacts the vertices, so that the mesh holds finite ones only.
void SoupBuilder::drop_bad_vertices() {
  std::vector<std::uint32_t> moved(mesh_.vertices.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = kept;
    if (finite(mesh_.vertices[i])) mesh_.vertices[kept++] = mesh_.vertices[i];
  }
  mesh_.vertices.resize(kept);
  for (Triangle& t : mesh_.triangles)
    for (std::uint32_t& v : t) v = moved[v];
}

void SoupBuilder::remark(const Count& count, const char* one, const char* many) {
  if (count.number == 0) return;
  const std::string place = count.first == nullptr ? source_.name() : source_.place(count.first);
  warn(count.number == 1 ? fmt::format("{}: 1 {}", place, one)
                         : fmt::format("{}: {} {}, the first one here", place, count.number, many));
}

void SoupBuilder::write_remarks() {
  remark(bad_vertices_, "vertex with a non-finite coordinate dropped",
         "vertices with non-finite coordinates dropped");
  remark(dropped_faces_, "face with a non-finite corner dropped", "faces with non-finite corners dropped");
  remark(lost_faces_, "face dropped with the vertices that were cut off",
         "faces dropped with the vertices that were cut off");
  remark(short_faces_, "face with fewer than three corners skipped",
         "faces with fewer than three corners skipped");
  remark(repeated_corners_, "face repeats a vertex; left out as far as it has no area",
         "faces repeat a vertex; left out as far as they have no area");
  remark(not_simple_, "polygon crosses itself; triangulated as a fan",
         "polygons cross themselves; triangulated as fans");
  if (not_planar_.number != 0)
    warn(fmt::format("{}: {} {} not planar, the most here: a corner is {:.3g} off its plane",
                     source_.place(not_planar_.first), not_planar_.number,
                     not_planar_.number == 1 ? "polygon is" : "polygons are", largest_deviation_));

  // Triangles without area: kept, because distances to them are right; counted, because signs need to know.
  std::uint64_t flat = 0;
  for (const Triangle& t : mesh_.triangles)
    if (without_area(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]])) ++flat;
  if (flat != 0)
    warn(fmt::format("{}: {} without area (corners in a line or at one place)", source_.name(),
                     flat == 1 ? std::string("1 triangle is") : fmt::format("{} triangles are", flat)));
}

MeshFile SoupBuilder::finish(const std::string& format, const std::string& format_name) {
  add_deferred();
  if (mesh_.triangles.empty()) {
    if (mesh_.vertices.empty())
      source_.fail(fmt::format("no vertices or faces found; is this {}?", format_name));
    if (dropped_faces_.number != 0) source_.fail("every face has a non-finite corner; nothing is left");
    if (short_faces_.number + repeated_corners_.number != 0)
      source_.fail(
          fmt::format("{} vertices, but no face has three different corners", mesh_.vertices.size()));
    source_.fail(fmt::format("{} vertices, no faces; {} no surface to convert", mesh_.vertices.size(),
                             other_content_.empty() ? "a point cloud has" : other_content_ + " make"));
  }
  if (bad_vertices_.number != 0) drop_bad_vertices();
  write_remarks();
  MeshFile file;
  file.mesh = std::move(mesh_);
  file.format = format;
  file.warnings = std::move(warnings_);
  return file;
}

} // namespace levelray
