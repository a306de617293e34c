#include <array>
#include <utility>

#include "app/commands.h"
#include "app/output.h"
#include "app/request_options.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"

namespace retrace::app {
namespace {

struct MetrologyOptions {
  std::string file;
  FieldTexts fields;
};

std::vector<Argument> arguments(MetrologyOptions& options) {
  std::vector<Argument> all = {{"FILE", "height map or profile: text, SDF, GSF or GWY", &options.file, files("")}};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<MetrologyRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

ExitCode run(const MetrologyOptions& options, const CommonOptions& common) {
  const auto request = request_of<MetrologyRequest>(options.fields, common);
  const studies::MetrologyResult result = studies::measure_surface(options.file, request);
  ResultFiles files(common, {options.file}, "metrology.json");
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
              "Computes roughness, waviness, dominant waves, scratches and edge radius of a measured height map or "
              "profile, and writes `surface.toml`, which describes such a surface in a design.",
          .reads = {"height map or profile (text, SDF, GSF, GWY)"},
          .writes = {"retrace.metrology/1"},
          .refuses_set = "not allowed with metrology, which reads no design",
          .begin = begins<MetrologyOptions>(arguments, run)};
}

}  // namespace retrace::app
