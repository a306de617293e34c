#pragma once

// The profile that a zone lens should have, from its optical path condition alone: the reference of the checks,
// independent of the planner's formulas.

#include <vector>

#include "fabrication/planing/part.h"

namespace retrace::fabrication {

/// An upright wall between two zones: the deep side is towards the middle.
struct Wall {
  double x_mm = 0.0;
  double inner_depth_mm = 0.0;
  double outer_depth_mm = 0.0;
};

/// The depth that a lens of zones asks for, from the condition that makes it a lens: the way of light from the focus
/// through the profile, parallel to the axis behind it, is that through the middle and whole wavelengths more, at a
/// depth of at most wavelength / (index - 1). Every depth is the root of that condition; no formula is shared with the
/// planner.
class PhaseProfile {
 public:
  /// \pre the lens has zones as a planned one
  explicit PhaseProfile(const ZoneLens& lens);

  /// \pre 0 <= x <= half width
  double depth_mm(double x_mm) const;
  /// How fast the depth grows there within its zone. \param x_mm, depth_mm on the profile
  double slope(double x_mm, double depth_mm) const;
  const std::vector<Wall>& walls() const { return walls_; }

 private:
  /// How many wavelengths the way through a depth is longer than that through the middle.
  double waves(double x_mm, double depth_mm) const;
  double depth_of_order_mm(double x_mm, double order) const;

  ZoneLens lens_;
  double deepest_mm_ = 0.0;
  std::vector<Wall> walls_;
};

/// Of the tool of a planing mill, depth over distance: as the steepest place of the profile, rounded up to half a
/// degree.
double flank_slope_of(const PhaseProfile& profile, double half_width_mm);

}  // namespace retrace::fabrication
