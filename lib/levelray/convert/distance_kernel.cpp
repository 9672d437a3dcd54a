#include "levelray/convert/distance_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "levelray/convert/distance_kernel.cpp"
#include <hwy/foreach_target.h> // compiles this file once per instruction set
#include <hwy/highway.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace levelray {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;
using V = hn::Vec<Lanes>;

// Lowers the 64 values at `squared` (aligned) by one triangle. x16 and y16 hold the points' coordinates
// within a slice of z.
HWY_INLINE void lower_by(const TriangleFrame& f, const float* x16, const float* y16, float z0, float spacing,
                         float* squared) {
  const Lanes d;
  const V zero = hn::Zero(d);
  const V threshold = hn::Set(d, f.threshold);
  const V half0 = hn::Set(d, f.half[0]), half1 = hn::Set(d, f.half[1]), half2 = hn::Set(d, f.half[2]);
  for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    const V x = hn::Load(d, x16 + lane), y = hn::Load(d, y16 + lane);
    const auto at_first_slice = [&](const float(&g)[4]) HWY_ATTR {
      const V base = hn::Set(d, g[3] + g[2] * z0);
      return hn::Add(hn::Add(base, hn::Mul(hn::Set(d, g[0]), x)), hn::Mul(hn::Set(d, g[1]), y));
    };
    V plane = at_first_slice(f.plane);
    V in0 = at_first_slice(f.inward[0]), in1 = at_first_slice(f.inward[1]), in2 = at_first_slice(f.inward[2]);
    V al0 = at_first_slice(f.along[0]), al1 = at_first_slice(f.along[1]), al2 = at_first_slice(f.along[2]);
    const V plane_step = hn::Set(d, f.plane[2] * spacing);
    const V in0_step = hn::Set(d, f.inward[0][2] * spacing), in1_step = hn::Set(d, f.inward[1][2] * spacing),
            in2_step = hn::Set(d, f.inward[2][2] * spacing);
    const V al0_step = hn::Set(d, f.along[0][2] * spacing), al1_step = hn::Set(d, f.along[1][2] * spacing),
            al2_step = hn::Set(d, f.along[2][2] * spacing);
    for (std::size_t z = 0; z < 4; ++z) {
      const V over0 = hn::Max(hn::Sub(hn::Abs(al0), half0), zero),
              over1 = hn::Max(hn::Sub(hn::Abs(al1), half1), zero),
              over2 = hn::Max(hn::Sub(hn::Abs(al2), half2), zero);
      const V edge0 = hn::Add(hn::Mul(in0, in0), hn::Mul(over0, over0));
      const V edge1 = hn::Add(hn::Mul(in1, in1), hn::Mul(over1, over1));
      const V edge2 = hn::Add(hn::Mul(in2, in2), hn::Mul(over2, over2));
      const V nearest_edge = hn::Min(hn::Min(edge0, edge1), edge2);
      const auto above = hn::Ge(hn::Min(hn::Min(in0, in1), in2), threshold);
      const V in_plane = hn::IfThenZeroElse(above, nearest_edge);
      float* out = squared + 16 * z + lane;
      hn::Store(hn::Min(hn::Load(d, out), hn::Add(hn::Mul(plane, plane), in_plane)), d, out);
      plane = hn::Add(plane, plane_step);
      in0 = hn::Add(in0, in0_step), in1 = hn::Add(in1, in1_step), in2 = hn::Add(in2, in2_step);
      al0 = hn::Add(al0, al0_step), al1 = hn::Add(al1, al1_step), al2 = hn::Add(al2, al2_step);
    }
  }
}

// The x and y coordinates of the 16 points of a slice.
HWY_INLINE void slice_points(const float origin[3], float spacing, float* x16, float* y16) {
  for (int i = 0; i < 16; ++i) {
    x16[i] = origin[0] + spacing * static_cast<float>(i & 3);
    y16[i] = origin[1] + spacing * static_cast<float>(i >> 2);
  }
}

void LowerAll(const TriangleFrame* frames, const std::uint32_t* list, std::size_t count, const float* origin,
              float spacing, float* squared) {
  alignas(64) float x16[16], y16[16], best[64];
  slice_points(origin, spacing, x16, y16);
  for (int i = 0; i < 64; ++i) best[i] = squared[i];
  for (std::size_t t = 0; t < count; ++t) lower_by(frames[list[t]], x16, y16, origin[2], spacing, best);
  for (int i = 0; i < 64; ++i) squared[i] = best[i];
}

void Each(const TriangleFrame* frames, std::size_t count, const float* origin, float spacing,
          float* squared) {
  alignas(64) float x16[16], y16[16], best[64];
  slice_points(origin, spacing, x16, y16);
  for (std::size_t t = 0; t < count; ++t) {
    for (int i = 0; i < 64; ++i) best[i] = std::numeric_limits<float>::infinity();
    lower_by(frames[t], x16, y16, origin[2], spacing, best);
    for (int i = 0; i < 64; ++i) squared[64 * t + static_cast<std::size_t>(i)] = best[i];
  }
}

// Gathers 64 comparison results, one bit each; compare(i) gives the mask for the lanes from value i on.
template <class Compare>
HWY_INLINE std::uint64_t gather_bits(Compare compare) {
  const Lanes d;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(d)) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, compare(i), bytes);
    bits |= (std::uint64_t{bytes[0]} | std::uint64_t{bytes[1]} << 8) << i;
  }
  return bits;
}

std::uint64_t Below(const float* values, float limit) {
  const Lanes d;
  return gather_bits([&](std::size_t i)
                         HWY_ATTR { return hn::Lt(hn::LoadU(d, values + i), hn::Set(d, limit)); });
}

std::uint64_t AtMost(const float* values, const float* limits) {
  const Lanes d;
  return gather_bits([&](std::size_t i)
                         HWY_ATTR { return hn::Le(hn::LoadU(d, values + i), hn::LoadU(d, limits + i)); });
}

void LowerTo(float* values, const float* other) {
  const Lanes d;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(d))
    hn::StoreU(hn::Min(hn::LoadU(d, values + i), hn::LoadU(d, other + i)), d, values + i);
}

void SumsAbove(const float* distance, float threshold, std::uint64_t* along) {
  const Lanes d;
  for (int axis = 0; axis < 3; ++axis) {
    const float* next = distance + (std::size_t{1} << (2 * axis));
    along[axis] = gather_bits([&](std::size_t i) HWY_ATTR {
      return hn::Gt(hn::Add(hn::LoadU(d, distance + i), hn::LoadU(d, next + i)), hn::Set(d, threshold));
    });
  }
}

void Roots(float* values) {
  const Lanes d;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(d))
    hn::StoreU(hn::Sqrt(hn::LoadU(d, values + i)), d, values + i);
}

const char* Target() {
  return hwy::TargetName(HWY_TARGET);
}

} // namespace HWY_NAMESPACE
} // namespace levelray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace levelray {

HWY_EXPORT(LowerAll);
HWY_EXPORT(Each);
HWY_EXPORT(Below);
HWY_EXPORT(AtMost);
HWY_EXPORT(LowerTo);
HWY_EXPORT(SumsAbove);
HWY_EXPORT(Roots);
HWY_EXPORT(Target);

void lower_squared_distances(const TriangleFrame* frames, const std::uint32_t* list, std::size_t count,
                             const float origin[3], float spacing, float squared[64]) {
  HWY_DYNAMIC_DISPATCH(LowerAll)(frames, list, count, origin, spacing, squared);
}

void squared_distances_each(const TriangleFrame* frames, std::size_t count, const float origin[3],
                            float spacing, float* squared) {
  HWY_DYNAMIC_DISPATCH(Each)(frames, count, origin, spacing, squared);
}

std::uint64_t mask_below(const float values[64], float limit) {
  return HWY_DYNAMIC_DISPATCH(Below)(values, limit);
}
std::uint64_t mask_at_most(const float values[64], const float limits[64]) {
  return HWY_DYNAMIC_DISPATCH(AtMost)(values, limits);
}
void lower_to(float values[64], const float other[64]) {
  HWY_DYNAMIC_DISPATCH(LowerTo)(values, other);
}
void pair_sums_above(const float distance[80], float threshold, std::uint64_t along[3]) {
  HWY_DYNAMIC_DISPATCH(SumsAbove)(distance, threshold, along);
}
void square_roots(float values[64]) {
  HWY_DYNAMIC_DISPATCH(Roots)(values);
}

const char* distance_kernel_target() {
  return HWY_DYNAMIC_DISPATCH(Target)();
}

std::vector<std::string> distance_kernel_targets() {
  use_distance_kernel_target("");
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.push_back(hwy::TargetName(target));
  return names;
}

void use_distance_kernel_target(const std::string& name) {
  hwy::SetSupportedTargetsForTest(0); // all
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (hwy::TargetName(target) == name) {
      hwy::SetSupportedTargetsForTest(target);
      break;
    }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace levelray
#endif
