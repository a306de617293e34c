#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "report/results/result_plots.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"
#include "surface_models/form.h"

namespace retrace::app {
namespace {

struct MetrologyOptions {
  std::string form = "plane";
  MapOptions map;
  studies::MetrologyRequest request;  ///< all other options
};

Words forms() {
  Words words;
  for (int degree = 0; degree <= surface_models::kMostFormDegree; ++degree) words.push_back(studies::form_name(degree));
  return words;
}

std::vector<Argument> arguments(MetrologyOptions& options) {
  studies::MetrologyRequest& request = options.request;
  Traits form = one_of(forms);
  form.needs = {absent("--edge")};
  std::vector<Argument> all = {
      {"FILE", "height map or profile: text, SDF, GSF or GWY", &request.file, files("")},
      {"--form FORM", "form to remove: none, plane or poly2 to poly8", &options.form, form},
      {"--cutoff-um L", "cut-off of the Gaussian filter between roughness and waviness", &request.cutoff_um},
      {"--feed-mm-per-min F", "feed of the cut, for waves in Hz", &request.feed_mm_per_min},
      {"--edge", "rows are profiles across an edge: fit its radius and chamfer", &request.edge}};
  const std::vector<Argument> reading = map_arguments(options.map);
  all.insert(all.begin() + 3, reading.begin(), reading.end());
  return all;
}

studies::MetrologyRequest request_of(const MetrologyOptions& options) {
  studies::MetrologyRequest request = options.request;
  request.reading = reading_of(options.map);
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
