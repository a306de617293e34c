#pragma once

// Computes the path of a round tool nose that touches a zone profile, and the largest nose that fits between the walls
// of the profile.

#include <vector>

#include "fabrication/planing/plan/chords.h"
#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::fabrication {

/// Returns true if a round nose reaches the bottom of every zone next to its outer wall, and stays clear of the wall's
/// upper end while it moves up.
/// \param nose_mm radius, >= 0
bool nose_fits(const ZoneProfile& profile, double nose_mm);

/// Returns the radius of the largest nose that fits, with a relative error of at most 1e-4.
/// \pre at least one nose fits
double largest_nose_mm(const ZoneProfile& profile);

/// Returns the maximum deviation of the nose from its path that keeps the machined surface within a tolerance. It is
/// smaller than this tolerance, because an edge at the upper end of a wall is displaced by more than each of its two
/// flanks. For a pointed tool, it is the tolerance itself.
double path_tolerance_mm(const ZoneProfile& profile, double nose_mm, double tolerance_mm);

/// Returns the path of a round nose's lowest point if the nose touches the profile wherever it can. The nose moves
/// along the profile, up next to every wall and around the wall's upper end. For a pointed tool, returns points_of().
/// \param spacing_mm maximum distance of points
/// \param tolerance_mm tolerance of the path. The deviation of arcs between the points is at most a thousandth of it
/// \pre the nose fits
std::vector<ProfilePoint> nose_points(const ZoneProfile& profile, double nose_mm, double spacing_mm,
                                      double tolerance_mm);

}  // namespace retrace::fabrication
