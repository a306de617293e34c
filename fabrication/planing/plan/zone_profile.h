#pragma once

// The stepped profile of a zone lens: depth, slope and steps by the hyperbola of each zone.

#include <cstddef>
#include <vector>

#include "fabrication/planing/part.h"

namespace retrace::fabrication {

/// One zone, from its step towards the middle to the next one.
struct Zone {
  double from_mm = 0.0;
  double to_mm = 0.0;
};

/// The depth of a zone lens below the face of its blank (docs/theory/planing.md): within zone k the optical path from
/// the focus through the lens is that of the middle and k wavelengths more.
class ZoneProfile {
 public:
  /// \pre the values are in range \throw InputError if the zones do not fit between lens and focus
  explicit ZoneProfile(const ZoneLens& lens);

  const ZoneLens& lens() const { return lens_; }
  const std::vector<Zone>& zones() const { return zones_; }
  /// Largest depth: wavelength / (index - 1).
  double step_mm() const { return step_mm_; }
  /// The zone that holds a place; a step belongs to the zone outside. \pre 0 <= x <= half width
  std::size_t zone_of(double x_mm) const;
  double depth_mm(double x_mm) const { return depth_in_zone_mm(zone_of(x_mm), x_mm); }
  /// The same by the formula of one zone, also beyond its ends.
  double depth_in_zone_mm(std::size_t zone, double x_mm) const;
  /// Slope of the depth in a zone; it grows outwards.
  double slope_in_zone(std::size_t zone, double x_mm) const;
  /// Where a zone's formula has that depth. \pre depth >= that of the middle
  double place_in_zone_mm(std::size_t zone, double depth_mm) const;
  double steepest_slope() const;

 private:
  double vertex_distance_mm(std::size_t zone) const;

  ZoneLens lens_;
  double step_mm_ = 0.0;
  std::vector<Zone> zones_;
};

}  // namespace retrace::fabrication
