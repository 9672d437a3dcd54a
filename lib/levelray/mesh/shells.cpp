#include "levelray/mesh/shells.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/mesh/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace levelray {

namespace {

// An open shell whose capped volume is below this part of a ball's with its area has no inside to speak of:
// terrain, cloth. Its direction is left as it is.
constexpr double sheet = 0.01;

// On each shell, to be found inside of another. More would catch smaller parts that stick out.
constexpr int samples_per_shell = 3;

// No two of a mesh's faces are likely to be parallel to these.
const Vec3d directions[3] = {{0.5380, 0.3719, 0.7564}, {-0.8171, 0.2113, 0.5364}, {0.1291, -0.9507, -0.2817}};

// Points on each shell, one inside of a triangle each: of the largest, and of others spread over the list.
std::vector<std::vector<Vec3d>> sample_shells(const TriangleMesh& mesh,
                                              const std::vector<std::uint32_t>& shell_of,
                                              std::uint32_t shell_count) {
  std::vector<std::uint32_t> size(shell_count, 0), seen(shell_count, 0), largest(shell_count, no_index);
  std::vector<double> area(shell_count, -1);
  const auto corner = [&](std::uint32_t t, int k) -> const Vec3d& {
    return mesh.vertices[mesh.triangles[t][k]];
  };
  const auto area_of = [&](std::uint32_t t) {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).length();
  };
  for (std::uint32_t t = 0; t < shell_of.size(); ++t) {
    const std::uint32_t s = shell_of[t];
    ++size[s];
    if (area_of(t) > area[s]) area[s] = area_of(t), largest[s] = t;
  }
  std::vector<std::vector<Vec3d>> samples(shell_count);
  const auto middle = [&](std::uint32_t t) { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3; };
  for (std::uint32_t s = 0; s < shell_count; ++s) samples[s].push_back(middle(largest[s]));
  for (std::uint32_t t = 0; t < shell_of.size(); ++t) {
    const std::uint32_t s = shell_of[t];
    const std::uint32_t stride = std::max(1u, size[s] / samples_per_shell);
    if (seen[s]++ % stride == 0 && samples[s].size() < samples_per_shell && area_of(t) > 0)
      samples[s].push_back(middle(t));
  }
  return samples;
}

// Adds the winding numbers of all shells at p, as seen along one direction: the ray leaves a shell where it
// runs along the normal. For closed shells every direction tells the same.
void add_windings(const TriangleBvh& bvh, const std::vector<std::uint32_t>& shell_of, const Vec3d& p,
                  const Vec3d& direction, std::vector<std::pair<std::uint32_t, int>>& windings) {
  WorldRay ray;
  ray.origin = p;
  ray.direction = direction;
  bvh.all_hits(ray, [&](const TriangleHit& hit) {
    const std::uint32_t s = shell_of[hit.triangle];
    const auto at = std::lower_bound(windings.begin(), windings.end(), std::pair(s, -(1 << 30)));
    if (at != windings.end() && at->first == s)
      at->second += hit.front ? -1 : 1;
    else
      windings.insert(at, {s, hit.front ? -1 : 1});
  });
}

// For each shell the shells that it lies in: all its samples are inside, and its box is in theirs.
std::vector<std::vector<std::uint32_t>> find_containers(const TriangleMesh& mesh,
                                                        const std::vector<std::uint32_t>& shell_of,
                                                        const std::vector<Shell>& shells) {
  std::vector<std::vector<std::uint32_t>> containers(shells.size());
  const auto may_hold = [&](std::uint32_t outer, std::uint32_t inner) {
    return outer != inner && shells[outer].sign != 0 &&
           shells[outer].bounds.intersects(shells[inner].bounds.min) &&
           shells[outer].bounds.intersects(shells[inner].bounds.max);
  };
  const auto count = static_cast<std::uint32_t>(shells.size());
  if (count <= 256) { // often no box is in another, and no tree is needed
    bool any = false;
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t j = 0; j < count; ++j) any |= may_hold(i, j);
    if (!any) return containers;
  }

  const TriangleBvh bvh(mesh);
  const auto samples = sample_shells(mesh, shell_of, count);
  std::vector<std::uint32_t> open;
  for (std::uint32_t s = 0; s < count; ++s)
    if (shells[s].open) open.push_back(s);
  parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<std::uint32_t, int>> windings;
    for (auto s = static_cast<std::uint32_t>(begin); s < end; ++s) {
      // For closed shells one ray tells exactly; in an open one we are where the mean over directions is
      // above 1/2.
      const bool maybe_in_open =
          open.size() > 64 || std::any_of(open.begin(), open.end(), [&](auto o) { return may_hold(o, s); });
      const int rays = maybe_in_open ? 3 : 1;
      for (const Vec3d& p : samples[s]) {
        windings.clear();
        for (int i = 0; i < rays; ++i) add_windings(bvh, shell_of, p, directions[i], windings);
        std::vector<std::uint32_t> inside;
        for (const auto& [outer, sum] : windings)
          if (2 * std::abs(sum) > rays && may_hold(outer, s)) inside.push_back(outer);
        if (&p == &samples[s].front())
          containers[s] = std::move(inside);
        else
          std::erase_if(containers[s], [&](std::uint32_t outer) {
            return !std::binary_search(inside.begin(), inside.end(), outer);
          });
        if (containers[s].empty()) break;
      }
    }
  });
  return containers;
}

// Calls add(t, sums) for every triangle, with sums[s] the shells' accumulators, and returns their totals.
// Chunks depend on the mesh alone, so that the totals' bits do not depend on threads.
template <class Sum, class Add>
std::vector<Sum> sum_up(std::size_t triangle_count, std::size_t shell_count, Add&& add) {
  const std::size_t grain = shell_count <= 64 ? 65536 : triangle_count;
  std::vector<std::vector<Sum>> parts((triangle_count + grain - 1) / grain, std::vector<Sum>(shell_count));
  parallel_for(triangle_count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) add(t, parts[begin / grain]);
  });
  for (std::size_t i = 1; i < parts.size(); ++i)
    for (std::size_t s = 0; s < shell_count; ++s) parts[0][s] += parts[i][s];
  return std::move(parts[0]);
}

struct BoxSum {
  Box3d box;
  void operator+=(const BoxSum& other) { box.extendBy(other.box); }
};

struct VolumeSum {
  double volume = 0, lost = 0; // compensated (Neumaier 1974, algorithm IV)
  double magnitude = 0, area = 0;
  void add(double term) {
    const double next = volume + term;
    lost += std::abs(volume) >= std::abs(term) ? (volume - next) + term : (term - next) + volume;
    volume = next;
  }
  void operator+=(const VolumeSum& other) {
    add(other.volume);
    lost += other.lost, magnitude += other.magnitude, area += other.area;
  }
};

// Signed volumes, each relative to a point of its own: the centroid of the boundary caps open shells, and for
// closed ones the middle of the box keeps digits far from the origin.
void measure_volumes(const TriangleMesh& mesh, const EdgeTable& edges,
                     const std::vector<std::uint32_t>& shell_of, std::vector<Shell>& shells) {
  const auto boxes =
      sum_up<BoxSum>(mesh.triangles.size(), shells.size(), [&](std::size_t t, std::vector<BoxSum>& sums) {
        for (const std::uint32_t v : mesh.triangles[t]) sums[shell_of[t]].box.extendBy(mesh.vertices[v]);
      });
  for (std::size_t s = 0; s < shells.size(); ++s) shells[s].bounds = boxes[s].box;

  std::vector<Vec3d> centroid(shells.size(), Vec3d(0)); // relative to the box's middle
  std::vector<double> weight(shells.size(), 0);
  for (const OpenEdge& open : find_boundary_chain(mesh.triangles, edges)) {
    const std::uint32_t h = edges.of(open.edge)[0], s = shell_of[h / 3];
    const Vec3d middle = shells[s].bounds.center();
    const Vec3d a = mesh.vertices[edge_start(mesh.triangles, h)] - middle;
    const Vec3d b = mesh.vertices[edge_end(mesh.triangles, h)] - middle;
    const double length = (b - a).length() * std::abs(open.excess);
    centroid[s] += (a + b) * (0.5 * length);
    weight[s] += length;
    shells[s].open = true;
  }
  for (std::size_t s = 0; s < shells.size(); ++s)
    centroid[s] = shells[s].bounds.center() + (weight[s] > 0 ? centroid[s] / weight[s] : Vec3d(0));

  const auto volumes = sum_up<VolumeSum>(
      mesh.triangles.size(), shells.size(), [&](std::size_t t, std::vector<VolumeSum>& sums) {
        const std::uint32_t s = shell_of[t];
        const Vec3d& corner = mesh.vertices[mesh.triangles[t][0]];
        const Vec3d a = corner - centroid[s];
        const Vec3d u = mesh.vertices[mesh.triangles[t][1]] - corner,
                    v = mesh.vertices[mesh.triangles[t][2]] - corner;
        const Vec3d n = u.cross(v);
        sums[s].add(a.dot(n) / 6);
        sums[s].magnitude += std::sqrt(a.length2() * u.length2()) * v.length() / 6;
        if (shells[s].open) sums[s].area += n.length() / 2;
      });
  for (std::size_t s = 0; s < shells.size(); ++s) {
    // Each term a.n carries at most ten roundings of at most |a||u||v|; the compensated sum adds one.
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * volumes[s].magnitude;
    const double ball = std::pow(volumes[s].area, 1.5) / (6 * std::sqrt(std::numbers::pi));
    const double volume = shells[s].volume = volumes[s].volume + volumes[s].lost;
    if (!(std::abs(volume) > rounding) || (shells[s].open && !(std::abs(volume) > sheet * ball))) continue;
    shells[s].sign = volume > 0 ? 1 : -1;
  }
}

} // namespace

std::vector<Shell> measure_shells(const TriangleMesh& mesh, const EdgeTable& edges,
                                  const std::vector<std::uint32_t>& shell_of, std::uint32_t shell_count,
                                  const std::vector<bool>& repaired) {
  std::vector<Shell> shells(shell_count);
  measure_volumes(mesh, edges, shell_of, shells);
  if (std::none_of(shells.begin(), shells.end(), [](const Shell& s) { return s.sign < 0; })) return shells;
  const auto containers = find_containers(mesh, shell_of, shells);

  // From the outermost in: a shell has more containers than each of those it lies in.
  std::vector<std::uint32_t> order(shell_count);
  for (std::uint32_t s = 0; s < shell_count; ++s) order[s] = s;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return containers[a].size() < containers[b].size();
  });
  for (const std::uint32_t s : order) {
    int around = 0;
    std::uint32_t parent = no_index;
    for (const std::uint32_t outer : containers[s]) {
      around += shells[outer].turn ? -shells[outer].sign : shells[outer].sign;
      if (parent == no_index || containers[outer].size() > containers[parent].size()) parent = outer;
    }
    shells[s].turn = parent != no_index && shells[parent].turn && !repaired[s];
    const int sign = shells[s].turn ? -shells[s].sign : shells[s].sign;
    if (around + sign < 0) shells[s].turn = !shells[s].turn;
  }
  return shells;
}

} // namespace levelray
