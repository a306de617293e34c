#pragma once

// What a round tool nose leaves in a section: envelopes of circles along a line, and distances between sections.

#include <vector>

namespace retrace::fabrication {

/// A place of a section: radius and height, mm.
struct SectionPoint {
  double x_mm = 0.0;
  double z_mm = 0.0;
};
/// A line of places whose x does not fall; upright pieces have both ends.
using SectionLine = std::vector<SectionPoint>;

/// What a round nose leaves whose centre goes along a line. \param places where, rising; upright walls that the nose
/// leaves are added \param centres x does not fall \pre nose > 0
SectionLine left_by_nose(const SectionLine& centres, double nose_mm, const std::vector<double>& places_mm);

/// The lowest places of the nose's centre over a section that it does not cut. \pre as above
SectionLine lowest_centres(const SectionLine& section, double nose_mm, const std::vector<double>& places_mm);

/// Largest distance of places from a line. Pieces farther than `reach` along x are not looked at: where none is near
/// the distance is the largest number.
double largest_distance(const SectionLine& places, const SectionLine& line, double reach_mm);

}  // namespace retrace::fabrication
