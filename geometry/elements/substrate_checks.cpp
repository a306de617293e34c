// Checks whether a substrate is suitable for the elements of a part.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/direction.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/substrate_checks.h"

namespace retrace::geometry {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
constexpr double kMaxInclineDeg = 60.0;
constexpr double kSteepestFacet = 88.0;
constexpr int kGridSteps = 64;  // intervals per side of the grids at which facets and pins are checked

template <class Visit>
void visit_grid(const Vec2& half_mm, const Visit& visit) {
  for (int j = 0; j <= kGridSteps; ++j)
    for (int i = 0; i <= kGridSteps; ++i)
      visit(Vec2(half_mm.cwiseProduct(Vec2(2.0 * i / kGridSteps - 1.0, 2.0 * j / kGridSteps - 1.0))));
}

/// Limits the number of elements on spheres and formulas. On such substrates, all elements differ, and each element
/// needs some kilobytes of memory.
void check_count(const PartSpec& spec) {
  constexpr double kMaxDistinctElements = 2e6;
  const bool repeats = std::holds_alternative<PlaneSubstrate>(spec.substrate->shape) ||
                       std::holds_alternative<CylinderSubstrate>(spec.substrate->shape);
  const double count = spec.array.x_length_mm * spec.array.y_length_mm / area(aperture_outline(spec.element));
  if (!repeats && count > kMaxDistinctElements)
    throw InputError(fmt::format(
        "must have at most {:.0f} elements, because no two elements on it are alike; the array has about {:.3g}",
        kMaxDistinctElements, count));
}

/// Returns the facet normals of an element, towards the light. If the array has rotated elements, the facet normals of
/// a rotated element are also returned.
std::vector<Vec3> facet_normals(const PartSpec& spec) {
  std::vector<Vec3> normals;
  for (const CellFacet& facet : element_cell(spec.element, spec.angle_errors).facets) {
    const Vec3 normal = Vec3(-facet.plane.slope.x(), -facet.plane.slope.y(), 1.0).normalized();
    normals.push_back(normal);
    if (spec.array.arrangement == Arrangement::triangular) normals.emplace_back(-normal.x(), -normal.y(), normal.z());
    if (spec.array.arrangement == Arrangement::checker) normals.emplace_back(-normal.y(), normal.x(), normal.z());
  }
  return normals;
}

void check_steepness(const PartSpec& spec, const SubstrateSurface& surface, const Vec2& half_mm) {
  const std::vector<Vec3> normals = facet_normals(spec);
  double least = 1.0;
  visit_grid(half_mm, [&](const Vec2& p) {
    const SubstrateFrame frame = surface.frame_over(p);
    for (const Vec3& n : normals)
      least = std::min(least, n.x() * frame.along_u.z() + n.y() * frame.along_v.z() + n.z() * frame.normal.z());
  });
  const double spare = 6.0 * spec.random_tilts.sigma_arcmin / 60.0;
  const double steepest = std::acos(std::clamp(least, -1.0, 1.0)) / kRadPerDegree + spare;
  if (steepest > kSteepestFacet)
    throw InputError(
        fmt::format("every facet must have a slope of at most {} degrees, but the steepest facet has {} degrees",
                    kSteepestFacet, fixed_apart(steepest, kSteepestFacet, 2)));
}

/// Checks that pins touch their neighbours. Pins touch along their sides. If a pin is shifted along its axis by more
/// than the depth of its tip, its facets no longer share an edge with the neighbour's facets.
void check_contact(const PartSpec& spec, const SubstrateSurface& surface, const Vec2& half_mm) {
  const double depth = element_depth_mm(spec.element, spec.angle_errors);
  const double pitch = 0.5 * std::numbers::sqrt3 * std::get<HexagonalCube>(spec.element).aperture_mm;
  double most = 0.0;
  visit_grid(half_mm, [&](const Vec2& p) {
    for (const double degrees : {30.0, 90.0, 150.0}) {
      const Vec2 next = p + pitch * direction_at(Angle::from_deg(degrees));
      most = std::max(most, std::abs(surface.at(next).value - surface.at(p).value));
    }
  });
  if (most >= depth)
    throw InputError(
        fmt::format("neighbouring pins must touch: they are shifted along their axis by up to {} mm, but the shift "
                    "must be less than the depth of their tips, {} mm",
                    fixed_apart(most, depth, 4), shortest(depth)));
}

}  // namespace

SubstrateSurface substrate_surface_of(const PartSpec& spec) {
  return {*spec.substrate, 0.5 * Vec2(spec.array.x_length_mm, spec.array.y_length_mm), width_across_mm(spec.element)};
}

double width_across_mm(const Element& element) {
  if (const auto* rtp = std::get_if<RtpElement>(&element)) return std::hypot(rtp->base_mm, rtp->width_mm);
  if (const auto* cube = std::get_if<HexagonalCube>(&element)) return cube->aperture_mm;
  if (std::holds_alternative<RuledCells>(element)) return bounding_box(element_cell(element).outline).size().norm();
  return std::get<TriangularCube>(element).aperture_mm;
}

SubstrateMeasures check_substrate(const PartSpec& spec) {
  const Vec2 half_mm = 0.5 * Vec2(spec.array.x_length_mm, spec.array.y_length_mm);
  check_count(spec);
  const SubstrateSurface surface = substrate_surface_of(spec);
  const SubstrateMeasures measures = measure_substrate(surface, half_mm);
  const double across = width_across_mm(spec.element);
  if (measures.min_radius_mm < across)
    throw InputError(
        fmt::format("the radius of curvature of the substrate must be at least the width of an element: the smallest "
                    "radius is {} mm, but an element is {} mm wide",
                    fixed_apart(measures.min_radius_mm, across, 4), shortest(across)));
  if (measures.steepest_deg > kMaxInclineDeg + 1e-9)
    throw InputError(fmt::format(
        "the slope of the substrate must be at most {} degrees over the part, but the maximum slope is {} degrees",
        kMaxInclineDeg, fixed_apart(measures.steepest_deg, kMaxInclineDeg, 2)));
  if (spec.is_pin_bundle) check_contact(spec, surface, half_mm);
  if (!surface.is_upright()) check_steepness(spec, surface, half_mm);
  return measures;
}

}  // namespace retrace::geometry
