#include "retrace/photometry.h"

#include <memory>
#include <string_view>
#include <utility>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/photometry.h"

namespace retrace {
namespace {

studies::PhotometryRequest to_study(const Design& design, const PhotometryRequest& request) {
  studies::PhotometryRequest of_study =
      studies::photometry_request({request.standard, request.part_class, request.colour});
  const std::filesystem::path dye =
      studies::dye_file_of(request.dye, design.content().design.substance.is_coloured(), of_study.programme.colour);
  studies::set_dye(of_study, request.dye, dye);
  of_study.area_cm2 = request.area_cm2;
  if (request.rotation_deg) of_study.rotation_deg = *request.rotation_deg;
  if (request.source_arcmin) of_study.apertures.source = Angle::from_deg(*request.source_arcmin / 60.0);
  if (request.receiver_arcmin) of_study.apertures.receiver = Angle::from_deg(*request.receiver_arcmin / 60.0);
  of_study.window_deg = request.window_deg;
  of_study.light = studies::light_from_name(request.light);
  of_study.engine = studies::engine_from_name(request.engine);
  of_study.cutoff = request.cutoff;
  of_study.rays = request.samples;
  of_study.seed = request.seed;
  of_study.diffraction = request.diffraction;
  of_study.window_power = request.window_power;
  of_study.advice = request.advice;
  of_study.pictures = request.pictures;
  of_study.colour = true;
  return of_study;
}

PhotometricPoint from_study(const studies::PhotometricPoint& point) {
  PhotometricPoint told;
  told.observation_deg = point.asked.observation_deg;
  told.v_deg = point.v_deg;
  told.h_deg = point.asked.h_deg;
  told.rotation_deg = point.rotation_deg;
  told.r_i_mcd_per_lx = point.r_i_mcd_per_lx;
  told.r_a = point.r_a;
  told.std_error_mcd_per_lx = point.std_error_mcd_per_lx;
  told.limit_mcd_per_lx = point.limit_mcd_per_lx;
  told.verdict = studies::verdict_name(point.verdict());
  return told;
}

}  // namespace

PhotometryResult photometry(const Design& design, const PhotometryRequest& request, const Running& running) {
  const studies::PhotometryStudy study(design.content().design, to_study(design, request));
  const auto held = std::make_shared<studies::PhotometryResult>();
  studies::PhotometryResult& found = *held;
  run_with_threads(running.threads, [&] { found = study.run(running.progress, running.cancellation); });
  PhotometryResult result;
  for (const studies::PhotometricPoint& point : found.points) result.points.push_back(from_study(point));
  result.verdict = studies::verdict_name(found.verdict);
  result.passes = found.passes();
  result.warnings = found.warnings;
  result.complete = found.complete;
  result.json = studies::photometry_json(found);
  result.csv = studies::photometry_csv(found);
  result.table = studies::photometry_table(found);
  if (!found.maps.empty()) result.far_field = drawing_of([held] { return report::far_field_plot(*held); });
  if (!found.curves.empty()) result.observation = drawing_of([held] { return report::observation_plot(*held); });
  return result;
}

}  // namespace retrace
