#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "core/text.h"
#include "report/results/result_plots.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"
#include "surface_models/form.h"

namespace retrace::app {
namespace {

struct MetrologyOptions {
  std::string form = "plane";
  std::optional<std::string> pixel_um;  ///< one number, or two with a comma between
  studies::MetrologyRequest request;    ///< what is not among the above
};

Words forms() {
  Words words;
  for (int degree = 0; degree <= surface_models::kMostFormDegree; ++degree) words.push_back(studies::form_name(degree));
  return words;
}

std::vector<Argument> arguments(MetrologyOptions& options) {
  const Words units = {"m", "mm", "um", "nm", "pm"};
  studies::MetrologyRequest& request = options.request;
  return {{"FILE", "height map or profile: text, SDF, GSF or GWY", &request.file, files("")},
          {"--form FORM", "form to remove: none, plane or poly2 to poly8", &options.form, one_of(forms)},
          {"--cutoff-um L", "cut-off of the Gaussian filter between roughness and waviness", &request.cutoff_um},
          {"--pixel-um P", "spacing of the points, or PX,PY [what the file says]", &options.pixel_um},
          {"--height-unit UNIT", "of the heights: m, mm, um, nm or pm [what the file says]",
           &request.reading.height_unit, one_of(units)},
          {"--lateral-unit UNIT", "of lengths without a unit, likewise [what the file says]",
           &request.reading.lateral_unit, one_of(units)},
          {"--channel N", "channel of a GWY file [the first]", &request.reading.channel, whole(0, 999999)},
          {"--feed-mm-per-min F", "feed of the cut, for waves in Hz", &request.feed_mm_per_min},
          {"--edge", "rows are profiles across an edge: fit its radius and chamfer", &request.edge}};
}

double spacing_of(std::string_view text, const std::string& whole) {
  const std::optional<double> value = number_in(text);
  if (!value || !(*value > 0.0))
    throw InputError({"", 0, "--pixel-um"}, "must be one number > 0, or two for x and y as in 0.5,0.6, got " + whole);
  return *value;
}

studies::MetrologyRequest request_of(const MetrologyOptions& options) {
  studies::MetrologyRequest request = options.request;
  if (options.pixel_um) {
    const std::string& text = *options.pixel_um;
    const std::size_t comma = text.find(',');
    request.reading.x_pixel_um = spacing_of(std::string_view(text).substr(0, comma), text);
    request.reading.y_pixel_um = comma == std::string::npos
                                     ? *request.reading.x_pixel_um
                                     : spacing_of(std::string_view(text).substr(comma + 1), text);
  }
  request.form_degree = studies::form_degree_of(options.form);
  return request;
}

ExitCode run(const MetrologyOptions& options, const CommonOptions& common) {
  const studies::MetrologyResult result = studies::measure_surface(request_of(options));
  ResultFiles files(common, {options.request.file}, "metrology.json");
  files.add("surface.toml", [&] { return studies::surface_toml(result); });
  files.add("psd.csv", [&] { return studies::spectra_csv(result); });
  files.add_drawing("metrology", [&] { return report::metrology_plot(result); });
  files.prepare();
  return files.write(studies::metrology_json(result), studies::metrology_text(result), result.warnings);
}

}  // namespace

Command metrology_command() {
  return {.name = "metrology",
          .summary = "roughness, waviness and edge radius of a measured surface",
          .manual =
              "Roughness, waviness, dominant waves, scratches and edge radius of a measured height map or profile, "
              "and `surface.toml`, which describes such a surface to a design.",
          .reads = {"height map or profile (text, SDF, GSF, GWY)"},
          .writes = {"retrace.metrology/1"},
          .refuses_set = "metrology reads no design",
          .begin = begins<MetrologyOptions>(arguments, run)};
}

}  // namespace retrace::app
