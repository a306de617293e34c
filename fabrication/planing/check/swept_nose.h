#pragma once

// Computes the surface that a round tool nose produces in a cross-section: envelopes of circles along a line, and
// distances between sections.

#include <vector>

namespace retrace::fabrication {

/// Point of a cross-section: radius and height, in mm.
struct SectionPoint {
  double x_mm = 0.0;
  double z_mm = 0.0;
};
/// Line of points whose x does not decrease. A vertical segment is given by both of its ends.
using SectionLine = std::vector<SectionPoint>;

/// Returns the surface that a round nose produces while its centre moves along a line.
/// \param centres path of the centre; x does not decrease
/// \param positions_mm positions of the points of the result, ascending. Positions at vertical walls that the nose
///        produces are added
/// \pre nose_mm > 0
SectionLine nose_envelope(const SectionLine& centres, double nose_mm, const std::vector<double>& positions_mm);

/// Returns the lowest positions of the nose's centre at which the nose does not cut into a section.
/// \pre as for nose_envelope()
SectionLine lowest_centres(const SectionLine& section, double nose_mm, const std::vector<double>& positions_mm);

/// Returns the largest distance of points from a line. Segments that are farther than `reach_mm` along x are ignored.
/// If no segment is near a point, the result is the largest number of its type.
double largest_distance(const SectionLine& points, const SectionLine& line, double reach_mm);

}  // namespace retrace::fabrication
