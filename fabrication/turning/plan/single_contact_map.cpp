#include "fabrication/turning/plan/single_contact_map.h"

#include <algorithm>

#include "geometry/surface/concavity_bound.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Boundary;
using geometry::FreeformSurface;
using geometry::Lenslet;
using geometry::PlanBox;

using geometry::Vec2;

constexpr int kBoundaryHalvings = 7;

/// Returns the minimum and the maximum distance between a box and a point.
std::pair<double, double> distances(const PlanBox& box, const Vec2& from) {
  const Vec2 low = box.low_mm - from;
  const Vec2 high = box.high_mm - from;
  const Vec2 far = low.cwiseAbs().cwiseMax(high.cwiseAbs());
  const Vec2 near = low.cwiseMax(-high).cwiseMax(0.0);
  return {near.norm(), far.norm()};
}

}  // namespace

SingleContactMap::SingleContactMap(const FreeformSurface& surface, const TurningTool& tool, double reach_mm) {
  // A rake adds the slope of the surface to the condition. This case is not covered by the proof.
  if (tool.rake_deg != 0.0) return;
  const double nose_mm = tool.nose_radius_mm;
  constexpr double kMargin = 0.99;
  const double limit_per_mm = kMargin / nose_mm;
  half_mm_ = reach_mm + nose_mm;
  per_mm_ = static_cast<double>(kCells) / (2.0 * half_mm_);
  has_single_contact_.assign(kCells * kCells, 1);
  const auto forget_box = [&](const PlanBox& box) { clear_around(box.low_mm, box.high_mm, nose_mm); };
  const PlanBox all{Vec2::Constant(-half_mm_), Vec2::Constant(half_mm_)};
  const auto is_reached = [&](const PlanBox& box) { return distances(box, Vec2::Zero()).first <= half_mm_; };
  if (const auto& outside = surface.extrapolation()) {
    // Nothing is proved beyond the boundary and in boxes that the boundary crosses.
    const Boundary& boundary = outside->boundary;
    prove_by_subdivision(
        all, kBoundaryHalvings,
        [&](const PlanBox& box) {
          const auto [nearest, farthest] = distances(box, boundary.centre_mm);
          if (nearest > boundary.max_radius_mm) forget_box(box);
          return nearest > boundary.max_radius_mm || farthest <= boundary.min_radius_mm;
        },
        forget_box);
  }
  bound_concavity(surface.base(), all, limit_per_mm, is_reached, forget_box);
  for (const Lenslet& lenslet : surface.lenslets()) {
    const Vec2 half = Vec2::Constant(lenslet.outer.max_radius_mm);
    const PlanBox box{lenslet.outer.centre_mm - half, lenslet.outer.centre_mm + half};
    if (is_reached(box) && !(is_concavity_bounded(lenslet, limit_per_mm) &&
                             is_blend_concavity_bounded(lenslet, surface.base(), limit_per_mm)))
      forget_box(box);
  }
}

void SingleContactMap::clear_around(const Vec2& low, const Vec2& high, double nose_mm) {
  const auto cell = [&](double mm) {
    return static_cast<std::size_t>(std::clamp((mm + half_mm_) * per_mm_, 0.0, static_cast<double>(kCells - 1)));
  };
  for (std::size_t row = cell(low.y() - nose_mm); row <= cell(high.y() + nose_mm); ++row)
    for (std::size_t column = cell(low.x() - nose_mm); column <= cell(high.x() + nose_mm); ++column)
      has_single_contact_[row * kCells + column] = 0;
}

}  // namespace retrace::fabrication::turning
