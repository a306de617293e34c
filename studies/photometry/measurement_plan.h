#pragma once

// Determines the geometries in which a photometric study measures, and collects the readings of each test point.

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "studies/photometry/photometer.h"
#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Geometries to be measured. Each direction of light has one setting, which contains all observation angles.
struct MeasurementPlan {
  std::vector<PhotometerSetting> settings;
  /// For each test point, the readings that belong to it. Each pair contains the index of a setting and the index of an
  /// observation angle of this setting.
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> readings_of_point;
};

/// Returns true if the entrance face reflects perpendicular light of the lamp back to the lamp.
bool mirrors_source(const design::Design& design);

/// Returns the angles V at which a test point or a colour is measured.
/// \param mirrors result of mirrors_source()
template <class Point>
std::vector<double> measured_v_deg(const Point& point, bool mirrors) {
  return mirrors && !point.substitute_v_deg.empty() ? point.substitute_v_deg : std::vector{point.v_deg};
}

/// Returns the settings to be measured for the test points of a request.
/// \param mirrors result of mirrors_source()
MeasurementPlan measurement_plan(const PhotometrySettings& request, bool mirrors);

/// Readings of all settings. The entries of settings that were not measured are empty.
using Readings = std::vector<std::optional<PhotometerReading>>;

/// Returns the readings of each test point, in the order of the points. The list of a point that was not measured is
/// empty.
std::vector<std::vector<PhotometricPoint>> readings_of_points(const PhotometrySettings& request,
                                                              const MeasurementPlan& plan, const Readings& readings);

/// Returns the smallest reading of each test point that was measured.
std::vector<PhotometricPoint> smallest_readings(const std::vector<std::vector<PhotometricPoint>>& readings);

}  // namespace retrace::studies
