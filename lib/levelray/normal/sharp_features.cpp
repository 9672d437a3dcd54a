#include "levelray/normal/sharp_features.hpp"

#include "levelray/normal/offset_differences.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

constexpr float smooth_ratio = 0.2f;   // of second to first differences, at most, where nothing is sharp
constexpr float flat_ratio = 0.01f;    // of what a plane is off by to the largest second difference, at most
constexpr int supporters = 12;         // samples that lie on a plane, at least
constexpr int supporters_alone = 28;   // where there is no other plane
constexpr float other_cosine = 0.9f;   // of the angle between planes, at most, that make a crease
constexpr float reach_voxels = 0.6f;   // from the hit to its plane, at most
constexpr float same_cosine = 0.9999f; // of planes that are the same, at least, if ...
constexpr float same_voxels = 1e-2f;   // ... they are this near each other at the hit
constexpr int most_planes = 8;         // more are no crease

// The largest |first| and |second| differences in the 12 rows of four samples through the cell.
struct RowDifferences {
  float first = 0, second = 0;

  explicit RowDifferences(const Neighbourhood& f) {
    for (int q = 0; q < 2; ++q)
      for (int p = 0; p < 2; ++p) {
        add(f.at(-1, p, q), f.at(0, p, q), f.at(1, p, q), f.at(2, p, q));
        add(f.at(p, -1, q), f.at(p, 0, q), f.at(p, 1, q), f.at(p, 2, q));
        add(f.at(p, q, -1), f.at(p, q, 0), f.at(p, q, 1), f.at(p, q, 2));
      }
  }
  void add(float a, float b, float c, float d) {
    const float x = b - a, y = c - b, z = d - c;
    first = std::max({first, std::fabs(x), std::fabs(y), std::fabs(z)});
    second = std::max({second, std::fabs(y - x), std::fabs(z - y)});
  }
};

// f = value + gradient . (p - hit).
struct Plane {
  float value, gradient[3];
  float slope = 0; // |gradient|
  int samples = 0; // that lie on it

  float distance() const { return std::fabs(value) / slope; } // from the hit, voxels
  float cosine(const Plane& other) const {
    return (gradient[0] * other.gradient[0] + gradient[1] * other.gradient[1] +
            gradient[2] * other.gradient[2]) /
           (slope * other.slope);
  }
};

// Whether the cell with lowest corner (i,j,k) is flat within `tolerance`; its plane then.
bool flat_cell(const Neighbourhood& f, int i, int j, int k, const float (&hit)[3], float tolerance,
               Plane& plane) {
  const float v0 = f.at(i, j, k), v1 = f.at(i + 1, j, k), v2 = f.at(i, j + 1, k), v3 = f.at(i + 1, j + 1, k);
  if (!(std::fabs((v3 - v2) - (v1 - v0)) <= tolerance)) return false;
  const float v4 = f.at(i, j, k + 1), v5 = f.at(i + 1, j, k + 1), v6 = f.at(i, j + 1, k + 1),
              v7 = f.at(i + 1, j + 1, k + 1);
  const auto flat = [&](float a, float b, float c, float d) {
    return std::fabs((d - c) - (b - a)) <= tolerance;
  };
  if (!(flat(v4, v5, v6, v7) && flat(v0, v1, v4, v5) && flat(v2, v3, v6, v7) && flat(v0, v2, v4, v6) &&
        flat(v1, v3, v5, v7)))
    return false;
  const float low_x = (v0 + v2) + (v4 + v6), high_x = (v1 + v3) + (v5 + v7);
  plane.gradient[0] = (high_x - low_x) * 0.25f;
  plane.gradient[1] = (((v2 + v3) + (v6 + v7)) - ((v0 + v1) + (v4 + v5))) * 0.25f;
  plane.gradient[2] = (((v4 + v5) + (v6 + v7)) - ((v0 + v1) + (v2 + v3))) * 0.25f;
  const int corner[3] = {i, j, k};
  plane.value = (low_x + high_x) * 0.125f;
  for (int a = 0; a < 3; ++a)
    plane.value += plane.gradient[a] * (hit[a] - (static_cast<float>(corner[a]) + 0.5f));
  return true;
}

int samples_on(const Plane& plane, const Neighbourhood& f, const float (&hit)[3], float tolerance) {
  int count = 0;
  for (int k = -1; k < 3; ++k)
    for (int j = -1; j < 3; ++j) {
      const float row = plane.value + plane.gradient[1] * (static_cast<float>(j) - hit[1]) +
                        plane.gradient[2] * (static_cast<float>(k) - hit[2]);
      for (int i = -1; i < 3; ++i)
        count += std::fabs(row + plane.gradient[0] * (static_cast<float>(i) - hit[0]) - f.at(i, j, k)) <=
                 tolerance;
    }
  return count;
}

} // namespace

Vec3d SharpFeatures::gradient(const Neighbourhood& f, const CellPosition& at) {
  const RowDifferences differences(f);
  if (!(differences.second > smooth_ratio * differences.first)) return OffsetDifferences::gradient(f, at);

  // Find the planes around.
  const float hit[3] = {static_cast<float>(at.local[0]), static_cast<float>(at.local[1]),
                        static_cast<float>(at.local[2])};
  const float tolerance = flat_ratio * differences.second;
  Plane planes[most_planes];
  int count = 0;
  for (int k = -1; k < 2 && count < most_planes; ++k)
    for (int j = -1; j < 2 && count < most_planes; ++j)
      for (int i = -1; i < 2 && count < most_planes; ++i) {
        Plane plane;
        if (!flat_cell(f, i, j, k, hit, tolerance, plane)) continue;
        const float* const g = plane.gradient;
        plane.slope = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
        if (!(plane.slope > tolerance)) continue; // a plateau, such as beyond the band
        const bool known = std::any_of(planes, planes + count, [&](const Plane& other) {
          return plane.cosine(other) >= same_cosine &&
                 std::fabs(plane.value / plane.slope - other.value / other.slope) <= same_voxels;
        });
        if (known) continue;
        plane.samples = samples_on(plane, f, hit, tolerance);
        if (plane.samples >= supporters) planes[count++] = plane;
      }

  // Choose the nearest, and see whether it is one side of a crease.
  const Plane* const nearest = std::min_element(
      planes, planes + count, [](const Plane& a, const Plane& b) { return a.distance() < b.distance(); });
  if (count > 0 && nearest->distance() <= reach_voxels &&
      (nearest->samples >= supporters_alone || std::any_of(planes, planes + count, [&](const Plane& other) {
         return other.cosine(*nearest) <= other_cosine;
       })))
    return Vec3d(nearest->gradient[0], nearest->gradient[1], nearest->gradient[2]);
  return OffsetDifferences::gradient(f, at);
}

} // namespace levelray
