#pragma once

// Computes the required profile of a zone lens directly from its optical path condition. The checks use it as a
// reference that is independent of the planner's formulas.

#include <vector>

#include "fabrication/planing/part.h"

namespace retrace::fabrication {

/// Vertical wall between two zones. Its deep side is towards the centre of the lens.
struct Wall {
  double x_mm = 0.0, inner_depth_mm = 0.0, outer_depth_mm = 0.0;
};

/// Required depth of a zone lens. The depth follows from the condition that light from the focus becomes parallel to
/// the axis: the optical path through the profile exceeds the path through the centre by a whole number of wavelengths.
/// The depth is at most wavelength / (index - 1). Every depth is computed as the root of this condition. The planner's
/// formulas are not used.
class PhaseProfile {
 public:
  /// \pre the lens has zones for which ZoneProfile can be constructed
  explicit PhaseProfile(const ZoneLens& lens);

  /// Returns the depth at a distance from the centre.
  /// \pre 0 <= x <= half width
  double depth_mm(double x_mm) const;
  /// Returns the slope of the depth within a zone.
  /// \param x_mm position of a point of the profile
  /// \param depth_mm depth of this point
  double slope(double x_mm, double depth_mm) const;
  const std::vector<Wall>& walls() const { return walls_; }

 private:
  /// Returns the difference between the optical path through a point and the path through the centre, in wavelengths.
  double waves(double x_mm, double depth_mm) const;
  double depth_of_order_mm(double x_mm, double order) const;

  ZoneLens lens_;
  double deepest_mm_ = 0.0;
  std::vector<Wall> walls_;
};

/// Returns the slope of the flank of a planing mill's tool, as depth divided by distance. It is the maximum slope of
/// the profile, rounded up to half a degree.
double flank_slope_of(const PhaseProfile& profile, double half_width_mm);

}  // namespace retrace::fabrication
