#include "benchmarks/raw_embree.h"

#include <embree3/rtcore.h>

#include <algorithm>

namespace retrace::benchmarks {

using geometry::Vec3;
using raytrace::SurfaceRay;

struct RawEmbree::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = nullptr;
  std::vector<RTCScene> patches;

  /// Returns a single mesh that contains all patches at their placements.
  RTCScene mesh(const geometry::Part& part, const std::vector<geometry::Placement>& placements,
                const geometry::Vec2& origin) const {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::size_t vertex_count = 0;
    std::size_t triangle_count = 0;
    for (const auto& placement : placements) {
      vertex_count += part.patches[placement.patch].vertices.size();
      triangle_count += part.patches[placement.patch].triangles.size();
    }
    auto* v =
        static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertex_count));
    auto* t = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangle_count));
    std::uint32_t first = 0;
    for (const auto& placement : placements) {
      const geometry::SurfacePatch& patch = part.patches[placement.patch];
      const geometry::Vec2 offset = placement.offset_mm - origin;
      for (const Vec3& p : patch.vertices) {
        *v++ = static_cast<float>(p.x() + offset.x());
        *v++ = static_cast<float>(p.y() + offset.y());
        *v++ = static_cast<float>(p.z());
      }
      for (const auto& triangle : patch.triangles)
        for (const auto corner : triangle) *t++ = first + static_cast<std::uint32_t>(corner);
      first += static_cast<std::uint32_t>(patch.vertices.size());
    }
    rtcCommitGeometry(g);
    rtcAttachGeometry(s, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(s);
    return s;
  }
};

RawEmbree::RawEmbree(const Scene& from, Build build) : impl_(std::make_unique<Impl>()) {
  const geometry::Part& part = from.part;
  if (part.placements.size() == 1 || build == Build::flat) {
    impl_->scene = impl_->mesh(part, part.placements, from.centre_mm);
    return;
  }
  for (std::uint32_t patch = 0; patch < part.patches.size(); ++patch) {
    geometry::Placement placement;
    placement.patch = patch;
    impl_->patches.push_back(impl_->mesh(part, {placement}, geometry::Vec2::Zero()));
  }
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
  for (const auto& placement : part.placements) {
    RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, impl_->patches[placement.patch]);
    const geometry::Vec2 at = placement.offset_mm - from.centre_mm;
    const std::array<float, 12> m = {1, 0, 0, 0, 1, 0, 0, 0, 1, static_cast<float>(at.x()), static_cast<float>(at.y()),
                                     0};
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
    rtcCommitGeometry(g);
    rtcAttachGeometry(impl_->scene, g);
    rtcReleaseGeometry(g);
  }
  rtcCommitScene(impl_->scene);
}

RawEmbree::~RawEmbree() {
  rtcReleaseScene(impl_->scene);
  for (RTCScene s : impl_->patches) rtcReleaseScene(s);
  rtcReleaseDevice(impl_->device);
}

namespace {

// Distance along the ray at which the search begins, so that a ray does not hit its own facet. The tracer must not use
// such an offset, but this benchmark is only a lower bound of the time.
constexpr float kNear = 1e-5F;

RTCIntersectContext context() {
  RTCIntersectContext c;
  rtcInitIntersectContext(&c);
  return c;
}

RTCRayHit query_of(const SurfaceRay& ray) {
  RTCRayHit query;
  const Eigen::Vector3f origin = ray.origin.cast<float>(), direction = ray.direction.cast<float>();
  query.ray.org_x = origin.x();
  query.ray.org_y = origin.y();
  query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tnear = kNear;
  query.ray.tfar = 1e30F;
  query.ray.time = 0.0F;
  query.ray.mask = UINT32_MAX;
  query.ray.flags = 0;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// Writes a ray to lane k of a packet. P is RTCRayHit8 or RTCRayHit16.
template <class P>
void load(P& packet, unsigned k, const SurfaceRay& ray) {
  const Eigen::Vector3f origin = ray.origin.cast<float>(), direction = ray.direction.cast<float>();
  packet.ray.org_x[k] = origin.x();
  packet.ray.org_y[k] = origin.y();
  packet.ray.org_z[k] = origin.z();
  packet.ray.dir_x[k] = direction.x();
  packet.ray.dir_y[k] = direction.y();
  packet.ray.dir_z[k] = direction.z();
  packet.ray.tnear[k] = kNear;
  packet.ray.tfar[k] = 1e30F;
  packet.ray.time[k] = 0.0F;
  packet.ray.mask[k] = UINT32_MAX;
  packet.ray.flags[k] = 0;
  packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
}

template <unsigned kWidth, class P, class Trace>
std::size_t trace_packets(const std::vector<SurfaceRay>& rays, const Trace& trace) {
  alignas(64) int valid[kWidth];
  std::fill(std::begin(valid), std::end(valid), -1);
  RTCIntersectContext c = context();
  std::size_t hits = 0;
  for (std::size_t first = 0; first + kWidth <= rays.size(); first += kWidth) {
    alignas(64) P packet;
    for (unsigned k = 0; k < kWidth; ++k) load(packet, k, rays[first + k]);
    trace(valid, &c, &packet);
    for (unsigned k = 0; k < kWidth; ++k) hits += packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

}  // namespace

std::size_t RawEmbree::trace1(const std::vector<SurfaceRay>& rays) const {
  RTCIntersectContext c = context();
  std::size_t hits = 0;
  for (const SurfaceRay& ray : rays) {
    RTCRayHit query = query_of(ray);
    rtcIntersect1(impl_->scene, &c, &query);
    hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

std::size_t RawEmbree::trace_streams(const std::vector<SurfaceRay>& rays) const {
  constexpr std::size_t kStream = 1024;
  std::vector<RTCRayHit> stream(kStream);
  RTCIntersectContext c = context();
  std::size_t hits = 0;
  for (std::size_t first = 0; first < rays.size(); first += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - first);
    for (std::size_t k = 0; k < count; ++k) stream[k] = query_of(rays[first + k]);
    rtcIntersect1M(impl_->scene, &c, stream.data(), static_cast<unsigned>(count), sizeof(RTCRayHit));
    for (std::size_t k = 0; k < count; ++k) hits += stream[k].hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

std::size_t RawEmbree::trace8(const std::vector<SurfaceRay>& rays) const {
  return trace_packets<8, RTCRayHit8>(
      rays, [&](const int* valid, RTCIntersectContext* c, RTCRayHit8* p) { rtcIntersect8(valid, impl_->scene, c, p); });
}

std::size_t RawEmbree::trace16(const std::vector<SurfaceRay>& rays) const {
  return trace_packets<16, RTCRayHit16>(rays, [&](const int* valid, RTCIntersectContext* c, RTCRayHit16* p) {
    rtcIntersect16(valid, impl_->scene, c, p);
  });
}

}  // namespace retrace::benchmarks
