#pragma once

// Computes the stepped profile of a zone lens: depth, slope and steps from the hyperbola of each zone.

#include <cstddef>
#include <vector>

#include "fabrication/planing/part.h"

namespace retrace::fabrication {

/// Zone, from its inner step to the next one.
struct Zone {
  double from_mm = 0.0, to_mm = 0.0;
};

/// Depth of a zone lens below the face of its blank (docs/theory/planing.md). In zone k, the optical path from the
/// focus through the lens exceeds the path through the centre by k wavelengths.
class ZoneProfile {
 public:
  /// Computes the zones of a lens.
  /// \pre all values of the lens are in their ranges
  /// \throw InputError if the zones do not fit between lens and focus
  explicit ZoneProfile(const ZoneLens& lens);

  const ZoneLens& lens() const { return lens_; }
  const std::vector<Zone>& zones() const { return zones_; }
  /// Returns the maximum depth: wavelength / (index - 1).
  double step_mm() const { return step_mm_; }
  /// Returns the zone at a position. A step belongs to the zone outside of it.
  /// \pre 0 <= x <= half width
  std::size_t zone_of(double x_mm) const;
  double depth_mm(double x_mm) const { return depth_in_zone_mm(zone_of(x_mm), x_mm); }
  /// Returns the depth according to the formula of one zone. The position may be outside of this zone.
  double depth_in_zone_mm(std::size_t zone, double x_mm) const;
  /// Returns the slope of the depth in a zone. It increases outwards.
  double slope_in_zone(std::size_t zone, double x_mm) const;
  /// Returns the position at which the formula of a zone gives a depth.
  /// \pre the depth is not less than the depth of this formula at the centre
  double position_in_zone_mm(std::size_t zone, double depth_mm) const;
  double steepest_slope() const;

 private:
  double vertex_distance_mm(std::size_t zone) const;

  ZoneLens lens_;
  double step_mm_ = 0.0;
  std::vector<Zone> zones_;
};

}  // namespace retrace::fabrication
