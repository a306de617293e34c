#include "studies/photometry/measurement_plan.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace retrace::studies {
namespace {

std::size_t index_of(std::vector<double>& values, double value) {
  const auto found = std::find(values.begin(), values.end(), value);
  if (found != values.end()) return static_cast<std::size_t>(found - values.begin());
  values.push_back(value);
  return values.size() - 1;
}

}  // namespace

bool mirrors_source(const design::Design& design) {
  return !design.balls() && !design.entrance && !design.has_deflecting_shells() &&
         !design.idealisation.lossless_entrance;
}

MeasurementPlan measurement_plan(const PhotometrySettings& request, bool mirrors) {
  MeasurementPlan plan;
  std::map<std::tuple<double, double, double>, std::size_t> known;
  for (const TestPoint& point : request.test_plan.points) {
    auto& readings = plan.readings_of_point.emplace_back();
    for (const double v_deg : measured_v_deg(point, mirrors))
      for (const double rotation_deg : request.rotation_deg) {
        const auto [it, is_new] = known.try_emplace({v_deg, point.h_deg, rotation_deg}, plan.settings.size());
        if (is_new) plan.settings.push_back({v_deg, point.h_deg, rotation_deg, {}, 0, request.window_power});
        readings.emplace_back(it->second, index_of(plan.settings[it->second].observation_deg, point.observation_deg));
      }
  }
  return plan;
}

std::vector<std::vector<PhotometricPoint>> readings_of_points(const PhotometrySettings& request,
                                                              const MeasurementPlan& plan, const Readings& readings) {
  std::vector<std::vector<PhotometricPoint>> of_points;
  for (std::size_t k = 0; k < request.test_plan.points.size(); ++k) {
    std::vector<PhotometricPoint>& of_point = of_points.emplace_back();
    for (const auto& [setting, angle] : plan.readings_of_point[k]) {
      if (!readings[setting]) continue;
      const PhotometerReading& reading = *readings[setting];
      PhotometricPoint point;
      point.test_point = request.test_plan.points[k];
      point.v_deg = plan.settings[setting].v_deg;
      point.rotation_deg = plan.settings[setting].rotation_deg;
      point.r_a = reading.r_a[angle];
      point.r_l = reading.r_l[angle];
      const auto in_mcd = [&](double r_a) {
        return in_mcd_per_lx(r_a, PhotometricUnit::cd_per_lx_per_m2, request.area_cm2);
      };
      point.r_i_mcd_per_lx = in_mcd(point.r_a);
      point.std_error_mcd_per_lx = in_mcd(reading.r_a_error[angle]);
      point.limit_mcd_per_lx = in_mcd_per_lx(point.test_point.minimum, point.test_point.unit, request.area_cm2);
      point.lacks_diffraction = reading.lacks_diffraction;
      of_point.push_back(point);
    }
  }
  return of_points;
}

std::vector<PhotometricPoint> smallest_readings(const std::vector<std::vector<PhotometricPoint>>& readings) {
  std::vector<PhotometricPoint> points;
  for (const std::vector<PhotometricPoint>& of_point : readings) {
    if (of_point.empty()) continue;
    PhotometricPoint least = *std::ranges::min_element(of_point, {}, &PhotometricPoint::r_a);
    least.lacks_diffraction = std::ranges::any_of(of_point, &PhotometricPoint::lacks_diffraction);
    points.push_back(least);
  }
  return points;
}

}  // namespace retrace::studies
