#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>

#include "geometry/elements/whole_elements.h"
#include "geometry/outline/plan_region.h"
#include "tests/geometry/outline_random.h"
#include "tests/support/part_specs.h"

// Parts whose array is cut by an outline: convex, with notches, with holes, and random ones.

namespace retrace::testing {

/// Returns the plan of an outline.
inline std::shared_ptr<const geometry::PlanRegion> plan_of_outline(const geometry::Outline& outline,
                                                                   double margin_mm = 0.0, double tolerance_mm = 0.01) {
  std::optional<geometry::OutlineFault> fault;
  auto plan = std::make_shared<const geometry::PlanRegion>(plan_region(outline, margin_mm, tolerance_mm, fault));
  EXPECT_FALSE(fault) << fault->text;
  return plan;
}

/// Returns a part whose array is cut by an outline.
inline geometry::PartSpec with_outline(geometry::PartSpec spec, const geometry::Outline& outline,
                                       double margin_mm = 0.0, double tolerance_mm = 0.01) {
  const auto plan = plan_of_outline(outline, margin_mm, tolerance_mm);
  spec.array.x_length_mm = plan->box_mm.size().x();
  spec.array.y_length_mm = plan->box_mm.size().y();
  spec.array.x_offset_mm = spec.array.y_offset_mm = margin_mm;
  spec.array.outline = plan;
  return spec;
}

/// Returns a part with a random outline that has room for at least one element inside its margin.
inline geometry::PartSpec with_random_outline(const geometry::PartSpec& base, std::mt19937& random, double radius_mm,
                                              double margin_mm) {
  while (true) {
    const geometry::Outline outline = geometry::random_outline(random, radius_mm);
    std::optional<geometry::OutlineFault> fault;
    plan_region(outline, margin_mm, 0.01, fault);
    if (fault) continue;
    geometry::PartSpec spec = with_outline(base, outline, margin_mm);
    if (!geometry::whole_elements(spec.array, spec.element).empty()) return spec;
  }
}

/// Returns a parallelogram with rounded corners.
inline geometry::Outline oblique_outline() {
  using namespace geometry;
  return oriented({rounded(polygon_of_corners({{0, 0}, {2.0, 0}, {2.6, 1.4}, {0.6, 1.4}}), 0.3)});
}
/// Returns an L-shaped outline with rounded corners and a curved side.
inline geometry::Outline bent_outline() {
  using namespace geometry;
  return oriented({rounded(
      polygon_of_corners({{0, 0}, {2.2, 0}, {2.2, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0, 2.0}}, {0.1, 0, 0, 0, 0, 0}),
      0.15)});
}
/// Returns a disc with an eccentric hole.
inline geometry::Outline ring_outline() {
  using namespace geometry;
  return oriented({circle({0, 0}, 1.2), circle({0.2, 0.1}, 0.4)});
}
/// Returns an L-shaped outline with sharp corners.
inline geometry::Outline angle_outline() {
  using namespace geometry;
  return oriented({polygon_of_corners({{0, 0}, {1.6, 0}, {1.6, 0.8}, {0.8, 0.8}, {0.8, 1.5}, {0, 1.5}})});
}
/// Returns a rectangle with a triangular hole.
inline geometry::Outline holed_outline() {
  using namespace geometry;
  return oriented({polygon_of_corners({{0, 0}, {1.6, 0}, {1.6, 1.4}, {0, 1.4}}),
                   polygon_of_corners({{0.6, 0.5}, {1.0, 0.6}, {0.8, 0.9}})});
}

}  // namespace retrace::testing
