#include "retrace/metrology.h"

#include <cmath>
#include <memory>
#include <utility>

#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"

namespace retrace {
namespace {

studies::MetrologyRequest to_study(const MetrologyRequest& request) {
  studies::MetrologyRequest of_study;
  of_study.form_degree = studies::form_degree_of(request.form);
  of_study.cutoff_um = request.cutoff_um;
  of_study.reading.x_pixel_um = request.x_pixel_um;
  of_study.reading.y_pixel_um = request.y_pixel_um ? request.y_pixel_um : request.x_pixel_um;
  of_study.reading.height_unit = request.height_unit;
  of_study.reading.lateral_unit = request.lateral_unit;
  of_study.reading.channel = request.channel;
  of_study.feed_mm_per_min = request.feed_mm_per_min;
  of_study.edge = request.edge;
  return of_study;
}

HeightMap from_study(const surface_models::HeightMap& map) {
  return {map.columns, map.rows, map.heights_nm};
}

Metrology result_of(studies::MetrologyResult measured) {
  const auto held = std::make_shared<const studies::MetrologyResult>(std::move(measured));
  Metrology result;
  result.warnings = held->warnings;
  result.json = studies::metrology_json(*held);
  result.table = studies::metrology_text(*held);
  result.surface_toml = studies::surface_toml(*held);
  result.spectra_csv = studies::spectra_csv(*held);
  result.drawing = drawing_of([held] { return report::metrology_plot(*held); });
  result.x_pixel_um = held->surface.x_pixel_um;
  result.y_pixel_um = held->surface.y_pixel_um;
  result.surface = from_study(held->surface);
  result.roughness = from_study(held->split.roughness);
  result.waviness = from_study(held->split.waviness);
  return result;
}

surface_models::HeightMapFile to_file(const HeightMap& heights, const surface_models::HeightMapOptions& reading) {
  if (!reading.x_pixel_um) throw InputError({"", 0, "--pixel-um"}, "is required with heights in memory");
  for (const auto& pixel_um : {reading.x_pixel_um, reading.y_pixel_um})
    if (!(*pixel_um > 0.0) || !std::isfinite(*pixel_um)) throw InputError({"", 0, "--pixel-um"}, "must be > 0");
  if (heights.columns < surface_models::kLeastColumns || heights.rows < 1)
    throw InputError({"", 0, "heights"},
                     "must be rows of at least " + std::to_string(surface_models::kLeastColumns) + " numbers");
  if (heights.heights_nm.size() != heights.columns * heights.rows)
    throw InputError({"", 0, "heights"}, "must be columns times rows numbers");
  if (heights.heights_nm.size() > surface_models::kMostPoints)
    throw InputError({"", 0, "heights"}, "must be at most " + std::to_string(surface_models::kMostPoints) + " numbers");
  surface_models::HeightMapFile file;
  file.format = "heights in memory";
  file.map = {heights.columns, heights.rows, *reading.x_pixel_um, *reading.y_pixel_um, heights.heights_nm};
  if (surface_models::measured_points(file.map) == 0)
    throw InputError({"", 0, "heights"}, "must hold a height that was measured, all are NaN");
  return file;
}

}  // namespace

Metrology metrology(const std::filesystem::path& file, const MetrologyRequest& request) {
  studies::MetrologyRequest of_study = to_study(request);
  of_study.file = file.string();
  return result_of(studies::measure_surface(of_study));
}

Metrology metrology(const HeightMap& heights, const MetrologyRequest& request) {
  studies::MetrologyRequest of_study = to_study(request);
  of_study.file = "heights";
  surface_models::HeightMapFile file = to_file(heights, of_study.reading);
  return result_of(studies::measure_surface(of_study, std::move(file)));
}

}  // namespace retrace
