#pragma once

// Geometries in which a photometric study measures, and the readings of the test points that follow from them.

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "studies/photometry/photometer.h"
#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Geometries that are measured (settings). Each direction of light has one setting with all its observation angles.
struct MeasurementPlan {
  std::vector<PhotometerSetting> settings;
  /// Readings of each test point, as pairs of the indices of setting and observation angle.
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> readings_of_point;
};

/// Returns true if the entrance face reflects the lamp back to the lamp for perpendicular light.
bool mirrors_source(const design::Design& design);

/// Returns the angles V at which a test point or a colour is measured.
/// \param mirrors true if the entrance face reflects the lamp back to the lamp
template <class Point>
std::vector<double> measured_v_deg(const Point& point, bool mirrors) {
  return mirrors && !point.substitute_v_deg.empty() ? point.substitute_v_deg : std::vector{point.v_deg};
}

/// Returns the settings that are measured for the test points of a request.
/// \param mirrors true if the entrance face reflects the lamp back to the lamp
MeasurementPlan measurement_plan(const PhotometrySettings& request, bool mirrors);

/// Readings of all settings. An entry is empty if the setting was not measured.
using Readings = std::vector<std::optional<PhotometerReading>>;

/// Returns all readings of each test point, in the order of the points. A list is empty if its point was not measured.
std::vector<std::vector<PhotometricPoint>> readings_of_points(const PhotometrySettings& request,
                                                              const MeasurementPlan& plan, const Readings& readings);

/// Returns the reading with the minimum value for each test point that was measured.
std::vector<PhotometricPoint> smallest_readings(const std::vector<std::vector<PhotometricPoint>>& readings);

}  // namespace retrace::studies
