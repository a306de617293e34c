#pragma once

// The path of a round tool nose that touches a zone profile, and the largest nose that fits between its walls.

#include <vector>

#include "fabrication/planing/plan/chords.h"
#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::fabrication {

/// Whether a round nose reaches the bottom of every zone beside its outer wall, and clears the wall's upper end on its
/// way up. \param nose_mm radius, >= 0
bool nose_fits(const ZoneProfile& profile, double nose_mm);

/// The largest nose that fits, to a thousandth. \pre some nose does
double largest_nose_mm(const ZoneProfile& profile);

/// How far the nose may leave its path for what it leaves to keep a tolerance: the edges at the upper ends of walls
/// stand between two flanks, and move by more than either does. Without a nose the tolerance itself.
double path_tolerance_mm(const ZoneProfile& profile, double nose_mm, double tolerance_mm);

/// Where the lowest point of a round nose goes that touches the profile everywhere it can: along it at the radius'
/// distance, up beside every wall, round its upper end. Of a nose without radius points_of().
/// \param spacing_mm of points, at most \param tolerance_mm the arcs between points keep to a thousandth of it
/// \pre the nose fits
std::vector<ProfilePoint> nose_points(const ZoneProfile& profile, double nose_mm, double spacing_mm,
                                      double tolerance_mm);

}  // namespace retrace::fabrication
