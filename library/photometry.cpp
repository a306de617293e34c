#include "retrace/photometry.h"

#include <memory>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/photometry.h"

namespace retrace {
namespace {

PhotometricPoint from_study(const studies::PhotometricPoint& point) {
  PhotometricPoint converted;
  converted.observation_deg = point.test_point.observation_deg;
  converted.v_deg = point.v_deg;
  converted.h_deg = point.test_point.h_deg;
  converted.rotation_deg = point.rotation_deg;
  converted.r_i_mcd_per_lx = point.r_i_mcd_per_lx;
  converted.r_a = point.r_a;
  converted.std_error_mcd_per_lx = point.std_error_mcd_per_lx;
  converted.limit_mcd_per_lx = point.limit_mcd_per_lx;
  converted.verdict = studies::verdict_name(point.verdict());
  return converted;
}

CoefficientMap from_study(const studies::CoefficientMap& map) {
  CoefficientMap converted;
  converted.design = map.design;
  converted.rotation_deg = map.rotation_deg;
  converted.presentation_deg = map.presentation_deg;
  converted.entrance_deg = map.entrance_deg;
  converted.observation_deg = map.observation_deg;
  converted.r_a = map.rows(map.r_a);
  converted.std_error = map.rows(map.std_error);
  return converted;
}

/// Adds the maps over entrance and observation angle, and their drawings.
void add_maps(const std::shared_ptr<const studies::PhotometryResult>& found, PhotometryResult& result) {
  for (const studies::CoefficientMap& map : found->coefficient_maps) result.maps.push_back(from_study(map));
  result.map = drawing_of([found] { return report::coefficient_map_plot(*found); });
  if (found->request.compared)
    result.map_ratio = drawing_of([found] { return report::coefficient_ratio_plot(*found); });
}

/// \param compared design whose map is compared, or null
PhotometryResult run_photometry(const Design& design, const Design* compared, const PhotometryRequest& request,
                                const Running& running) {
  const design::Design& of_study = design.content().design;
  studies::PhotometrySettings settings = studies::resolve(request, of_study.substance.is_coloured());
  if (compared != nullptr)
    settings.compared = studies::compared_design(request, compared->content().design, settings.test_plan.colour);
  const studies::PhotometryStudy study(of_study, std::move(settings));
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
  result.table = studies::photometry_table(found) + studies::coefficient_map_table(found);
  if (!found.coefficient_maps.empty()) add_maps(held, result);
  if (!found.maps.empty()) result.far_field = drawing_of([held] { return report::far_field_plot(*held); });
  if (!found.curves.empty()) result.observation = drawing_of([held] { return report::observation_plot(*held); });
  return result;
}

}  // namespace

PhotometryResult photometry(const Design& design, const PhotometryRequest& request, const Running& running) {
  return run_photometry(design, nullptr, request, running);
}

PhotometryResult photometry(const Design& design, const Design& compared, const PhotometryRequest& request,
                            const Running& running) {
  if (!request.map) throw InputError(Field{"map"}, "must be true for the comparison of two designs, got false");
  return run_photometry(design, &compared, request, running);
}

}  // namespace retrace
