#include "raytrace/back_surface.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/error.h"
#include "raytrace/facet_boxes.h"

namespace retrace::raytrace {
namespace {

// Single-precision roundings that may add up in Embree's walk through boxes, relative to the coordinates.
constexpr double kSinglePrecisionBand = 32.0 * 0x1p-24;
void throw_on_error(void*, RTCError code, const char* text) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw BudgetError("out of memory while building the scene");
  throw std::runtime_error(std::string("Embree: ") + (text != nullptr ? text : "unknown error"));
}

float below(double value) {
  return std::nextafter(static_cast<float>(value), -INFINITY);
}

float above(double value) {
  return std::nextafter(static_cast<float>(value), INFINITY);
}

/// Of the coordinates of the surface.
double greatest_reach_mm(const geometry::Part& part, const std::vector<geometry::Placement>& placements) {
  double reach = part.size_mm + part.element_depth_mm;
  for (const auto& placement : placements) {
    for (const auto& cell : part.patches[placement.patch].cells) {
      const Vec2 lower = cell.lower.head<2>() + placement.offset_mm;
      const Vec2 upper = cell.upper.head<2>() + placement.offset_mm;
      reach = std::max({reach, lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()});
    }
  }
  return reach;
}

/// Passed through Embree to the facets: the ray in double precision, and what it has met.
struct Query {
  RTCIntersectContext base;
  const SurfaceRay* ray = nullptr;
  double tolerance_mm = 0.0;
  SurfaceHit best;
};

RTCRayHit embree_ray(const SurfaceRay& ray) {
  alignas(16) RTCRayHit query;
  query.ray.org_x = static_cast<float>(ray.origin.x());
  query.ray.org_y = static_cast<float>(ray.origin.y());
  query.ray.org_z = static_cast<float>(ray.origin.z());
  query.ray.dir_x = static_cast<float>(ray.direction.x());
  query.ray.dir_y = static_cast<float>(ray.direction.y());
  query.ray.dir_z = static_cast<float>(ray.direction.z());
  query.ray.tnear = 0.0F;
  query.ray.tfar = INFINITY;
  query.ray.time = 0.0F;
  query.ray.mask = UINT32_MAX;
  query.ray.id = 0;
  query.ray.flags = 0;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

}  // namespace

struct BackSurface::Boxes {
  /// What stands in boxes at one placement: one geometry of the scene.
  struct Group {
    const Boxes* owner = nullptr;
    std::uint32_t placement = 0;
  };

  Boxes(const geometry::Part& its_part, const ExactSurface& its_surface)
      : part(its_part),
        surface(its_surface),
        band_mm(kSinglePrecisionBand * greatest_reach_mm(part, surface.placements()) + surface.wide_tolerance_mm()) {
    for (const auto& patch : part.patches) contents.push_back(box_contents(patch));
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw BudgetError("Embree cannot start: not enough memory or address space");
    rtcSetDeviceErrorFunction(device, throw_on_error, nullptr);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    groups.reserve(surface.placements().size());
    for (std::uint32_t k = 0; k < surface.placements().size(); ++k) attach(groups.emplace_back(Group{this, k}));
    rtcCommitScene(scene);
  }
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;
  ~Boxes() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void attach(Group& group) const {
    const std::uint32_t patch = surface.placements()[group.placement].patch;
    RTCGeometry boxes = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(boxes, static_cast<unsigned>(contents[patch].size()));
    rtcSetGeometryUserData(boxes, &group);
    rtcSetGeometryBoundsFunction(boxes, bounds, nullptr);
    rtcSetGeometryIntersectFunction(boxes, intersect);
    rtcCommitGeometry(boxes);
    rtcAttachGeometryByID(scene, boxes, group.placement);
    rtcReleaseGeometry(boxes);
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& group = *static_cast<const Group*>(args->geometryUserPtr);
    const Boxes& self = *group.owner;
    const geometry::Placement& at = self.surface.placements()[group.placement];
    const Box box = box_round(self.part.patches[at.patch], self.contents[at.patch][args->primID]);
    const Vec3 place(at.offset_mm.x(), at.offset_mm.y(), at.height_mm);
    const Vec3 lower = box.lower + place - Vec3::Constant(self.band_mm);
    const Vec3 upper = box.upper + place + Vec3::Constant(self.band_mm);
    *args->bounds_o = {below(lower.x()), below(lower.y()), below(lower.z()), 0.0F,
                       above(upper.x()), above(upper.y()), above(upper.z()), 0.0F};
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& group = *static_cast<const Group*>(args->geometryUserPtr);
    const Boxes& self = *group.owner;
    auto& query = *reinterpret_cast<Query*>(args->context);
    const double before = query.best.t;
    const std::uint32_t patch = self.surface.placements()[group.placement].patch;
    self.surface.search(*query.ray, group.placement, self.contents[patch][args->primID].range, query.tolerance_mm,
                        query.best);
    if (query.best.t < before)
      RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, args->N), args->N, 0) = above(query.best.t + self.band_mm);
  }

  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray, double tolerance_mm) const {
    Query query;
    rtcInitIntersectContext(&query.base);
    query.ray = &ray;
    query.tolerance_mm = tolerance_mm;
    query.best.t = ray.t_max;
    RTCRayHit embree = embree_ray(ray);
    if (std::isfinite(ray.t_max)) embree.ray.tfar = above(ray.t_max + band_mm);
    rtcIntersect1(scene, &query.base, &embree);
    if (query.best.facet.placement == FacetRef::kNone) return std::nullopt;
    return query.best;
  }

  const geometry::Part& part;
  const ExactSurface& surface;
  double band_mm;                                 ///< what single precision may put wrong of rays and boxes
  std::vector<std::vector<BoxContent>> contents;  ///< by patch
  std::vector<Group> groups;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

BackSurface::BackSurface(const geometry::Part& part, const Vec2& centre_mm)
    : exact_(part, centre_mm), boxes_(std::make_unique<Boxes>(part, exact_)) {}

BackSurface::~BackSurface() = default;

std::optional<SurfaceHit> BackSurface::first_hit(const SurfaceRay& ray) const {
  return boxes_->first_hit(ray, exact_.tolerance_mm());
}

std::optional<SurfaceHit> BackSurface::certain_first_hit(const SurfaceRay& ray) const {
  const auto hit = first_hit(ray);
  return hit ? hit : boxes_->first_hit(ray, exact_.wide_tolerance_mm());
}

}  // namespace retrace::raytrace
