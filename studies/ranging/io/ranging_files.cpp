#include "studies/ranging/io/ranging_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/angle.h"
#include "core/csv.h"
#include "core/json_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMicroradPerRad = 1e6;
constexpr double kM2PerMillion = 1e6;
constexpr double kPsPerMm = 2.0 / kLightMmPerPs;

Json statistics_json(const AnnulusStatistics& s) {
  return {{"mean_m2", s.mean}, {"min_m2", s.min}, {"max_m2", s.max}};
}

Json centre_json(const ByPolarisation<double>& value) {
  Json json = {{"total_m2", value.total}};
  if (value.parallel) json["parallel_m2"] = *value.parallel;
  if (value.crossed) json["crossed_m2"] = *value.crossed;
  return json;
}

Json annulus_json(const ByPolarisation<AnnulusStatistics>& value) {
  Json json = {{"total", statistics_json(value.total)}};
  if (value.parallel) json["parallel"] = statistics_json(*value.parallel);
  if (value.crossed) json["crossed"] = statistics_json(*value.crossed);
  return json;
}

Json shots_json(const std::vector<Shot>& shots) {
  const ShotSummary s = summary_of(shots);
  return {{"count", shots.size()},
          {"mean_m2", s.mean_m2},
          {"deviation_m2", s.deviation_m2},
          {"min_m2", s.min_m2},
          {"max_m2", s.max_m2},
          {"centroid_mean_mm", s.centroid_mean_mm},
          {"centroid_deviation_mm", s.centroid_deviation_mm}};
}

Json ranges_json(const RangingPoint& p) {
  if (!p.ranges.has_light()) return Json::object({{"lit_cubes", p.lit_cubes}});
  return {{"lit_cubes", p.lit_cubes},
          {"traced_cubes", p.traced_cubes},
          {"cross_section_m2", p.ranges.cross_section_m2},
          {"centroid_mm", p.ranges.centroid_mm},
          {"centroid_correction_mm", -p.ranges.centroid_mm},
          {"rms_mm", p.ranges.rms_mm},
          {"nearest_mm", p.ranges.nearest_mm},
          {"farthest_mm", p.ranges.farthest_mm}};
}

Json point_json(const RangingPoint& p, bool is_array) {
  Json json = {{"wavelength_nm", p.index.wavelength_nm}, {"incidence_deg", p.incidence_deg},
               {"azimuth_deg", p.azimuth_deg},           {"index", p.index.index},
               {"group_index", p.index.group_index},     {"mirror_m2", p.mirror_m2},
               {"centre", centre_json(p.centre)},        {"diffracted_power", p.diffracted_power}};
  if (p.annulus) json["annulus"] = annulus_json(*p.annulus);
  if (p.range_correction_mm) json["range_correction_mm"] = *p.range_correction_mm;
  if (p.usual_range_correction_mm) json["usual_range_correction_mm"] = *p.usual_range_correction_mm;
  if (is_array) json["ranges"] = ranges_json(p);
  if (!p.shots.empty()) json["shots"] = shots_json(p.shots);
  return json;
}

Json request_json(const RangingSettings& settings) {
  const RangingRequest& asked = settings.request;
  Json json = {{"seed", asked.seed},
               {"polarisation", asked.polarisation},
               {"sent_stokes", settings.sent.values()},
               {"source_arcsec", asked.source_arcsec},
               {"receiver_arcsec", asked.receiver_arcsec},
               {"entrance_reflections", asked.entrance_reflections}};
  if (settings.annulus)
    json["aberration"] = {{"inner_arcsec", settings.annulus->inner_rad * kArcsecPerRad},
                          {"outer_arcsec", settings.annulus->outer_rad * kArcsecPerRad},
                          {"inner_urad", settings.annulus->inner_rad * kMicroradPerRad},
                          {"outer_urad", settings.annulus->outer_rad * kMicroradPerRad}};
  if (asked.orbit_km) json["orbit"] = {{"height_km", *asked.orbit_km}, {"min_elevation_deg", asked.elevation_deg}};
  if (!settings.is_array()) return json;
  json["cubes"] = {{"file", asked.cubes.string()}, {"count", settings.cubes.size()}};
  json["observation_arcsec"] = {settings.observation_rad.x() * kArcsecPerRad,
                                settings.observation_rad.y() * kArcsecPerRad};
  if (asked.pulse_ps) json["pulse_ps"] = *asked.pulse_ps;
  return json;
}

/// Returns a cross section as text, in units of 10^6 m2 with about four significant digits.
std::string millions(double m2) {
  const double value = m2 / kM2PerMillion;
  if (!(std::abs(value) > 0.0)) return "0";
  const int digits = std::clamp(3 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 12);
  return fixed(value, digits);
}

std::string heading(const RangingResult& result) {
  const RangingSettings& settings = result.settings;
  std::string text = fmt::format("entrance face {} mm2, apex {} mm behind it\n", fixed(result.entrance_mm2, 3),
                                 fixed(result.depth_mm, 4));
  if (settings.annulus)
    text += fmt::format("velocity aberration {} to {} arcsec, {} to {} microrad\n",
                        fixed(settings.annulus->inner_rad * kArcsecPerRad, 4),
                        fixed(settings.annulus->outer_rad * kArcsecPerRad, 4),
                        fixed(settings.annulus->inner_rad * kMicroradPerRad, 3),
                        fixed(settings.annulus->outer_rad * kMicroradPerRad, 3));
  return text + "cross sections in 10^6 m2, for all polarisations of the returned light\n";
}

std::string share_text(const std::optional<double>& part) {
  return part ? millions(*part) : "-";
}

}  // namespace

std::string ranging_json(const RangingResult& result) {
  Json json = {{"design", design::to_json(result.design)}};
  json.update(request_json(result.settings));
  json["entrance_mm2"] = result.entrance_mm2;
  json["depth_mm"] = result.depth_mm;
  json["points"] = Json::array();
  for (const RangingPoint& p : result.points) json["points"].push_back(point_json(p, result.settings.is_array()));
  Json rings = {{"radius_arcsec", Json::array()},
                {"mean_m2", Json::array()},
                {"min_m2", Json::array()},
                {"max_m2", Json::array()}};
  for (std::size_t k = 0; k < result.map.ring_rad.size(); ++k) {
    rings["radius_arcsec"].push_back(result.map.ring_rad[k] * kArcsecPerRad);
    rings["mean_m2"].push_back(result.map.ring_m2[k].mean);
    rings["min_m2"].push_back(result.map.ring_m2[k].min);
    rings["max_m2"].push_back(result.map.ring_m2[k].max);
  }
  json["rings"] = std::move(rings);
  json["elapsed_s"] = result.elapsed_s;
  return result_text("retrace.ranging/1", json, result.warnings, result.complete);
}

std::string ranging_csv(const RangingResult& result) {
  CsvWriter csv(
      "wavelength_nm,incidence_deg,azimuth_deg,mirror_m2,centre_m2,centre_parallel_m2,centre_crossed_m2,mean_m2,min_m2,"
      "max_m2,mean_parallel_m2,mean_crossed_m2,range_correction_mm,usual_range_correction_mm,lit_cubes,centroid_mm,"
      "rms_mm");
  for (const RangingPoint& p : result.points) {
    const auto of = [&](double AnnulusStatistics::*member) {
      return p.annulus ? std::optional(p.annulus->total.*member) : std::nullopt;
    };
    const ByPolarisation<AnnulusStatistics> annulus = p.annulus.value_or(ByPolarisation<AnnulusStatistics>{});
    const auto mean = [](const auto& part) { return part ? std::optional(part->mean) : std::nullopt; };
    csv.add(p.index.wavelength_nm);
    csv.add(p.incidence_deg);
    csv.add(p.azimuth_deg);
    csv.add(p.mirror_m2);
    csv.add(p.centre.total);
    csv.add(p.centre.parallel);
    csv.add(p.centre.crossed);
    csv.add(of(&AnnulusStatistics::mean));
    csv.add(of(&AnnulusStatistics::min));
    csv.add(of(&AnnulusStatistics::max));
    csv.add(mean(annulus.parallel));
    csv.add(mean(annulus.crossed));
    csv.add(p.range_correction_mm);
    csv.add(p.usual_range_correction_mm);
    csv.add(p.lit_cubes);
    csv.add(p.ranges.has_light() ? std::optional(p.ranges.centroid_mm) : std::nullopt);
    csv.add(p.ranges.has_light() ? std::optional(p.ranges.rms_mm) : std::nullopt);
    csv.end_row();
  }
  return csv.text();
}

std::string ranging_map_csv(const RangingResult& result) {
  const RangingMap& map = result.map;
  if (map.values.empty()) return {};
  CsvWriter csv("right_arcsec,up_arcsec,right_urad,up_urad,total_m2,parallel_m2,crossed_m2");
  for (std::size_t k = 0; k < map.values.size(); ++k) {
    const double right = map.angle_rad(k % map.points);
    const double up = map.angle_rad(k / map.points);
    csv.row(right * kArcsecPerRad, up * kArcsecPerRad, right * kMicroradPerRad, up * kMicroradPerRad,
            map.values[k].total, map.values[k].parallel, map.values[k].crossed);
  }
  return csv.text();
}

std::string cubes_csv(const RangingResult& result) {
  if (!result.settings.is_array() || result.points.empty()) return {};
  CsvWriter csv("cube,x_mm,y_mm,z_mm,range_mm,cross_section_m2");
  for (const CubeEcho& echo : result.points.front().echoes) {
    const geometry::Vec3& at = result.settings.cubes[echo.cube].position_mm;
    csv.row(echo.cube + 1, at.x(), at.y(), at.z(), echo.range_mm, echo.cross_section_m2);
  }
  return csv.text();
}

std::string response_csv(const RangingResult& result) {
  if (result.points.empty() || result.points.front().response.range_mm.empty()) return {};
  const PulseResponse& response = result.points.front().response;
  CsvWriter csv("range_mm,time_ps,response_m2_per_mm");
  for (std::size_t k = 0; k < response.range_mm.size(); ++k)
    csv.row(response.range_mm[k], response.range_mm[k] * kPsPerMm, response.per_mm[k]);
  return csv.text();
}

std::string shots_csv(const RangingResult& result) {
  if (result.points.empty() || result.points.front().shots.empty()) return {};
  CsvWriter csv("shot,cross_section_m2,centroid_mm");
  std::size_t number = 0;
  for (const Shot& shot : result.points.front().shots) csv.row(++number, shot.cross_section_m2, shot.centroid_mm);
  return csv.text();
}

std::string ranging_table(const RangingResult& result) {
  const bool is_array = result.settings.is_array();
  std::string text = heading(result);
  text +=
      fmt::format("{:>9} {:>9} {:>7} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>14}\n", "nm", "incidence", "azimuth",
                  "centre", "mean", "min", "max", "parallel", "crossed", is_array ? "centroid_mm" : "correction_mm");
  for (const RangingPoint& p : result.points) {
    const auto statistic = [&](double AnnulusStatistics::*member) {
      return p.annulus ? millions(p.annulus->total.*member) : std::string("-");
    };
    const auto part = [&](const auto& of_annulus, const std::optional<double>& of_centre) {
      return of_annulus ? millions(of_annulus->mean) : share_text(of_centre);
    };
    const ByPolarisation<AnnulusStatistics> annulus = p.annulus.value_or(ByPolarisation<AnnulusStatistics>{});
    const std::string range = !is_array              ? fixed(*p.range_correction_mm, 4)
                              : p.ranges.has_light() ? fixed(p.ranges.centroid_mm, 4)
                                                     : std::string("-");
    text += fmt::format("{:>9} {:>9} {:>7} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>14}\n",
                        shortest(p.index.wavelength_nm), shortest(p.incidence_deg), shortest(p.azimuth_deg),
                        millions(p.centre.total), statistic(&AnnulusStatistics::mean),
                        statistic(&AnnulusStatistics::min), statistic(&AnnulusStatistics::max),
                        part(annulus.parallel, p.centre.parallel), part(annulus.crossed, p.centre.crossed), range);
  }
  if (result.points.empty() || result.points.front().shots.empty()) return text;
  const ShotSummary shots = summary_of(result.points.front().shots);
  return text + fmt::format(
                    "towards the receiver {} without interference; {} shots: {} +- {}, from {} to {}; centroid {} "
                    "+- {} mm\n",
                    millions(result.points.front().ranges.cross_section_m2), result.points.front().shots.size(),
                    millions(shots.mean_m2), millions(shots.deviation_m2), millions(shots.min_m2),
                    millions(shots.max_m2), fixed(shots.centroid_mean_mm, 3), fixed(shots.centroid_deviation_mm, 3));
}

}  // namespace retrace::studies
