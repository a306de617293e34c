#include "studies/rre/rre_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "studies/rre/angle_list.h"

namespace retrace::studies {
namespace {

// Default grid of directions.
constexpr double kLastIncidenceDeg = 80.0;
constexpr std::size_t kIncidences = 17;
constexpr double kLastAzimuthDeg = 350.0;
constexpr std::size_t kAzimuths = 36;
// Maximum distance of adjacent azimuths. With larger distances, a map would show mainly interpolated values.
constexpr double kMaxGapDeg = 120.0;

double reduced_azimuth(double deg) {
  const double reduced = deg - 360.0 * std::floor(deg / 360.0);
  return 360.0 - reduced < kSameAngleDeg ? 0.0 : reduced;
}

/// Returns the azimuth after the one with the given index, which is above 360 degrees after the last one.
double next_azimuth(const std::vector<double>& azimuth_deg, std::size_t k) {
  return k + 1 < azimuth_deg.size() ? azimuth_deg[k + 1] : azimuth_deg.front() + 360.0;
}

/// Returns the fraction of the full circle that each azimuth represents: half of the distances to its neighbours.
std::vector<double> weights_of(const std::vector<double>& azimuth_deg) {
  std::vector<double> weights(azimuth_deg.size(), 0.0);
  for (std::size_t k = 0; k < azimuth_deg.size(); ++k) {
    const double half = 0.5 * (next_azimuth(azimuth_deg, k) - azimuth_deg[k]) / 360.0;
    weights[k] += half;
    weights[(k + 1) % azimuth_deg.size()] += half;
  }
  return weights;
}

void check_incidences(const std::vector<double>& incidence_deg) {
  const bool is_suitable = incidence_deg.size() >= 2 && incidence_deg.front() >= 0.0;
  if (!is_suitable)
    throw InputError(
        Field{"incidence_deg"},
        fmt::format("a map needs at least two angles of incidence, each 0 or more, got {} from {} to {}",
                    incidence_deg.size(), shortest(incidence_deg.front()), shortest(incidence_deg.back())));
}

void check_azimuths(const std::vector<double>& azimuth_deg) {
  double gap = 0.0;
  for (std::size_t k = 0; k < azimuth_deg.size(); ++k)
    gap = std::max(gap, next_azimuth(azimuth_deg, k) - azimuth_deg[k]);
  if (gap > kMaxGapDeg + kSameAngleDeg)
    throw InputError(Field{"azimuth_deg"},
                     fmt::format("a map needs azimuths around the full circle with gaps of at most {} degrees, got a "
                                 "gap of {} degrees",
                                 shortest(kMaxGapDeg), shortest(gap)));
}

}  // namespace

void resolve_grid(RreSettings& settings) {
  if (!settings.incidence_spans.empty())
    throw InputError(Field{"incidence_deg"}, "a map needs a list of angles of incidence without automatic ranges");
  if (settings.incidence_deg.empty()) settings.incidence_deg = equidistant(kLastIncidenceDeg, kIncidences);
  if (settings.azimuth_deg.empty()) settings.azimuth_deg = equidistant(kLastAzimuthDeg, kAzimuths);
  for (double& azimuth : settings.azimuth_deg) azimuth = reduced_azimuth(azimuth);
  sort_and_remove_repeated(settings.incidence_deg);
  sort_and_remove_repeated(settings.azimuth_deg);
  check_incidences(settings.incidence_deg);
  check_azimuths(settings.azimuth_deg);
}

std::vector<std::vector<double>> RreMap::rows(const std::vector<double>& values) const {
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < azimuth_deg.size(); ++k) {
    const std::span<const double> values_of_azimuth = row(values, k);
    rows.emplace_back(values_of_azimuth.begin(), values_of_azimuth.end());
  }
  return rows;
}

double RreMap::at(double incidence, double azimuth) const {
  if (!(incidence >= incidence_deg.front() && incidence <= incidence_deg.back()))
    return std::numeric_limits<double>::quiet_NaN();
  const auto above = std::upper_bound(incidence_deg.begin() + 1, incidence_deg.end() - 1, incidence);
  const auto i = static_cast<std::size_t>(above - incidence_deg.begin()) - 1;
  const double t = (incidence - incidence_deg[i]) / (incidence_deg[i + 1] - incidence_deg[i]);
  const double reduced = reduced_azimuth(azimuth);
  const auto after = std::upper_bound(azimuth_deg.begin(), azimuth_deg.end(), reduced);
  const std::size_t k =
      after == azimuth_deg.begin() ? azimuth_deg.size() - 1 : static_cast<std::size_t>(after - azimuth_deg.begin()) - 1;
  const std::size_t next = (k + 1) % azimuth_deg.size();
  const double beyond = reduced < azimuth_deg[k] ? reduced + 360.0 : reduced;
  const double u = (beyond - azimuth_deg[k]) / (next_azimuth(azimuth_deg, k) - azimuth_deg[k]);
  const auto along = [&](std::size_t column) { return std::lerp(rre[index(i, column)], rre[index(i + 1, column)], t); };
  return std::lerp(along(k), along(next), u);
}

double RreMap::mean_at(std::size_t incidence) const {
  const std::vector<double> weights = weights_of(azimuth_deg);
  double mean = 0.0;
  for (std::size_t k = 0; k < azimuth_deg.size(); ++k) mean += weights[k] * rre[index(incidence, k)];
  return mean;
}

double RreMap::mean() const {
  // The integral of sin(t) f(t) over an interval of length h is f1 (c1 - c2) + (f2 - f1) / h (s2 - s1 - h c2) for
  // linear f, with the sines and cosines of the interval's ends.
  double sum = 0.0;
  double whole = 0.0;
  for (std::size_t i = 0; i + 1 < incidence_deg.size(); ++i) {
    const double from = std::numbers::pi / 180.0 * incidence_deg[i];
    const double to = std::numbers::pi / 180.0 * incidence_deg[i + 1];
    const double solid_angle = std::cos(from) - std::cos(to);
    const double slope = (mean_at(i + 1) - mean_at(i)) / (to - from);
    sum += mean_at(i) * solid_angle + slope * (std::sin(to) - std::sin(from) - (to - from) * std::cos(to));
    whole += solid_angle;
  }
  return sum / whole;
}

namespace {

/// Index of a value in an ascending list that contains it.
std::size_t index_in(const std::vector<double>& values, double value) {
  return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

std::vector<double> distinct(const std::vector<RrePoint>& points, double RrePoint::*member) {
  std::vector<double> values;
  for (const RrePoint& point : points) values.push_back(point.*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Returns the maps of one design, one for each acceptance cone in the order of the points.
std::vector<RreMap> maps_of(const std::vector<RrePoint>& points) {
  const std::vector<double> incidences = distinct(points, &RrePoint::incidence_deg);
  const std::vector<double> azimuths = distinct(points, &RrePoint::azimuth_deg);
  const std::vector<double> cones = distinct(points, &RrePoint::acceptance_half_angle_deg);
  std::vector<RreMap> maps;
  for (const double cone : cones)
    maps.push_back({points.front().design, cone, incidences, azimuths,
                    std::vector<double>(incidences.size() * azimuths.size()),
                    std::vector<double>(incidences.size() * azimuths.size())});
  for (const RrePoint& point : points) {
    RreMap& map = maps[index_in(cones, point.acceptance_half_angle_deg)];
    const std::size_t k = map.index(index_in(incidences, point.incidence_deg), index_in(azimuths, point.azimuth_deg));
    map.rre[k] = point.rre;
    map.std_error[k] = point.std_error;
  }
  return maps;
}

}  // namespace

std::vector<RreMap> rre_maps(const RreResult& result) {
  std::vector<RreMap> maps;
  if (!result.has_complete_maps()) return maps;
  for (std::size_t d = 0; d < result.designs.size(); ++d) {
    std::vector<RrePoint> points;
    std::copy_if(result.points.begin(), result.points.end(), std::back_inserter(points),
                 [d](const RrePoint& point) { return point.design == d; });
    if (points.empty()) continue;
    for (RreMap& map : maps_of(points)) maps.push_back(std::move(map));
  }
  return maps;
}

RreMap difference(const RreMap& a, const RreMap& b) {
  RreMap result = b;
  for (std::size_t k = 0; k < b.rre.size(); ++k) {
    result.rre[k] = b.rre[k] - a.rre[k];
    result.std_error[k] = std::hypot(a.std_error[k], b.std_error[k]);
  }
  return result;
}

}  // namespace retrace::studies
