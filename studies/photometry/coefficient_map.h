#pragma once

// Maps of the coefficient of retroreflection R_A over entrance and observation angle.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "studies/photometry/photometry.h"

namespace retrace::studies {

class Photometer;
struct PhotometerSetting;

/// Checks the grid of a request and returns it in the form that measure_maps() needs. Empty lists are replaced by the
/// defaults, lists are sorted, and repeated angles are removed.
/// \throw InputError at `map_observation_deg` if an angle is outside of the window of the far field, or at the field of
/// a list with fewer than two entrance or observation angles
CoefficientGrid resolve_grid(CoefficientGrid grid, double window_deg);

/// Returns the geometry for an entrance angle and a presentation angle. The angles V and H are computed from the
/// components beta1 and beta2 of the entrance angle (ASTM E808, docs/theory/photometry.md). A negative entrance angle
/// has the same meaning as its absolute value at the presentation angle plus 180 degrees.
/// \param entrance_deg angle between the normal and the direction to the source, in (-90, 90)
/// \param presentation_deg angle of rotation about the direction to the source; at 0, the observer is on the side of
///     the normal
PhotometerSetting setting_at(double entrance_deg, double presentation_deg, double rotation_deg);

/// Maps of one design, for each rotation and presentation angle.
struct DesignMaps {
  std::vector<CoefficientMap> maps;
  std::size_t directions = 0;         ///< number of directions of light of all maps
  std::size_t traced_directions = 0;  ///< number of directions that were traced; symmetric directions share one
};

/// Measures the maps of a design. A single trace serves all observation angles of a direction of light and, with beams,
/// all directions that symmetries of the part map to each other. Returns nothing if the measurement was cancelled.
/// \param photometer photometer of the design
/// \param design index of the design, which is stored in the maps
/// \pre settings.map_grid
std::optional<DesignMaps> measure_maps(const Photometer& photometer, const PhotometrySettings& settings,
                                       std::size_t design, Progress* progress, const Cancellation* cancel);

/// Returns the map with the ratios b / a. Ratios are NaN where a is 0. The standard errors of the ratios follow from
/// linear propagation of independent errors.
/// \pre both maps have the same grid
CoefficientMap ratio(const CoefficientMap& a, const CoefficientMap& b);

/// Returns the ratios of the maps of the second design to those of the first one. Empty unless there are two designs.
std::vector<CoefficientMap> ratio_maps(const PhotometryResult& result);

}  // namespace retrace::studies
