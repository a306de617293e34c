#include "retrace/metrology.h"

#include <memory>
#include <utility>

#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"

namespace retrace {
namespace {

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

surface_models::HeightMapFile to_file(const HeightMap& heights, const MetrologyRequest& request) {
  const surface_models::HeightMapOptions reading = studies::reading_of(request);
  if (!reading.x_pixel_um) throw InputError(Field{"pixel_um"}, "is required for heights in memory");
  if (heights.columns < surface_models::kMinColumns || heights.rows < 1)
    throw InputError({"", 0, "heights"},
                     "must be rows of at least " + std::to_string(surface_models::kMinColumns) + " numbers");
  if (heights.heights_nm.size() != heights.columns * heights.rows)
    throw InputError({"", 0, "heights"}, "must be as many numbers as columns times rows");
  if (heights.heights_nm.size() > surface_models::kMaxPoints)
    throw InputError({"", 0, "heights"}, "must be at most " + std::to_string(surface_models::kMaxPoints) + " numbers");
  surface_models::HeightMapFile file;
  file.format = "heights in memory";
  file.map = {heights.columns, heights.rows, *reading.x_pixel_um, *reading.y_pixel_um, heights.heights_nm};
  if (surface_models::measured_points(file.map) == 0)
    throw InputError({"", 0, "heights"}, "must contain at least one measured height, but all are NaN");
  return file;
}

}  // namespace

Metrology metrology(const std::filesystem::path& file, const MetrologyRequest& request) {
  return result_of(studies::measure_surface(file.string(), request));
}

Metrology metrology(const HeightMap& heights, const MetrologyRequest& request) {
  return result_of(studies::measure_surface("heights", request, to_file(heights, request)));
}

}  // namespace retrace
