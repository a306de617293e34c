#include "studies/photometry/coefficient_map.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/number_format.h"
#include "studies/photometry/photometer.h"
#include "studies/rre/angle_list.h"

namespace retrace::studies {
namespace {

// Default grid.
constexpr double kLastEntranceDeg = 60.0;
constexpr std::size_t kEntranceAngles = 13;
constexpr std::size_t kObservationAngles = 41;

void check_count(const std::vector<double>& values, Field field) {
  if (values.size() < 2)
    throw InputError(field, fmt::format("a map needs at least two different angles, got {}", shortest(values.front())));
}

}  // namespace

std::vector<std::vector<double>> CoefficientMap::rows(const std::vector<double>& values) const {
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < entrance_deg.size(); ++k) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(index(k, 0));
    rows.emplace_back(first, first + std::ssize(observation_deg));
  }
  return rows;
}

CoefficientGrid resolve_grid(CoefficientGrid grid, double window_deg) {
  if (grid.entrance_deg.empty()) grid.entrance_deg = equidistant(kLastEntranceDeg, kEntranceAngles);
  if (grid.observation_deg.empty()) grid.observation_deg = equidistant(window_deg, kObservationAngles);
  if (grid.presentation_deg.empty()) grid.presentation_deg = {0.0};
  for (std::vector<double>* const list : {&grid.entrance_deg, &grid.observation_deg, &grid.presentation_deg})
    sort_and_remove_repeated(*list);
  check_count(grid.entrance_deg, Field{"map_entrance_deg"});
  check_count(grid.observation_deg, Field{"map_observation_deg"});
  if (grid.observation_deg.back() > window_deg)
    throw InputError(
        Field{"map_observation_deg"},
        fmt::format("angles must be within the computed far field ({} {}), got {}", reference({"window_deg"}),
                    shortest(window_deg), shortest(grid.observation_deg.back())));
  return grid;
}

PhotometerSetting setting_at(double entrance_deg, double presentation_deg, double rotation_deg) {
  PhotometerSetting setting;
  setting.rotation_deg = rotation_deg;
  // At multiples of 90 degrees, the general formulas would only add rounding errors to V and H.
  if (presentation_deg == 0.0 || std::abs(presentation_deg) == 180.0) {
    setting.v_deg = (presentation_deg == 0.0 ? -entrance_deg : entrance_deg) + 0.0;
  } else if (std::abs(presentation_deg) == 90.0) {
    setting.h_deg = (presentation_deg > 0.0 ? -entrance_deg : entrance_deg) + 0.0;
  } else {
    const double entrance = Angle::from_deg(entrance_deg).rad();
    const double presentation = Angle::from_deg(presentation_deg).rad();
    const double beta1 = std::atan(std::tan(entrance) * std::cos(presentation));
    const double beta2 = std::asin(std::sin(entrance) * std::sin(presentation));
    setting.v_deg = -Angle::from_rad(beta1).deg();
    setting.h_deg = -Angle::from_rad(beta2).deg();
  }
  return setting;
}

std::optional<DesignMaps> measure_maps(const Photometer& photometer, const PhotometrySettings& settings,
                                       std::size_t design, Progress* progress, const Cancellation* cancel) {
  const CoefficientGrid& grid = *settings.map_grid;
  DesignMaps result;
  std::vector<PhotometerSetting> measured;
  for (const double rotation_deg : settings.rotation_deg)
    for (const double presentation_deg : grid.presentation_deg) {
      result.maps.push_back(
          {design, rotation_deg, presentation_deg, grid.entrance_deg, grid.observation_deg, {}, {}, false});
      for (const double entrance_deg : grid.entrance_deg) {
        measured.push_back(setting_at(entrance_deg, presentation_deg, rotation_deg));
        measured.back().observation_deg = grid.observation_deg;
      }
    }
  Photometer sharing = photometer;
  sharing.share_rotations();
  const auto readings = sharing.measure(measured, progress, cancel);
  if (!readings) return std::nullopt;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    CoefficientMap& map = result.maps[k / grid.entrance_deg.size()];
    const PhotometerReading& reading = (*readings)[k];
    map.r_a.insert(map.r_a.end(), reading.r_a.begin(), reading.r_a.end());
    map.std_error.insert(map.std_error.end(), reading.r_a_error.begin(), reading.r_a_error.end());
    map.lacks_diffraction = map.lacks_diffraction || reading.lacks_diffraction;
  }
  result.directions = measured.size();
  result.traced_directions = sharing.is_exact() ? sharing.group_equivalent_settings(measured).size() : measured.size();
  return result;
}

CoefficientMap ratio(const CoefficientMap& a, const CoefficientMap& b) {
  CoefficientMap result = b;
  for (std::size_t k = 0; k < b.r_a.size(); ++k) {
    const bool is_defined = a.r_a[k] > 0.0;
    const double value = is_defined ? b.r_a[k] / a.r_a[k] : std::numeric_limits<double>::quiet_NaN();
    result.r_a[k] = value;
    result.std_error[k] = is_defined ? std::hypot(b.std_error[k], value * a.std_error[k]) / a.r_a[k] : value;
  }
  result.lacks_diffraction = a.lacks_diffraction || b.lacks_diffraction;
  return result;
}

std::vector<CoefficientMap> ratio_maps(const PhotometryResult& result) {
  std::vector<CoefficientMap> ratios;
  const std::size_t each = result.coefficient_maps.size() / 2;
  if (!result.request.compared) return ratios;
  for (std::size_t k = 0; k < each; ++k)
    ratios.push_back(ratio(result.coefficient_maps[k], result.coefficient_maps[each + k]));
  return ratios;
}

}  // namespace retrace::studies
