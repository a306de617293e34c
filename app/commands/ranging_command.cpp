#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "design/io/design_reader.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/ranging/io/cubes_reader.h"
#include "studies/ranging/io/ranging_files.h"
#include "studies/ranging/ranging.h"

namespace retrace::app {
namespace {

struct RangingOptions {
  std::string design;
  FieldTexts fields;
};

std::vector<Argument> arguments(RangingOptions& options) {
  std::vector<Argument> all = {design_argument(options.design)};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<RangingRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

/// Registers the output files of the command. They are written after the computation.
/// \param result result that the files will contain; the computation fills it later
void add_files(ResultFiles& files, const RangingRequest& request, const studies::RangingResult& result) {
  const auto has_map = [&] { return !result.map.values.empty(); };
  files.add("ranging.csv", [&] { return studies::ranging_csv(result); });
  files.add("map.csv", [&] { return studies::ranging_map_csv(result); });
  files.add_drawing(
      "map", [&] { return report::ranging_map_plot(result); }, has_map);
  files.add_drawing(
      "rings", [&] { return report::ranging_rings_plot(result); }, has_map);
  if (request.cubes.empty()) return;
  files.add("cubes.csv", [&] { return studies::cubes_csv(result); });
  files.add("shots.csv", [&] { return studies::shots_csv(result); });
  files.add("response.csv", [&] { return studies::response_csv(result); });
  files.add_drawing(
      "response", [&] { return report::ranging_response_plot(result); },
      [&] { return !studies::response_csv(result).empty(); });
}

ExitCode run(const RangingOptions& options, const CommonOptions& common) {
  const design::Design design = design::read_design(options.design, common.overrides);
  const auto request = request_of<RangingRequest>(options.fields, common);
  std::vector<std::string> inputs = files_read({design});
  std::vector<studies::ArrayCube> cubes;
  if (!request.cubes.empty()) {
    inputs.push_back(request.cubes.string());
    cubes = studies::read_cubes(request.cubes);
  }
  const studies::RangingStudy study(design, request, std::move(cubes));
  studies::RangingResult result;
  ResultFiles files(common, inputs, "ranging.json");
  add_files(files, request, result);
  files.prepare();
  const OrderlyInterrupt interrupt;
  const Words to_shorten = {fmt::format("give a smaller --map-points (now {})", request.map_points),
                            "give fewer directions (--incidence, --azimuth)"};
  interrupt.run(common, {"tracing", to_shorten},
                [&](Progress* bar, const Cancellation* cancel) { result = study.run(bar, cancel); });
  const std::string table = studies::ranging_table(result);
  return files.write(studies::ranging_json(result),
                     is_shown_whole(table, common) ? table : without_middle(table, common, "ranging.csv"),
                     result.warnings, {.complete = result.complete});
}

}  // namespace

Command ranging_command() {
  return {
      .name = "ranging",
      .summary = "cross sections and range corrections of cube corners for laser ranging",
      .manual =
          "Computes the optical cross section 4 pi R_I of a single cube corner over its far field, with diffraction "
          "and polarisation, its mean over an annulus of velocity aberration, and its range correction. "
          "`--cubes` adds the light of an array of such cubes, on a satellite or a plate, with its pulse response "
          "and single shots.",
      .reads = {"retrace.design/1", "retrace.cubes/1", "cubes (CSV)"},
      .writes = {"retrace.ranging/1"},
      .begin = begins<RangingOptions>(arguments, run)};
}

}  // namespace retrace::app
