#include "levelray/convert/triangle_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

// Any unit vector perpendicular to the unit vector `e`.
Vec3d perpendicular(const Vec3d& e) {
  const Vec3d axis = std::abs(e.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d n = e.cross(axis);
  return n / n.length();
}

void store(float (&out)[4], const Vec3d& gradient, double at_center) {
  out[0] = static_cast<float>(gradient.x);
  out[1] = static_cast<float>(gradient.y);
  out[2] = static_cast<float>(gradient.z);
  out[3] = static_cast<float>(at_center);
}

} // namespace

TriangleFrame make_triangle_frame(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& node_center,
                                  double reach) {
  // Work relative to the node's centre from the start: one subtraction of nearby or exactly representable
  // numbers.
  Vec3d v[3] = {a - node_center, b - node_center, c - node_center};
  Vec3d edge[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  const double squared[3] = {edge[0].dot(edge[0]), edge[1].dot(edge[1]), edge[2].dot(edge[2])};
  const int longest =
      squared[1] > squared[0] ? (squared[2] > squared[1] ? 2 : 1) : (squared[2] > squared[0] ? 2 : 0);
  const double length = std::sqrt(squared[longest]);

  // The normal from the two shorter edges, whose directions differ most from each other where it matters.
  const Vec3d cross = edge[(longest + 1) % 3].cross(edge[(longest + 2) % 3]);
  const double area2 = cross.length();

  // A triangle lower than 1e-6 voxel is its longest edge: no point of it is farther than that from the edge.
  TriangleFrame frame;
  const bool flat = !(area2 > 1e-6 * length);
  Vec3d n;
  if (flat) {
    const Vec3d e = length > 0 ? edge[longest] / length : Vec3d(1, 0, 0);
    n = perpendicular(e);
  } else {
    n = cross / area2;
  }
  frame.threshold = flat ? std::numeric_limits<float>::infinity() : 0.0f;

  store(frame.plane, n, -n.dot(v[longest]));
  for (int i = 0; i < 3; ++i) {
    const int from = flat ? longest : i;
    const double edge_length = std::sqrt(squared[from]);
    const Vec3d e = edge_length > 0 ? edge[from] / edge_length : Vec3d(1, 0, 0);
    const Vec3d w = n.cross(e);
    store(frame.inward[i], w, -w.dot(v[from]));

    // Clip the edge to +-reach around the centre's foot on its line; what lies beyond is too far away to
    // matter.
    const double start = e.dot(v[from]); // of the edge, along e, from the centre's foot
    const double lo = std::clamp(start, -reach, reach);
    const double hi = std::clamp(start + edge_length, -reach, reach);
    store(frame.along[i], e, -(lo + hi) / 2);
    frame.half[i] = static_cast<float>((hi - lo) / 2);
  }
  return frame;
}

} // namespace levelray
