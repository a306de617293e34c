#include "raytrace/faces/back_surface.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/threads.h"
#include "raytrace/faces/facet_boxes.h"

namespace retrace::raytrace {
namespace {

// Upper bound of the accumulated single-precision rounding errors in Embree's search, relative to the coordinates.
constexpr double kSinglePrecisionBand = 32.0 * 0x1p-24;

void throw_on_error(void*, RTCError code, const char* text) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(std::string("Embree: ") + (text != nullptr ? text : "unknown error"));
}

RTCDevice new_device() {
  RTCDevice device = nullptr;
  // Embree later builds scenes with the number of threads that is allowed now, when its device is created.
  run_with_threads(std::thread::hardware_concurrency(), [&] { device = rtcNewDevice(nullptr); });
  if (device == nullptr) {
    if (rtcGetDeviceError(nullptr) == RTC_ERROR_UNSUPPORTED_CPU)
      throw BudgetError("Embree cannot start: it does not support this processor");
    throw std::bad_alloc();
  }
  rtcSetDeviceErrorFunction(device, throw_on_error, nullptr);
  return device;
}

/// Returns the Embree device of the process. The device is never released. Embree may hang if a device is created while
/// another one is released.
RTCDevice shared_device() {
  static RTCDevice device = new_device();
  return device;
}

struct SceneReleaser {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneReleaser>;

float below(double value) {
  return std::nextafter(static_cast<float>(value), -INFINITY);
}

float above(double value) {
  return std::nextafter(static_cast<float>(value), INFINITY);
}

/// Returns the maximum absolute coordinate of the surface and of the starting points of rays in the plate above it.
double greatest_reach_mm(const geometry::Part& part, const std::vector<geometry::Placement>& placements) {
  double reach = part.size_mm + part.element_depth_mm + part.thickness_mm;
  for (const auto& placement : placements) {
    for (const auto& cell : part.patches[placement.patch].cells) {
      const Vec2 lower = cell.lower.head<2>() + placement.offset_mm;
      const Vec2 upper = cell.upper.head<2>() + placement.offset_mm;
      const double height = std::max(std::abs(cell.lower.z()), std::abs(cell.upper.z())) +
                            std::abs(placement.height_mm) + part.thickness_mm;
      reach = std::max({reach, lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff(), height});
    }
  }
  return reach;
}

/// Data that Embree passes to intersect(): the ray in double precision, and the nearest intersection found so far.
struct Query {
  RTCIntersectContext substrate;
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
  /// User data of an Embree geometry: the boxes of a patch. `place` is the position of the patch, or 0 if the geometry
  /// is used through instances.
  struct Group {
    const Boxes* owner = nullptr;
    std::uint32_t patch = 0;
    Vec3 place = Vec3::Zero();
  };

  Boxes(const geometry::Part& its_part, const ExactSurface& its_surface)
      : part(its_part),
        surface(its_surface),
        band_mm(kSinglePrecisionBand * greatest_reach_mm(part, surface.placements()) + surface.wide_tolerance_mm()) {
    for (const auto& patch : part.patches) contents.push_back(box_contents(patch));
    scene = new_scene();
    if (repeats_much())
      attach_instances();
    else
      attach_all();
    rtcCommitScene(scene.get());
  }
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  OwnedScene new_scene() const {
    OwnedScene made(rtcNewScene(device));
    rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    return made;
  }

  /// Returns true if instances reduce the number of boxes by more than a factor of 4. With instances, tracing is never
  /// slower than without, and in large arrays it is faster.
  bool repeats_much() const {
    std::size_t different = 0;
    std::size_t all = 0;
    for (const auto& patch : contents) different += patch.size();
    for (const auto& placement : surface.placements()) all += contents[placement.patch].size();
    return all > 4 * different;
  }

  void attach_all() {
    const auto& placements = surface.placements();
    groups.reserve(placements.size());
    for (std::uint32_t k = 0; k < placements.size(); ++k) {
      const geometry::Placement& at = placements[k];
      attach(scene.get(),
             groups.emplace_back(Group{this, at.patch, {at.offset_mm.x(), at.offset_mm.y(), at.height_mm}}), k);
    }
  }

  void attach_instances() {
    groups.reserve(contents.size());
    for (std::uint32_t k = 0; k < contents.size(); ++k) {
      patch_scenes.push_back(new_scene());
      attach(patch_scenes.back().get(), groups.emplace_back(Group{this, k, Vec3::Zero()}), 0);
      rtcCommitScene(patch_scenes.back().get());
    }
    for (std::uint32_t k = 0; k < surface.placements().size(); ++k) {
      const geometry::Placement& at = surface.placements()[k];
      RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, patch_scenes[at.patch].get());
      std::array<float, 12> matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1};
      matrix[9] = static_cast<float>(at.offset_mm.x());
      matrix[10] = static_cast<float>(at.offset_mm.y());
      matrix[11] = static_cast<float>(at.height_mm);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
      rtcCommitGeometry(instance);
      rtcAttachGeometryByID(scene.get(), instance, k);
      rtcReleaseGeometry(instance);
    }
  }

  void attach(RTCScene target, Group& group, std::uint32_t number) const {
    RTCGeometry boxes = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(boxes, static_cast<unsigned>(contents[group.patch].size()));
    rtcSetGeometryUserData(boxes, &group);
    rtcSetGeometryBoundsFunction(boxes, bounds, nullptr);
    rtcSetGeometryIntersectFunction(boxes, intersect);
    rtcCommitGeometry(boxes);
    rtcAttachGeometryByID(target, boxes, number);
    rtcReleaseGeometry(boxes);
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& group = *static_cast<const Group*>(args->geometryUserPtr);
    const Boxes& self = *group.owner;
    const FacetBox box = bounding_box_of(self.part.patches[group.patch], self.contents[group.patch][args->primID]);
    const Vec3 lower = box.lower + group.place - Vec3::Constant(self.band_mm);
    const Vec3 upper = box.upper + group.place + Vec3::Constant(self.band_mm);
    *args->bounds_o = {below(lower.x()), below(lower.y()), below(lower.z()), 0.0F,
                       above(upper.x()), above(upper.y()), above(upper.z()), 0.0F};
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& group = *static_cast<const Group*>(args->geometryUserPtr);
    const Boxes& self = *group.owner;
    auto& query = *reinterpret_cast<Query*>(args->context);
    const double before = query.best.t;
    const std::uint32_t instance = args->context->instID[0];
    const std::uint32_t placement = instance == RTC_INVALID_GEOMETRY_ID ? args->geomID : instance;
    self.surface.search(*query.ray, placement, self.contents[group.patch][args->primID].range, query.tolerance_mm,
                        query.best);
    if (query.best.t < before)
      RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, args->N), args->N, 0) = above(query.best.t + self.band_mm);
  }

  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray, double tolerance_mm) const {
    Query query;
    rtcInitIntersectContext(&query.substrate);
    query.ray = &ray;
    query.tolerance_mm = tolerance_mm;
    query.best.t = ray.t_max;
    RTCRayHit embree = embree_ray(ray);
    if (std::isfinite(ray.t_max)) embree.ray.tfar = above(ray.t_max + band_mm);
    rtcIntersect1(scene.get(), &query.substrate, &embree);
    return ExactSurface::found_hit(query.best);
  }

  const geometry::Part& part;
  const ExactSurface& surface;
  double band_mm;                                 ///< bound of the single-precision errors of rays and boxes
  std::vector<std::vector<BoxContent>> contents;  ///< indexed by patch
  std::vector<Group> groups;
  RTCDevice device = shared_device();
  OwnedScene scene;
  std::vector<OwnedScene> patch_scenes;  ///< scenes of the patches if instances are used, otherwise empty
};

BackSurface::BackSurface(const geometry::Part& part, const Vec2& centre_mm)
    : exact_(part, centre_mm), boxes_(std::make_unique<Boxes>(part, exact_)) {}

BackSurface::~BackSurface() = default;

std::optional<SurfaceHit> BackSurface::first_hit(const SurfaceRay& ray) const {
  return boxes_->first_hit(ray, exact_.tolerance_mm());
}

std::optional<SurfaceHit> BackSurface::first_hit_with_tolerance(const SurfaceRay& ray) const {
  const auto hit = first_hit(ray);
  return hit ? hit : boxes_->first_hit(ray, exact_.wide_tolerance_mm());
}

}  // namespace retrace::raytrace
