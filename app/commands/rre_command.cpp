#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/commands.h"
#include "app/first_answer.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/request_options.h"
#include "core/number_format.h"
#include "design/io/design_reader.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "requests/number_list.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre_map.h"
#include "studies/rre/rre_request.h"

namespace retrace::app {
namespace {

struct RreOptions {
  std::vector<std::string> designs;
  std::optional<std::string> incidence;
  FieldTexts fields;
};

std::vector<Argument> arguments(RreOptions& options) {
  std::vector<Argument> all = {
      {"DESIGN", "design files; - is standard input", &options.designs, files(".toml")},
      {"--incidence LIST",
       "incidence angles in degrees: a,b,c, start:stop:step and start:stop:auto [0; with --map "
       "0:80:5]",
       &options.incidence}};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<RreRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

studies::RreSettings settings_of(const RreOptions& options, const CommonOptions& common) {
  auto request = request_of<RreRequest>(options.fields, common);
  if (options.incidence) {
    requests::CurveList incidence = requests::read_curve_list(*options.incidence, Field{"incidence_deg"});
    request.incidence_deg = std::move(incidence.values);
    request.incidence_spans_deg = std::move(incidence.chosen);
  }
  return studies::resolve(request);
}

std::vector<design::Design> designs_of(const RreOptions& options, const CommonOptions& common) {
  if (std::count(options.designs.begin(), options.designs.end(), "-") > 1)
    throw InputError("standard input (-) can be given only one time");
  std::vector<design::Design> designs;
  for (const std::string& file : options.designs) designs.push_back(design::read_design(file, common.overrides));
  return designs;
}

/// Adds a warning if the drawing of the footprints does not show all directions.
void warn_of_panels(studies::RreResult& result) {
  if (result.faces.empty() || result.returned.size() <= report::kMaxFootprintPanels) return;
  result.warnings.push_back(
      {"footprints_omitted", fmt::format("footprint.svg and footprint.png show the first {} of {} directions",
                                         report::kMaxFootprintPanels, result.returned.size())});
}

/// Adds a warning if the drawings do not show all polar maps, or if the maps of two designs cannot be compared.
void warn_of_maps(studies::RreResult& result) {
  const std::size_t maps = studies::rre_maps(result).size();
  if (maps > report::kMaxMapPanels)
    result.warnings.push_back({"maps_omitted", fmt::format("map.svg and map.png show the first {} of {} polar maps",
                                                           report::kMaxMapPanels, maps)});
  if (maps > 0 && result.designs.size() == 2 && !report::rre_maps_can_be_compared(result))
    result.warnings.push_back({"difference_omitted",
                               "the difference of the maps is not drawn, because the two designs have different values "
                               "of detector.acceptance_half_angle_deg"});
}

/// Adds the files of polar maps. The difference of the maps is drawn if there are two designs whose maps can be
/// compared.
void add_map_files(ResultFiles& files, std::size_t designs, const studies::RreResult& result) {
  const auto has_maps = [&] { return result.has_complete_maps(); };
  files.add("map.csv", [&] { return studies::rre_map_csv(result); });
  files.add_drawing(
      "map", [&] { return report::rre_map_plot(result); }, has_maps);
  if (designs == 2)
    files.add_drawing(
        "map_difference", [&] { return report::rre_map_difference_plot(result); },
        [&] { return report::rre_maps_can_be_compared(result); });
}

/// Adds the output files of the command.
/// \param result result of the computation; it is filled before the files are written
/// \param designs number of designs
void add_files(ResultFiles& files, const studies::RreSettings& asked, std::size_t designs,
               const studies::RreResult& result) {
  files.add("rre.csv", [&] { return studies::rre_csv(result); });
  if (asked.map) {
    add_map_files(files, designs, result);
  } else {
    files.add_drawing("rre", [&] { return report::rre_plot(result); });
  }
  if (asked.footprint) {
    files.add("footprint.json", [&] { return studies::footprint_json(result); });
    files.add_drawing("footprint", [&] { return report::footprint_plot(result); });
  }
  if (asked.far_field) {
    files.add("far_field.json", [&] { return studies::far_field_json(result); });
    files.add("far_field.csv", [&] { return studies::far_field_csv(result); });
  }
}

/// Returns advice for a shorter run: options to change, with their current values.
Words what_shortens_rre(const studies::RreSettings& request) {
  Words advice;
  if (request.rays) {
    advice.push_back(fmt::format("give a smaller --samples (now {})", *request.rays));
  } else if (request.cutoff && request.engine == raytrace::Engine::exact) {
    advice.push_back(fmt::format("give a larger --cutoff (now {})", shortest(*request.cutoff)));
  } else if (request.engine == raytrace::Engine::exact && !request.target_error) {
    advice.emplace_back("give a --target-error larger than 1e-10");
  } else {
    advice.push_back(fmt::format("give a larger --target-error (now {})", shortest(target_error_of(request))));
  }
  if (request.incidence_deg.size() * request.azimuth_deg.size() > 1 || !request.incidence_spans.empty())
    advice.emplace_back("give fewer directions (--incidence, --azimuth)");
  return advice;
}

/// Returns the text for the terminal: the table, or a summary if the table is long and is in the output folder.
std::string text_of(const studies::RreResult& result, const CommonOptions& common) {
  if (result.has_complete_maps()) return studies::rre_map_table(result) + studies::derivative_table(result);
  const std::string table = studies::rre_table(result) + studies::derivative_table(result);
  return is_shown_whole(table, common) ? table : studies::rre_summary(result, kMaxTableLines);
}

/// Returns settings of a rough computation that takes a few seconds: the first direction of each design, with a larger
/// error and without other results.
studies::RreSettings preliminary_settings(const studies::RreSettings& request) {
  // Target error of preliminary values. Rays reach it within a second for most designs.
  constexpr double preliminary_error = 3e-3;
  studies::RreSettings settings;
  settings.incidence_deg = {request.incidence_deg.empty() ? request.incidence_spans.front().low
                                                          : request.incidence_deg.front()};
  settings.azimuth_deg = {request.azimuth_deg.front()};
  settings.target_error = std::max(preliminary_error, target_error_of(request));
  settings.seed = request.seed;
  return settings;
}

/// Computes preliminary values and returns them as a table. Returns an empty text if the computation is cancelled.
std::string preliminary_table(const std::vector<design::Design>& designs, const studies::RreSettings& request,
                              const Cancellation* cancel) {
  const studies::RreResult result = studies::RreStudy(designs, preliminary_settings(request)).run(nullptr, cancel);
  if (!result.complete) return {};
  return fmt::format("preliminary values, with a larger error:\n{}", studies::rre_table(result));
}

ExitCode run(const RreOptions& options, const CommonOptions& common) {
  const studies::RreSettings request = settings_of(options, common);
  const std::vector<design::Design> designs = designs_of(options, common);
  studies::RreResult result;
  ResultFiles files(common, files_read(designs), "rre.json");
  add_files(files, request, designs.size(), result);
  const studies::RreStudy study(designs, request);
  const OrderlyInterrupt interrupt;
  files.prepare();
  {
    ProgressBar bar({"tracing", what_shortens_rre(request)}, common);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      const FirstAnswer first(bar, cancel, [&](std::optional<double>, const Cancellation* stop) {
        return preliminary_table(designs, request, stop);
      });
      result = study.run(&bar, cancel);
    });
  }
  warn_of_panels(result);
  warn_of_maps(result);
  return files.write(
      studies::rre_json(result), text_of(result, common), result.warnings,
      {.complete = result.complete, .interrupted = fmt::format("finished points: {}", result.points.size())});
}

}  // namespace

Command rre_command() {
  return {
      .name = "rre",
      .summary = "retroreflective efficiency against angle",
      .manual =
          R"(Computes the retroreflective efficiency (RRE) over angles of incidence and azimuths, with its standard error and a ledger of all other light.

`exact` follows beams and has no noise. `stochastic` follows strong beams like `exact` and resamples weak beams; its noise is far below that of rays for the same time, except where light enters prisms at oblique azimuths. `cell` is a Monte Carlo engine in SIMD lanes for infinite arrays, and for arrays of equal elements that extend more than two elements from every border (Embree traces the borders). `embree` is a Monte Carlo engine for every design. `montecarlo` uses `cell` if possible, and otherwise `embree`. `auto` selects, for each direction and wavelength, the one of `exact`, `stochastic` and `montecarlo` that is expected to reach the target error first.

A LIST can combine values `a,b,c` and ranges `start:stop:step`, which include the stop, such as `--incidence=-40:40:5`. With `start:stop:auto`, `--incidence` selects the angles automatically: the ends, 0, the angles at which total reflection begins or ends, and as many others as needed for linear interpolation with an error below the target error or 1e-3, whichever is greater.

`--map` computes RRE over incidence and azimuth as a polar map, with contour lines. Without `--incidence` and `--azimuth`, the directions are `--incidence=0:80:5` and `--azimuth=0:350:10`. Directions that symmetries of the part map to each other are traced only one time. The default target error is 1e-3. With two designs, the difference of their maps is drawn as well.

`--derivatives` computes the derivatives of RRE with respect to size, angle of the facets, index, thickness and incidence, with an estimate of their errors. Where RRE has a kink or a jump, a derivative is left out and the reason is given. `--footprint` and `--far-field` write files of these names to the folder of `--out`.)",
      .reads = {"retrace.design/1"},
      .writes = {"retrace.rre/1", "retrace.footprint/2", "retrace.far_field/1"},
      .begin = begins<RreOptions>(arguments, run)};
}

}  // namespace retrace::app
