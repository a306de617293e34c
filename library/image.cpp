#include "retrace/image.h"

#include <filesystem>
#include <memory>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "materials/io/spectrum_reader.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "studies/image/io/image_documents.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace {
namespace {

studies::DetectorRequest to_study(const DetectorRequest& request) {
  studies::DetectorRequest of_study;
  of_study.incidence_deg = request.incidence_deg;
  of_study.azimuth_deg = request.azimuth_deg;
  of_study.pixels = request.pixels;
  of_study.angle_pixels = request.angle_pixels;
  of_study.window_deg = request.window_deg;
  of_study.engine = studies::engine_from_name(request.engine);
  of_study.cutoff = request.cutoff;
  of_study.rays = request.samples;
  of_study.seed = request.seed;
  return of_study;
}

std::optional<studies::PhotometricLamp> lamp_of(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  return studies::read_lamp(file, "lamp");
}

studies::CameraRequest to_study(const CameraRequest& request) {
  studies::CameraRequest of_study;
  of_study.distance_m = request.distance_m;
  of_study.observation_deg = request.observation_deg;
  of_study.v_deg = request.v_deg;
  of_study.h_deg = request.h_deg;
  of_study.rotation_deg = request.rotation_deg;
  of_study.eye_mm = request.eye_mm;
  of_study.lamp_mm = request.lamp_mm;
  of_study.lamp_arcmin = request.lamp_arcmin;
  of_study.pupil_arcmin = request.pupil_arcmin;
  of_study.illuminance_lx = request.illuminance_lx;
  of_study.ambient_lx = request.ambient_lx;
  of_study.backlight_lx = request.backlight_lx;
  of_study.columns = request.columns;
  of_study.rows = request.rows;
  of_study.field_mm = request.field_mm;
  // The default size of the sheet is not passed to the study, because an explicit size is an error for finite parts.
  if (request.film_mm != studies::kUsualFilmMm) of_study.film_mm = request.film_mm;
  of_study.cylinder_mm = request.cylinder_mm;
  of_study.noise = request.noise;
  of_study.passes = request.passes;
  of_study.lamp = lamp_of(request.lamp);
  of_study.lamp_aim_deg = request.lamp_aim_deg;
  of_study.seed = request.seed;
  return of_study;
}

studies::RoadRequest to_study(const RoadRequest& request) {
  studies::RoadRequest of_study;
  of_study.distance_m = request.distance_m;
  of_study.lamp_cd = request.lamp_cd;
  of_study.lamp = lamp_of(request.lamp);
  of_study.lamp_height_m = request.lamp_height_m;
  of_study.lamp_aim_deg = request.lamp_aim_deg;
  const std::filesystem::path dye = studies::dye_file_of(request.dye, false, {});
  if (dye.empty()) return of_study;
  of_study.dye = request.dye;
  of_study.dye_absorption_per_mm = materials::read_spectral_absorption(dye);
  return of_study;
}

/// Runs the study of one kind of picture and copies warnings and completeness to the result.
template <class Study, class Result>
void run(const Study& study, const Running& running, Result& found, ImageResult& result) {
  run_with_threads(running.threads, [&] { found = study.run(running.progress, running.cancellation); });
  result.warnings = found.warnings;
  result.complete = found.complete;
}

Picture picture_of(const std::string& name, FloatPicture numbers, Drawing drawing) {
  return {name, numbers.columns, numbers.rows, std::move(numbers.channels), std::move(drawing)};
}

}  // namespace

ImageResult detector(const Design& design, const DetectorRequest& request, const Running& running) {
  const studies::DetectorStudy study(design.content().design, to_study(request));
  const auto found = std::make_shared<studies::DetectorResult>();
  ImageResult result;
  run(study, running, *found, result);
  result.json = studies::detector_json(*found);
  result.table = studies::detector_table(*found);
  if (!found->complete) return result;
  result.pictures = {picture_of("irradiance", report::irradiance_picture(*found),
                                drawing_of([found] { return report::irradiance_plot(*found); })),
                     picture_of("angular", report::angular_picture(*found),
                                drawing_of([found] { return report::angular_plot(*found); }))};
  return result;
}

ImageResult camera(const Design& design, const CameraRequest& request, const Running& running) {
  const studies::CameraStudy study(design.content().design, to_study(request));
  const auto found = std::make_shared<studies::CameraResult>();
  ImageResult result;
  run(study, running, *found, result);
  result.json = studies::camera_json(*found);
  result.table = studies::camera_table(*found);
  if (found->image.passes == 0) return result;
  const auto png = [found] {
    const raytrace::CameraImage& image = found->image;
    return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
  };
  result.pictures = {picture_of("camera", report::luminance_picture(*found), drawing_of_text(png, false))};
  return result;
}

ImageResult road(const Design& design, const RoadRequest& request, const Running& running) {
  const studies::RoadStudy study(design.content().design, to_study(request), request.seed);
  const auto found = std::make_shared<studies::RoadResult>();
  ImageResult result;
  run(study, running, *found, result);
  result.json = studies::road_json(*found);
  result.table = studies::road_table(*found);
  if (found->views.empty()) return result;
  result.pictures = {picture_of("road", report::road_picture(*found),
                                drawing_of_text([found] { return report::road_png(*found); }, false))};
  return result;
}

}  // namespace retrace
