#include "retrace/photometry.h"

#include <memory>

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
  PhotometricPoint told;
  told.observation_deg = point.test_point.observation_deg;
  told.v_deg = point.v_deg;
  told.h_deg = point.test_point.h_deg;
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
  const design::Design& of_study = design.content().design;
  const studies::PhotometryStudy study(of_study, studies::resolve(request, of_study.substance.is_coloured()));
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
