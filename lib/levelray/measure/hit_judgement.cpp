#include "levelray/measure/hit_judgement.hpp"

#include <cassert>
#include <cmath>

namespace levelray {

namespace {

constexpr int places = 256;

// Whether the shape's first stretch is nowhere deeper than the interpolation error.
bool only_grazed(const SampledReference& reference, const WorldRay& ray, const Chord& chord) {
  for (int i = 0; i <= places; ++i) {
    const Vec3d p = ray.at(chord.enter + (chord.exit - chord.enter) * (static_cast<double>(i) / places));
    if (reference.shape->value(p) < -reference.error(p)) return false;
  }
  return true;
}

} // namespace

Judgement judge_against_shape(const SampledReference& reference, std::span<const WorldRay> rays,
                              std::span<const Chord> chords, std::span<const Hit> hits) {
  assert(rays.size() == chords.size() && rays.size() == hits.size());
  Judgement result;
  Confusion& confusion = result.confusion;
  const double diagonal = std::sqrt(3.0) * reference.voxel_size;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Chord& chord = chords[i];
    const Hit& hit = hits[i];
    if (chord.kind == Chord::Kind::undecided) {
      ++confusion.undecided;
      continue;
    }
    if (!chord && !hit) {
      ++confusion.misses;
      continue;
    }
    if (!hit) {
      ++(only_grazed(reference, rays[i], chord) ? confusion.unresolved : confusion.leaks);
      continue;
    }
    const Vec3d p = rays[i].at(hit.t);
    const double value = std::fabs(reference.shape->value(p));
    if (!chord || hit.t < chord.enter - diagonal) {
      std::uint64_t& fault = chord ? confusion.wrong : confusion.phantoms;
      ++(value <= reference.error(p) ? confusion.unresolved : fault);
      continue;
    }
    if (hit.t > chord.exit) {
      ++(only_grazed(reference, rays[i], chord) ? confusion.unresolved : confusion.wrong);
      continue;
    }
    ++confusion.hits;
    result.t_errors_voxels.push_back(std::fabs(hit.t - chord.enter) / reference.voxel_size);
    result.distance_errors_voxels.push_back(value / reference.voxel_size);
  }
  return result;
}

Judgement judge_against_grid(double voxel_size, std::span<const Hit> exact, std::span<const Hit> hits) {
  assert(exact.size() == hits.size());
  Judgement result;
  Confusion& confusion = result.confusion;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!exact[i] || !hits[i]) {
      ++(exact[i] ? confusion.leaks : hits[i] ? confusion.phantoms : confusion.misses);
      continue;
    }
    const double error = std::fabs(hits[i].t - exact[i].t) / voxel_size;
    if (error > std::sqrt(3.0)) {
      ++confusion.wrong;
      continue;
    }
    ++confusion.hits;
    result.t_errors_voxels.push_back(error);
  }
  return result;
}

std::vector<double> normal_errors_degrees(const Reference& shape, std::span<const WorldRay> rays,
                                          std::span<const Hit> hits, std::span<const Vec3f> normals) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const Vec3d truth = shape.gradient(rays[i].at(hits[i].t)), normal(normals[i]);
    angles.push_back(std::atan2(truth.cross(normal).length(), truth.dot(normal)) * 180 /
                     3.14159265358979323846);
  }
  return angles;
}

} // namespace levelray
