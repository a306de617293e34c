#include "retrace/rre.h"

#include <memory>
#include <utility>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre_map.h"
#include "studies/rre/rre_request.h"

namespace retrace {
namespace {

RrePoint from_study(const studies::RrePoint& point) {
  RrePoint result{.design = point.design,
                  .incidence_deg = point.incidence_deg,
                  .azimuth_deg = point.azimuth_deg,
                  .wavelength_nm = point.wavelength_nm,
                  .acceptance_half_angle_deg = point.acceptance_half_angle_deg,
                  .rre = point.rre,
                  .std_error = point.std_error,
                  .engine = point.engine,
                  .ledger = {},
                  .missed_target = point.missed_target};
  for (std::size_t k = 0; k < raytrace::kAccountCount; ++k)
    if (raytrace::is_listed(static_cast<raytrace::Account>(k), point.ledger.power[k]))
      result.ledger.emplace(raytrace::kAccountNames[k], point.ledger.power[k]);
  return result;
}

RreMap from_study(const studies::RreMap& map) {
  return {map.design,        map.acceptance_half_angle_deg, map.incidence_deg, map.azimuth_deg,
          map.rows(map.rre), map.rows(map.std_error),       map.mean()};
}

/// Adds the polar maps and their drawings.
void add_maps(const std::shared_ptr<const studies::RreResult>& found, RreResult& result) {
  for (const studies::RreMap& map : studies::rre_maps(*found)) result.maps.push_back(from_study(map));
  result.map = drawing_of([found] { return report::rre_map_plot(*found); });
  if (report::rre_maps_can_be_compared(*found))
    result.map_difference = drawing_of([found] { return report::rre_map_difference_plot(*found); });
}

}  // namespace

RreResult rre(const std::vector<Design>& designs, const RreRequest& request, const Running& running) {
  std::vector<design::Design> of_study;
  of_study.reserve(designs.size());
  for (const Design& design : designs) of_study.push_back(design.content().design);
  const studies::RreStudy study(std::move(of_study), studies::resolve(request));
  const auto held = std::make_shared<studies::RreResult>();
  studies::RreResult& found = *held;
  run_with_threads(running.threads, [&] { found = study.run(running.progress, running.cancellation); });
  RreResult result;
  for (const studies::RrePoint& point : found.points) result.points.push_back(from_study(point));
  result.warnings = found.warnings;
  result.complete = found.complete;
  result.json = studies::rre_json(found);
  result.csv = studies::rre_csv(found);
  result.table = (found.has_complete_maps() ? studies::rre_map_table(found) : studies::rre_table(found)) +
                 studies::derivative_table(found);
  if (request.footprint) result.footprint = studies::footprint_json(found);
  if (request.far_field) result.far_field = studies::far_field_json(found);
  if (found.has_complete_maps())
    add_maps(held, result);
  else if (!found.points.empty())
    result.curve = drawing_of([held] { return report::rre_plot(*held); });
  if (!found.faces.empty()) result.footprint_map = drawing_of([held] { return report::footprint_plot(*held); });
  return result;
}

RreResult rre(const Design& design, const RreRequest& request, const Running& running) {
  return rre(std::vector<Design>{design}, request, running);
}

}  // namespace retrace
