#pragma once

// Replaces a profile by few straight chords within a tolerance, for lathes that move in straight lines.

#include <cstddef>
#include <vector>

namespace retrace::fabrication {

/// A point of a profile: across and down, in mm.
struct ProfilePoint {
  double x_mm = 0.0;
  double z_mm = 0.0;
};

/// Chords that stand for a profile: indices of the points that they join, first and last included. A chord may join two
/// points if all points between lie within the tolerance of it: the tube of docs/theory/planing.md.
using Chords = std::vector<std::size_t>;

/// From every point to the farthest that a chord reaches, as E. D. Bulatov et al. do it. The fewest for convex
/// profiles; for others not always. \pre two points or more, neighbours apart; tolerance >= 0
Chords longest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm);

/// The fewest chords that there are; of equally many, those of the longest first ones. \pre as longest_chords()
Chords fewest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm);

class ZoneProfile;
/// The points of a flat lens of zones, steps included as upright lines. \param spacing_mm of points within a zone, at
/// most
std::vector<ProfilePoint> points_of(const ZoneProfile& profile, double spacing_mm);

}  // namespace retrace::fabrication
