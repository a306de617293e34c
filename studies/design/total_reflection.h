#pragma once

// Limits of total internal reflection of prisms and cube corners over incidence and azimuth, in closed form.

#include <optional>
#include <vector>

#include "core/angle.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// Largest incidence of total reflection for a part's elements at this index, of what is behind them; closed form.
/// \pre both >= 1
std::optional<double> tir_limit_deg(const geometry::PartSpec& part, double index, double back_index);

/// The azimuth of the light whose total reflection ends first; 0 to below 360, the least of equal ones.
double tir_limit_azimuth_deg(const geometry::PartSpec& part);

/// Least incidence at this azimuth at which every facet reflects the retroreflected light totally; none if there is
/// none. \pre both >= 1
std::optional<double> total_reflection_from_deg(const geometry::PartSpec& part, double index, double back_index,
                                                Angle azimuth);

/// All angles of incidence between -90 and 90 degrees at this azimuth at which the total reflection of retroreflected
/// light begins or ends at a facet, be it met first or after others; ascending. RRE has kinks there. \pre both >= 1
std::vector<double> total_reflection_edges_deg(const geometry::PartSpec& part, double index, double back_index,
                                               Angle azimuth);

/// Returns the margin of total reflection for each facet and each order in which light can hit the facets of an
/// element. The margin is cos(i) - cos(c), where i is the angle of incidence on the facet and c the critical angle.
/// Light is totally reflected if the margin is below 0. Just above 0, the reflectance falls like the square root of the
/// margin.
/// \param to_source unit vector towards the source, outside the part
/// \param index refractive index of the part
/// \param back_index refractive index of the medium behind the facets
/// \pre both indices are >= 1
std::vector<double> total_reflection_margins(const geometry::PartSpec& part, const geometry::Vec3& to_source,
                                             double index, double back_index);

}  // namespace retrace::studies
