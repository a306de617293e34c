#include "raytrace/back_surface.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/error.h"

namespace retrace::raytrace {
namespace {

// Single-precision roundings that may add up between a ray and the hit that Embree names, relative to the coordinates.
constexpr double kSinglePrecisionBand = 32.0 * 0x1p-24;

/// Passed through Embree to the filter: the facet that the ray starts from.
struct QueryContext {
  RTCIntersectContext base;
  FacetRef source;
};

void throw_on_error(void*, RTCError code, const char* text) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw BudgetError("out of memory while building the scene");
  throw std::runtime_error(std::string("Embree: ") + (text != nullptr ? text : "unknown error"));
}

/// Rejects hits on the facet that the ray starts from; `geometryUserPtr` is the facet number of each triangle.
void reject_source(const RTCFilterFunctionNArguments* args) {
  const auto* context = reinterpret_cast<const QueryContext*>(args->context);
  const auto* facet_of = static_cast<const std::uint32_t*>(args->geometryUserPtr);
  const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, 0);
  const std::uint32_t instance = RTCHitN_instID(args->hit, args->N, 0, 0);
  const std::uint32_t placement = instance == RTC_INVALID_GEOMETRY_ID ? 0 : instance;
  if (context->source == FacetRef{placement, facet_of[triangle]}) args->valid[0] = 0;
}

}  // namespace

struct BackSurface::Embree {
  Embree(const geometry::Part& part, const std::vector<geometry::Placement>& placements) {
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw BudgetError("Embree cannot start: not enough memory or address space");
    rtcSetDeviceErrorFunction(device, throw_on_error, nullptr);
    for (const auto& patch : part.patches) facet_of_triangle.push_back(patch.triangle_facet);
    scene = new_scene();
    if (placements.size() == 1) {
      // One patch needs no instance: a level of the hierarchy less for every ray.
      attach_mesh(scene, part.patches[placements[0].patch], placements[0].patch, placements[0]);
    } else {
      attach_instances(part, placements);
    }
    rtcCommitScene(scene);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    for (RTCScene s : patch_scenes) rtcReleaseScene(s);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  RTCScene new_scene() const {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    return s;
  }

  void attach_mesh(RTCScene target, const geometry::SurfacePatch& patch, std::uint32_t number,
                   const geometry::Placement& at) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), patch.vertices.size()));
    for (const Vec3& p : patch.vertices) {
      *vertices++ = static_cast<float>(p.x() + at.offset_mm.x());
      *vertices++ = static_cast<float>(p.y() + at.offset_mm.y());
      *vertices++ = static_cast<float>(p.z() + at.height_mm);
    }
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), patch.triangles.size()));
    for (const auto& t : patch.triangles) triangles = std::copy(t.begin(), t.end(), triangles);
    rtcSetGeometryUserData(mesh, facet_of_triangle[number].data());
    rtcSetGeometryIntersectFilterFunction(mesh, reject_source);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(target, mesh);
    rtcReleaseGeometry(mesh);
  }

  void attach_instances(const geometry::Part& part, const std::vector<geometry::Placement>& placements) {
    for (std::size_t k = 0; k < part.patches.size(); ++k) {
      patch_scenes.push_back(new_scene());
      attach_mesh(patch_scenes.back(), part.patches[k], static_cast<std::uint32_t>(k), geometry::Placement{});
      rtcCommitScene(patch_scenes.back());
    }
    for (std::uint32_t k = 0; k < placements.size(); ++k) {
      RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, patch_scenes[placements[k].patch]);
      const std::array<float, 12> matrix = {1,
                                            0,
                                            0,
                                            0,
                                            1,
                                            0,
                                            0,
                                            0,
                                            1,
                                            static_cast<float>(placements[k].offset_mm.x()),
                                            static_cast<float>(placements[k].offset_mm.y()),
                                            static_cast<float>(placements[k].height_mm)};
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
      rtcCommitGeometry(instance);
      rtcAttachGeometryByID(scene, instance, k);
      rtcReleaseGeometry(instance);
    }
  }

  /// The facet that single precision names, if any.
  FacetRef candidate(const SurfaceRay& ray, const std::vector<geometry::Placement>& placements) const {
    QueryContext context;
    rtcInitIntersectContext(&context.base);
    context.source = ray.source;
    alignas(16) RTCRayHit query;
    query.ray.org_x = static_cast<float>(ray.origin.x());
    query.ray.org_y = static_cast<float>(ray.origin.y());
    query.ray.org_z = static_cast<float>(ray.origin.z());
    query.ray.dir_x = static_cast<float>(ray.direction.x());
    query.ray.dir_y = static_cast<float>(ray.direction.y());
    query.ray.dir_z = static_cast<float>(ray.direction.z());
    query.ray.tnear = 0.0F;
    query.ray.tfar = static_cast<float>(ray.t_max);
    query.ray.time = 0.0F;
    query.ray.mask = UINT32_MAX;
    query.ray.id = 0;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context.base, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const std::uint32_t placement = query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? 0 : query.hit.instID[0];
    return {placement, facet_of_triangle[placements[placement].patch][query.hit.primID]};
  }

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCScene> patch_scenes;
  std::vector<std::vector<std::uint32_t>> facet_of_triangle;  ///< by patch
};

BackSurface::BackSurface(const geometry::Part& part, const Vec2& centre_mm)
    : exact_(part, centre_mm), embree_(std::make_unique<Embree>(part, exact_.placements())) {
  double reach = part.size_mm + part.element_depth_mm;
  for (const auto& placement : exact_.placements()) {
    for (const auto& cell : part.patches[placement.patch].cells) {
      const Vec2 lower = cell.lower.head<2>() + placement.offset_mm;
      const Vec2 upper = cell.upper.head<2>() + placement.offset_mm;
      reach = std::max({reach, lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()});
    }
  }
  edge_band_mm_ = kSinglePrecisionBand * reach;
}

BackSurface::~BackSurface() = default;
BackSurface::BackSurface(BackSurface&&) noexcept = default;
BackSurface& BackSurface::operator=(BackSurface&&) noexcept = default;

// Seen at a slant, an error across the ray is a longer one along the facet.
bool BackSurface::is_near_edge(FacetRef facet, const Vec3& point, const Vec3& direction) const {
  return exact_.margin(facet, point) * std::abs(exact_.facet(facet).normal.dot(direction)) < edge_band_mm_;
}

std::optional<SurfaceHit> BackSurface::marked(std::optional<SurfaceHit> hit, const SurfaceRay& ray) const {
  if (hit) hit->near_edge = is_near_edge(hit->facet, ray.origin + hit->t * ray.direction, ray.direction);
  return hit;
}

std::optional<SurfaceHit> BackSurface::exact_first_hit(const SurfaceRay& ray) const {
  return marked(exact_.first_hit(ray), ray);
}

std::optional<SurfaceHit> BackSurface::certain_first_hit(const SurfaceRay& ray) const {
  const auto hit = exact_.first_hit(ray);
  return marked(hit ? hit : exact_.first_hit_of_widened(ray), ray);
}

std::optional<SurfaceHit> BackSurface::first_hit(const SurfaceRay& ray) const {
  if (ray.starts_near_edge) return exact_first_hit(ray);
  const FacetRef named = embree_->candidate(ray, exact_.placements());
  if (named.placement == FacetRef::kNone) return std::nullopt;
  const double towards = exact_.facet(named).normal.dot(ray.direction);
  if (ray.inside ? towards <= 0.0 : towards >= 0.0) return exact_first_hit(ray);
  const SurfaceHit hit{named, exact_.distance(named, ray.origin, ray.direction), false};
  if (hit.t < 0.0 || is_near_edge(named, ray.origin + hit.t * ray.direction, ray.direction))
    return exact_first_hit(ray);
  if (hit.t > ray.t_max) return std::nullopt;
  return hit;
}

}  // namespace retrace::raytrace
