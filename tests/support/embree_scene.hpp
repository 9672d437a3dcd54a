// Embree on a triangle mesh, for tests and benchmarks that compare with rays against the triangles
// themselves. Embree computes in float: the mesh should be centred on the origin and about one unit large.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/mesh/triangle_mesh.hpp"

#include <array>
#include <embree3/rtcore.h>
#include <span>
#include <stdexcept>

namespace levelray::test {

struct EmbreeHit {
  bool hit = false;
  float t = 0;           // along the ray's own direction
  Vec3f normal{0, 0, 0}; // the triangle's, not normalised, counter-clockwise side
  std::uint32_t triangle = 0;
};

class EmbreeScene {
 public:
  // The device is left to choose its threads: one opened with threads=1 holds TBB to one thread for good.
  explicit EmbreeScene(const TriangleMesh& mesh) : device_(rtcNewDevice(nullptr)) {
    if (!device_) throw std::runtime_error("Embree does not start");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST); // no leaks at edges
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    for (const Vec3d& v : mesh.vertices)
      for (int a = 0; a < 3; ++a) *vertices++ = static_cast<float>(v[a]);
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) *indices++ = v;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree refuses the mesh");
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  void trace(std::span<const WorldRay> rays, std::span<EmbreeHit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      RTCRayHit r{};
      const Vec3f o(rays[i].origin), d(rays[i].direction);
      r.ray = {o.x, o.y, o.z, static_cast<float>(rays[i].t_min), d.x,
               d.y, d.z, 0,   static_cast<float>(rays[i].t_max), ~0u,
               0,   0};
      r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &r);
      hits[i] = {r.hit.geomID != RTC_INVALID_GEOMETRY_ID, r.ray.tfar,
                 Vec3f(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z), r.hit.primID};
    }
  }

  // Packets of 16 rays that follow each other.
  void trace_packets(std::span<const WorldRay> rays, std::span<EmbreeHit> hits) const {
    constexpr std::size_t width = 16;
    for (std::size_t first = 0; first < rays.size(); first += width) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      alignas(64) RTCRayHit16 r{};
      alignas(64) std::array<int, width> valid{};
      const std::size_t count = std::min(width, rays.size() - first);
      for (std::size_t k = 0; k < count; ++k) {
        const WorldRay& ray = rays[first + k];
        valid[k] = -1;
        r.ray.org_x[k] = static_cast<float>(ray.origin.x),
        r.ray.dir_x[k] = static_cast<float>(ray.direction.x);
        r.ray.org_y[k] = static_cast<float>(ray.origin.y),
        r.ray.dir_y[k] = static_cast<float>(ray.direction.y);
        r.ray.org_z[k] = static_cast<float>(ray.origin.z),
        r.ray.dir_z[k] = static_cast<float>(ray.direction.z);
        r.ray.tnear[k] = static_cast<float>(ray.t_min), r.ray.tfar[k] = static_cast<float>(ray.t_max);
        r.ray.mask[k] = ~0u;
        r.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid.data(), scene_, &context, &r);
      for (std::size_t k = 0; k < count; ++k)
        hits[first + k] = {r.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID, r.ray.tfar[k],
                           Vec3f(r.hit.Ng_x[k], r.hit.Ng_y[k], r.hit.Ng_z[k]), r.hit.primID[k]};
    }
  }

 private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

} // namespace levelray::test
