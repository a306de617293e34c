#pragma once

// Limits of total internal reflection in prisms and cube corners, as functions of incidence and azimuth, in closed
// form.

#include <optional>
#include <vector>

#include "core/angle.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Returns the maximum angle of incidence up to which the elements of a part reflect totally at every azimuth.
/// \param index refractive index of the part
/// \param back_index refractive index of the medium behind the facets
/// \pre both indices are >= 1
std::optional<double> tir_limit_deg(const geometry::PartSpec& part, double index, double back_index);

/// Returns the azimuth of the light for which total reflection ends at the smallest incidence, from 0 to below 360
/// degrees. If several azimuths are equivalent, returns the smallest.
double tir_limit_azimuth_deg(const geometry::PartSpec& part);

/// Returns the minimum incidence at this azimuth at which every facet reflects the retroreflected light totally.
/// Returns nothing if there is no such incidence.
/// \pre both indices are >= 1
std::optional<double> total_reflection_from_deg(const geometry::PartSpec& part, double index, double back_index,
                                                Angle azimuth);

/// Returns all angles of incidence at this azimuth at which total reflection of retroreflected light begins or ends at
/// a facet. The angles are between -90 and 90 degrees and in ascending order. The facet may be the first, second or
/// third that light hits. As a function of incidence, RRE (the retroreflective efficiency) has kinks at these angles.
/// \pre both indices are >= 1
std::vector<double> total_reflection_edges_deg(const geometry::PartSpec& part, double index, double back_index,
                                               Angle azimuth);

/// Returns the margin of total reflection for each facet and each order in which light can hit the facets of an
/// element. The margin is cos(i) - cos(c), where i is the angle of incidence on the facet and c the critical angle.
/// Light is totally reflected if the margin is below 0. Just above 0, the loss of reflectance increases with the square
/// root of the margin.
/// \param to_source unit vector towards the source, outside the part
/// \param index refractive index of the part
/// \param back_index refractive index of the medium behind the facets
/// \pre both indices are >= 1
std::vector<double> total_reflection_margins(const geometry::PartSpec& part, const geometry::Vec3& to_source,
                                             double index, double back_index);

}  // namespace retrace::design
