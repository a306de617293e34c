#include "retrace/ranging.h"

#include <memory>
#include <utility>
#include <vector>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/ranging/io/cubes_reader.h"
#include "studies/ranging/io/ranging_files.h"
#include "studies/ranging/ranging.h"

namespace retrace {
namespace {

CrossSection from_study(const studies::RangingPoint& point) {
  CrossSection converted;
  converted.wavelength_nm = point.index.wavelength_nm;
  converted.incidence_deg = point.incidence_deg;
  converted.azimuth_deg = point.azimuth_deg;
  converted.centre_m2 = point.centre.total;
  if (point.annulus) {
    converted.mean_m2 = point.annulus->total.mean;
    converted.min_m2 = point.annulus->total.min;
    converted.max_m2 = point.annulus->total.max;
  }
  converted.range_correction_mm = point.range_correction_mm;
  if (point.ranges.has_light()) converted.centroid_mm = point.ranges.centroid_mm;
  return converted;
}

}  // namespace

RangingResult ranging(const Design& design, const RangingRequest& request, const Running& running) {
  std::vector<studies::ArrayCube> cubes;
  if (!request.cubes.empty()) cubes = studies::read_cubes(request.cubes);
  const studies::RangingStudy study(design.content().design, request, std::move(cubes));
  const auto held = std::make_shared<studies::RangingResult>();
  studies::RangingResult& found = *held;
  run_with_threads(running.threads, [&] { found = study.run(running.progress, running.cancellation); });
  RangingResult result;
  for (const studies::RangingPoint& point : found.points) result.points.push_back(from_study(point));
  result.warnings = found.warnings;
  result.complete = found.complete;
  result.json = studies::ranging_json(found);
  result.csv = studies::ranging_csv(found);
  result.map_csv = studies::ranging_map_csv(found);
  result.cubes_csv = studies::cubes_csv(found);
  result.response_csv = studies::response_csv(found);
  result.shots_csv = studies::shots_csv(found);
  result.table = studies::ranging_table(found);
  if (!found.map.values.empty()) {
    result.map = drawing_of([held] { return report::ranging_map_plot(*held); });
    result.rings = drawing_of([held] { return report::ranging_rings_plot(*held); });
  }
  if (!result.response_csv.empty())
    result.response = drawing_of([held] { return report::ranging_response_plot(*held); });
  return result;
}

}  // namespace retrace
