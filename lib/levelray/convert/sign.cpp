#include "levelray/convert/sign.hpp"

#include <bit>
#include <cmath>

namespace levelray {

namespace {

constexpr double half_node = (node_dim - 1) / 2.0;
constexpr double node_radius = half_node * 1.7320508075688773;
constexpr double block_radius = 1.5 * 1.7320508075688773;

// Whether a generalised winding number means inside.
bool is_inside(double winding, SignMethod method) {
  return (method == SignMethod::winding_abs ? std::abs(winding) : winding) > 0.5;
}

// Whether is_inside(w - c) is the same for all c within `slack` of `cap_winding`, for every integer w: no
// half-integer is that near.
bool decided(double cap_winding, double slack) {
  return std::abs(cap_winding - 0.5 - std::round(cap_winding - 0.5)) > slack;
}

// The caps' winding number at a sample, as exactly as the decision needs it. Among very many caps the finest
// estimate must do.
double cap_winding_at(const BoundaryWinding& boundary, const Vec3i& sample) {
  const Vec3d p(sample.x, sample.y, sample.z);
  for (const double accepted : {1e-2, 1e-3}) {
    const BoundaryWinding::Estimate estimate = boundary.estimate(p, accepted);
    if (decided(estimate.value, estimate.error) || (boundary.many() && accepted < 1e-2))
      return estimate.value;
  }
  return boundary.exact(p);
}

// The caps' winding number in a ball, and whether that one value decides for all of it.
struct BallWinding {
  double value = 0;
  bool decided = true;
};

// `center` and `radius` in voxels, of a ball that no cap meets.
//
// Very many caps are the pieces of a surface that is cracked everywhere. Their winding number is nearly
// constant away from them because they cancel, which no bound on their sum shows; there the value at the
// centre decides when it is `margin` away from one half. The margins are judgements, not bounds: a cracked
// surface is near 0 or 1 off the surface, and what is wider open goes on to smaller balls and to samples.
BallWinding cap_winding_around(const BoundaryWinding& boundary, const Vec3d& center, double radius,
                               double margin) {
  if (boundary.empty()) return {};
  const BoundaryWinding::Estimate estimate = boundary.estimate(center);
  if (boundary.many()) return {estimate.value, decided(estimate.value, margin)};
  return {estimate.value, decided(estimate.value, estimate.error + boundary.variation(center, radius))};
}

} // namespace

SheetCounting counting_for(SignMethod method) {
  switch (method) {
  case SignMethod::flood:
    return SheetCounting::touching;
  case SignMethod::pseudonormal:
  case SignMethod::unsigned_distance:
    return SheetCounting::none;
  default:
    return SheetCounting::windings;
  }
}

NodeSides node_sides(const Band& band, const Regions& regions, const BoundaryWinding& boundary,
                     SignMethod method, std::size_t n) {
  NodeSides sides;
  if (method == SignMethod::unsigned_distance) return sides;
  const std::int32_t index = band.node_at[n];
  const NodeBand* node = index == Band::untouched ? nullptr : &band.nodes[static_cast<std::size_t>(index)];
  const std::uint32_t first_id = regions.first_id[n];

  if (method == SignMethod::flood || method == SignMethod::pseudonormal) {
    const auto inside = [&](std::uint32_t id) {
      return !regions.connected_to_outside(id) &&
             (method == SignMethod::flood || regions.votes[regions.set[id]] > 0);
    };
    if (!node) {
      sides.inside = inside(first_id);
      return sides;
    }
    sides.blocks.assign(64, 0);
    for (std::size_t block = 0; block < 64; ++block)
      for (const BlockComponent& c : node->side(static_cast<int>(block)).components)
        if (inside(first_id + c.node_component)) sides.blocks[block] |= c.samples;
    return sides;
  }

  // Windings: the integer of mesh and caps, less the caps' own.
  const auto winding = [&](const BlockComponent& c) {
    return regions.winding_number(first_id + c.node_component) + c.winding;
  };
  const BlockComponent whole{~std::uint64_t{0}, 0, 0};
  const Vec3i first_sample = band.box.coord(n) * node_dim;
  const Vec3d center =
      Vec3d(first_sample.x + half_node, first_sample.y + half_node, first_sample.z + half_node);

  // One look at the whole node, where no cap is in it.
  const bool node_smooth = !node || !node->near_cap;
  const BallWinding node_caps =
      node_smooth ? cap_winding_around(boundary, center, node_radius, 0.3) : BallWinding{0, false};
  if (!node && node_caps.decided) {
    sides.inside = is_inside(winding(whole) - node_caps.value, method);
    return sides;
  }

  sides.blocks.assign(64, 0);
  for (std::size_t block = 0; block < 64; ++block) {
    const BlockSide side = node ? node->side(static_cast<int>(block)) : BlockSide{nullptr, {&whole, 1}};
    const int b = static_cast<int>(block);
    const Vec3i block_first = first_sample + Vec3i(bit_x(b), bit_y(b), bit_z(b)) * block_dim;
    BallWinding caps = node_caps;
    if (!caps.decided && (node_smooth || !side.distance)) { // a block that no cap comes near
      const Vec3d block_center = Vec3d(block_first.x + 1.5, block_first.y + 1.5, block_first.z + 1.5);
      caps = cap_winding_around(boundary, block_center, block_radius, 0.15);
    }
    for (const BlockComponent& c : side.components) {
      if (caps.decided) {
        if (is_inside(winding(c) - caps.value, method)) sides.blocks[block] |= c.samples;
        continue;
      }
      for (std::uint64_t rest = c.samples; rest; rest &= rest - 1) {
        const int s = std::countr_zero(rest);
        const Vec3i sample = block_first + Vec3i(bit_x(s), bit_y(s), bit_z(s));
        if (is_inside(winding(c) - cap_winding_at(boundary, sample), method))
          sides.blocks[block] |= std::uint64_t{1} << s;
      }
    }
  }
  return sides;
}

} // namespace levelray
