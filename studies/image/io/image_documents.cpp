#include "studies/image/io/image_documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"
#include "studies/image/camera_setup.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

Json position_json(const geometry::Vec3& p) {
  return Json::array({p.x(), p.y(), p.z()});
}

Json header(const char* kind, const design::Design& design, std::uint32_t seed) {
  return {{"kind", kind}, {"design", design::to_json(design)}, {"seed", seed}};
}

std::string image_text(Json json, double elapsed_s, const Warnings& warnings, bool complete) {
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.image/1", std::move(json), warnings, complete);
}

Json lamp_json(const PhotometricLamp& lamp, double aim_deg) {
  return {{"file", lamp.name},
          {"title", lamp.title},
          {"aim_deg", aim_deg},
          {"lumens", lamp.intensity.lumens()},
          {"printed_lumens", lamp.printed_lumens},
          {"largest_cd", lamp.intensity.largest_cd()}};
}

}  // namespace

std::string detector_json(const DetectorResult& result) {
  Json json = header("detector", result.design, result.request.seed);
  json["engine"] = result.engine;
  json["engine_requested"] = result.request.engine;
  json["incidence_deg"] = result.request.incidence_deg;
  json["azimuth_deg"] = result.request.azimuth_deg;
  json["acceptance_half_angle_deg"] = result.acceptance_half_angle_deg;
  const geometry::Rectangle& bounds = result.face.bounds_mm();
  json["face"] = {{"x_from_mm", bounds.lower.x()}, {"y_from_mm", bounds.lower.y()},    {"x_to_mm", bounds.upper.x()},
                  {"y_to_mm", bounds.upper.y()},   {"columns", result.face.columns()}, {"rows", result.face.rows()},
                  {"is_period", result.is_period}};
  json["angles"] = {{"half_width_deg", result.window_deg},
                    {"has_diffraction", result.has_diffraction},
                    {"columns", result.request.angle_pixels},
                    {"rows", result.request.angle_pixels}};
  if (const design::CellSpread* const spread = result.has_diffraction ? result.design.cell_spread() : nullptr)
    json["angles"]["cell_interference"] = {{"depth_spread_nm", spread->depth_nm},
                                           {"spacing_spread_nm", spread->spacing_nm}};
  if (result.has_maps()) {
    json["angles"]["outside"] = result.maps.outside;
    json["rre"] = result.maps.rre;
    json["std_error"] = result.maps.std_error;
    json["truncated"] = result.maps.truncated;
    if (result.engine != "exact")
      json["bins"] = {{"error_requested", result.request.bin_error}, {"face_error", result.face_error},
                      {"angle_error", result.angle_error},           {"face_pixels", result.face_bin_pixels},
                      {"angle_pixels", result.angle_bin_pixels},     {"limit_reached", result.is_limit_reached}};
    json["relative_irradiance_max"] = largest(result.maps.leaving.value);
    json["per_sr_max"] = largest(result.maps.per_sr.value);
    json[result.engine == "exact" ? "beams" : "rays"] = result.maps.rays;
  }
  return image_text(std::move(json), result.elapsed_s, result.warnings, result.complete);
}

namespace {

/// Returns the document of a camera picture without the keys that all documents have.
Json camera_content(const CameraResult& result) {
  const CameraRequest& asked = result.request;
  Json json = header("camera", result.design, asked.seed);
  json["engine"] = result.engine;
  json["columns"] = asked.columns;
  json["rows"] = asked.rows;
  json["width_mm"] = result.scene.view.width_mm;
  json["eye_mm"] = position_json(result.scene.view.eye_mm);
  json["lamp_mm"] = position_json(result.scene.lamp.position_mm);
  json["target_mm"] = position_json(result.scene.view.target_mm);
  json["observation_deg"] = result.observation_deg;
  json["entrance_deg"] = result.entrance_deg;
  json["viewing_deg"] = result.viewing_deg;
  json["rotation_deg"] = asked.rotation_deg;
  json["lamp_arcmin"] = asked.lamp_arcmin;
  json["pupil_arcmin"] = asked.pupil_arcmin;
  json["illuminance_lx"] = result.scene.lamp.illuminance_lx;
  json["light"] = asked.light;
  json["dye"] = asked.dye;
  json["has_diffraction"] = !result.no_diffraction;
  if (result.no_diffraction) json["why_no_diffraction"] = text_of(*result.no_diffraction);
  if (result.r_a) {
    json["r_a_cd_per_lx_m2"] = *result.r_a;
    json["r_a_std_error_cd_per_lx_m2"] = result.r_a_error;
  }
  if (result.lamp) json["lamp"] = lamp_json(*result.lamp, asked.lamp_aim_deg);
  json["ambient_lx"] = asked.ambient_lx;
  json["backlight_lx"] = asked.backlight_lx;
  if (!asked.background.empty()) json["background"] = asked.background.filename().string();
  if (result.scene.film) {
    json["film_mm"] = film_of(asked);
    if (asked.cylinder_mm) json["cylinder_mm"] = *asked.cylinder_mm;
  }
  json["passes"] = result.image.passes;
  json["paths"] = static_cast<std::uint64_t>(result.image.total_paths());
  if (result.image.passes > 1) {
    if (result.image.part_means.size() > 1) {
      json["part_luminance_cd_per_m2"] = result.image.part_mean();
      json["part_std_error_cd_per_m2"] = result.image.part_error();
    }
    json["noise"] = result.image.relative_noise();
  }
  json["luminance_max_cd_per_m2"] = largest(result.image.luminance);
  return json;
}

}  // namespace

std::string camera_json(const CameraResult& result) {
  return image_text(camera_content(result), result.elapsed_s, result.warnings, result.complete);
}

std::string camera_series_json(const std::vector<CameraResult>& results, const Warnings& warnings, bool complete) {
  Json json = {{"kind", "camera_series"}, {"pictures", Json::array()}};
  double elapsed_s = 0.0;
  for (const CameraResult& result : results) {
    json["pictures"].push_back(camera_content(result));
    elapsed_s += result.elapsed_s;
  }
  return image_text(std::move(json), elapsed_s, warnings, complete);
}

namespace {

Json road_scene_json(const RoadScene& s) {
  Json json = {{"mount", s.mount == RoadMount::car ? "car" : "sign"},
               {"lamp_height_m", s.lamp_height},
               {"lamp_half_gap_m", s.lamp_half_gap},
               {"lamp_diameter_m", s.lamp_diameter},
               {"eye_height_m", s.eye_height},
               {"eye_right_m", s.eye_right},
               {"eye_behind_m", s.eye_behind},
               {"reflector_height_m", s.reflectors.back().y()},
               {"lateral_m", s.reflectors.back().x()},
               {"reflector_width_m", s.size().x()},
               {"reflector_tall_m", s.size().y()},
               {"reflector_area_m2", s.area()},
               {"asphalt_r_l_cd_per_lx_m2", s.asphalt_r_l},
               {"marking_r_l_cd_per_lx_m2", s.marking_r_l}};
  if (s.mount == RoadMount::sign) json["mast_height_m"] = s.mast_height;
  json["linear_srgb"] = s.tint;
  return json;
}

/// Returns the corners of a reflector in the picture, in pixels.
Json corners_json(const RoadScene& s, const RoadView& view, const geometry::Vec3& reflector) {
  Json corners = Json::array();
  for (const geometry::Vec2& point : s.outline) {
    const geometry::Vec2 position = view.camera.position_of(reflector + geometry::Vec3(point.x(), point.y(), 0.0));
    corners.push_back({position.x(), position.y()});
  }
  return corners;
}

}  // namespace

std::string road_json(const RoadResult& result) {
  Json json = header("road", result.design, result.request.seed);
  json["engine"] = result.engine;
  if (const auto& lamp = result.scene.lamp)
    json["lamp"] = lamp_json(*lamp, result.request.lamp_aim_deg);
  else
    json["lamp_cd"] = result.request.lamp_cd;
  json["dye"] = result.scene.dye;
  json["columns"] = result.scene.columns;
  json["rows"] = result.scene.rows;
  json["field_deg"] = result.scene.field_deg;
  json["scene"] = road_scene_json(result.scene);
  json["views"] = Json::array();
  for (const RoadView& view : result.views) {
    Json reflectors = Json::array();
    for (std::size_t k = 0; k < view.reflectors.size(); ++k) {
      const RoadReflector& r = view.reflectors[k];
      reflectors.push_back({{"observation_deg", r.observation_deg},
                            {"entrance_deg", r.entrance_deg},
                            {"r_a_cd_per_lx_m2", r.r_a},
                            {"r_i_cd_per_lx", {r.r_a[0] * result.scene.area(), r.r_a[1] * result.scene.area()}},
                            {"illuminance_lx", r.illuminance_lx},
                            {"luminance_cd_per_m2", r.luminance},
                            {"intensity_cd", r.intensity_cd},
                            {"corners_px", corners_json(result.scene, view, result.scene.reflectors[k])}});
    }
    json["views"].push_back({{"distance_m", view.distance_m}, {"reflectors", std::move(reflectors)}});
  }
  return image_text(std::move(json), result.elapsed_s, result.warnings, result.complete);
}

std::string road_table(const RoadResult& result) {
  std::string table = fmt::format("{:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>10}\n", "distance_m",
                                  "reflector", "alpha_l", "alpha_r", "R_A_l", "R_A_r", "E_lx", "L_cd_per_m2", "I_cd");
  for (const RoadView& view : result.views)
    for (std::size_t k = 0; k < view.reflectors.size(); ++k) {
      const RoadReflector& r = view.reflectors[k];
      table += fmt::format("{:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>10}\n", shortest(view.distance_m),
                           reflector_name(view, k), fixed_visible(r.observation_deg[0], 2),
                           fixed_visible(r.observation_deg[1], 2), fixed(r.r_a[0], 2), fixed(r.r_a[1], 2),
                           fixed_visible(r.illuminance_lx[0] + r.illuminance_lx[1], 2), fixed(r.luminance, 2),
                           fixed_visible(r.intensity_cd, 3));
    }
  return table;
}

std::string detector_table(const DetectorResult& result) {
  if (!result.has_maps()) return "no maps: the computation was interrupted\n";
  std::string table =
      fmt::format("RRE {} % ({}); relative irradiance up to {}; {} % of the light leaves beyond {} degrees\n",
                  fixed(100.0 * result.maps.rre, 3), result.engine, fixed(largest(result.maps.leaving.value), 3),
                  fixed(100.0 * result.maps.outside, 2), shortest(result.window_deg));
  if (result.engine == "exact") return table;
  table += fmt::format("bins with light: standard error up to {} % on the face, {} % in the angular map\n",
                       fixed(100.0 * result.face_error, 2), fixed(100.0 * result.angle_error, 2));
  if (result.request.bin_error > 0.0)
    table += fmt::format(
        "{} % of the light is in bins of at most {} pixels on the face, {} pixels in the angular map; "
        "{} rays{}\n",
        fixed(100.0 * kLightInSmallBins, 0), result.face_bin_pixels, result.angle_bin_pixels, result.maps.rays,
        result.is_limit_reached ? ", the maximum of a run without --samples" : "");
  return table;
}

std::string camera_series_table(const std::vector<CameraResult>& results) {
  std::string table = fmt::format("{:>10} {:>9} {:>9} {:>9} {:>12} {:>12}  {}\n", "distance_m", "alpha", "entrance",
                                  "rotation", "L_cd_per_m2", "R_A", "design");
  for (const CameraResult& result : results) {
    const double distance_m = 1e-3 * (result.scene.view.eye_mm - result.scene.view.target_mm).norm();
    table += fmt::format("{:>10} {:>9} {:>9} {:>9} {:>12} {:>12}  {}\n", fixed_visible(distance_m, 2),
                         fixed_visible(result.observation_deg, 2), fixed_visible(result.entrance_deg, 2),
                         shortest(result.request.rotation_deg),
                         result.image.part_means.size() > 1 ? fixed_visible(result.image.part_mean(), 3) : "-",
                         result.r_a ? fixed_visible(*result.r_a, 3) : "-", design::short_name(result.design));
  }
  return table;
}

std::string camera_table(const CameraResult& result) {
  std::string table =
      fmt::format("{} x {} pixels, {} passes, noise {} %\n", result.image.columns, result.image.rows,
                  result.image.passes, fixed(result.image.passes > 1 ? 100.0 * result.image.relative_noise() : 0.0, 2));
  if (result.image.part_means.size() > 1)
    table += fmt::format("luminance of the part {} +- {} cd/m2, of the brightest pixel {} cd/m2\n",
                         fixed(result.image.part_mean(), 4), fixed(result.image.part_error(), 4),
                         fixed(largest(result.image.luminance), 4));
  return table;
}

}  // namespace retrace::studies
