#pragma once

// Approximates a profile by few straight chords within a tolerance, for lathes that move in straight lines.

#include <cstddef>
#include <vector>

namespace retrace::fabrication {

/// Point of a profile: position across the profile and height, in mm.
struct ProfilePoint {
  double x_mm = 0.0;
  double z_mm = 0.0;
};

/// Chords that approximate a profile, as indices of the points that they connect, including the first and the last
/// point. A chord may connect two points if all points between them are within the tolerance of the chord (the tube of
/// docs/theory/planing.md).
using Chords = std::vector<std::size_t>;

/// Returns the chords that result if each chord ends at the farthest point that it can reach (E. D. Bulatov et al.).
/// Their number is the minimum for convex profiles, but not always for other profiles.
/// \pre two points or more, neighbouring points differ; tolerance >= 0
Chords longest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm);

/// Returns the minimum number of chords. Among solutions with equal numbers, the first chords are as long as possible.
/// \pre as for longest_chords()
Chords fewest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm);

class ZoneProfile;
/// Returns points of the profile of a zone lens. Steps are included as vertical lines.
/// \param spacing_mm maximum distance of the points within a zone
std::vector<ProfilePoint> points_of(const ZoneProfile& profile, double spacing_mm);

}  // namespace retrace::fabrication
