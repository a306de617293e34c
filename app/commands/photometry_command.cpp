#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <set>

#include "app/commands.h"
#include "app/first_answer.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "core/data_directory.h"
#include "design/io/design_reader.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace::app {
namespace {

struct PhotometryOptions {
  std::string design;
  std::string compare;  ///< design file whose map is compared; empty: none
  FieldTexts fields;
};

/// Returns words that occur in the shipped table of limits, sorted and without duplicates.
/// \param of function that returns the words of a row, such as its classes
template <class Of>
Words in_limits(const Of& of) {
  std::set<std::string> words;
  const studies::LimitTable table = studies::read_limits(data_directory() / "photometry_limits.csv");
  for (const auto& row : table.rows) words.merge(of(row));
  for (const auto& factor : table.factors) words.merge(of(factor));
  return {words.begin(), words.end()};
}

Words classes() {
  return in_limits([](const auto& row) { return std::set<std::string>(row.classes.begin(), row.classes.end()); });
}

Words colours() {
  return in_limits([](const auto& row) { return std::set<std::string>{row.colour == "clear" ? "white" : row.colour}; });
}

std::vector<Argument> arguments(PhotometryOptions& options) {
  std::vector<Argument> all = {design_argument(options.design)};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<PhotometryRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) {
    if (argument.name.starts_with("--class ")) argument.traits.words = classes;
    if (argument.name.starts_with("--colour ")) argument.traits.words = colours;
    all.push_back(std::move(argument));
  }
  Argument compare{"--compare DESIGN", "a second design, for maps of both designs and of their ratio", &options.compare,
                   files(".toml")};
  compare.traits.needs = {any_given({"--map"})};
  all.push_back(std::move(compare));
  return all;
}

/// Adds the output files of the command.
/// \param result result of the computation; it is filled before the files are written
void add_files(ResultFiles& files, const studies::PhotometryResult& result) {
  files.add("photometry.csv", [&] { return studies::photometry_csv(result); });
  files.add("far_field.csv", [&] { return studies::far_field_map_csv(result); });
  files.add_drawing("far_field", [&] { return report::far_field_plot(result); });
  files.add_drawing("r_a", [&] { return report::observation_plot(result); });
}

/// Adds the files of the maps over entrance and observation angle. Maps that are not finished have no files.
/// \param has_compared true if there is a second design
void add_map_files(ResultFiles& files, bool has_compared, const studies::PhotometryResult& result) {
  const auto has_maps = [&] { return !result.coefficient_maps.empty(); };
  files.add("map.csv", [&] { return studies::coefficient_map_csv(result); });
  files.add_drawing(
      "map", [&] { return report::coefficient_map_plot(result); }, has_maps);
  if (!has_compared) return;
  files.add("map_ratio.csv", [&] { return studies::coefficient_ratio_csv(result); });
  files.add_drawing(
      "map_ratio", [&] { return report::coefficient_ratio_plot(result); }, has_maps);
}

/// Adds a warning if the drawing does not show all maps.
void warn_of_panels(studies::PhotometryResult& result) {
  if (result.coefficient_maps.size() <= report::kMaxMapPanels) return;
  result.warnings.push_back({"maps_omitted", fmt::format("map.svg and map.png show the first {} of {} maps",
                                                         report::kMaxMapPanels, result.coefficient_maps.size())});
}

/// Returns the tables for the terminal. Long tables are shortened if they are in the output folder.
std::string text_of(const studies::PhotometryResult& result, const CommonOptions& common) {
  constexpr std::size_t kFewRows = 8, kFewRowsWithMaps = 3, kFewMapTables = 1;
  const std::string table = studies::photometry_table(result) + studies::coefficient_map_table(result);
  if (is_shown_whole(table, common)) return table;
  const bool has_maps = !result.coefficient_maps.empty();
  return studies::photometry_table(result, has_maps ? kFewRowsWithMaps : kFewRows) +
         studies::coefficient_map_table(result, kFewMapTables);
}

/// Returns advice for a shorter run: options to change, with their current values.
/// \param has_rotations true if several rotations of the part are measured
Words what_shortens_photometry(const PhotometryRequest& request, const studies::PhotometryStudy& study,
                               bool has_rotations) {
  Words advice;
  if (study.uses_beams())
    advice.push_back(fmt::format("give a larger --cutoff (now {:.3g})", study.cutoff()));
  else
    advice.push_back(
        fmt::format("give a smaller --samples (now {})", request.samples.value_or(studies::kDefaultRaysPerDirection)));
  if (has_rotations) advice.emplace_back("give fewer rotations (--rotation)");
  if (request.map) advice.emplace_back("give fewer entrance angles of the map (--map-entrance)");
  return advice;
}

/// Computes preliminary readings (rough photometric values at the test points) and returns them as a table. The
/// computation takes some seconds. Returns an empty text if the computation is cancelled.
/// \param remaining_s estimated remaining time of the main computation, in seconds; empty if it is unknown
std::string first_answer_of(const studies::PhotometryStudy& study, std::optional<double> remaining_s,
                            const Cancellation* cancel) {
  // Intended tracing time of the preliminary readings in seconds. The actual time is about twice as long, because the
  // main computation runs in parallel.
  constexpr double first_answer_s = 3.0;
  constexpr double unknown_time_s = 600.0;
  const double share = std::min(1.0, first_answer_s / remaining_s.value_or(unknown_time_s));
  const auto answer = study.first_answer(share, cancel);
  return answer ? studies::first_answer_table(*answer) : std::string();
}

ExitCode run(const PhotometryOptions& options, const CommonOptions& common) {
  const design::Design design = design::read_design(options.design, common.overrides);
  std::vector<design::Design> designs = {design};
  if (!options.compare.empty()) designs.push_back(design::read_design(options.compare, common.overrides));
  std::vector<std::string> inputs = files_read(designs);
  auto request = request_of<PhotometryRequest>(options.fields, common);
  request.pictures = !common.out.empty();
  const bool is_coloured = design.substance.is_coloured();
  studies::PhotometrySettings settings = studies::resolve(request, is_coloured);
  inputs.push_back(studies::limits_file_of(request.standard).string());
  const std::filesystem::path dye = studies::dye_file_of(request.dye, is_coloured, settings.test_plan.colour);
  if (!dye.empty()) inputs.push_back(dye.string());
  if (designs.size() > 1)
    settings.compared = studies::compared_design(request, designs.back(), settings.test_plan.colour);
  const bool has_rotations = settings.rotation_deg.size() > 1;
  const studies::PhotometryStudy study(design, std::move(settings));
  const OrderlyInterrupt interrupt;
  studies::PhotometryResult result;
  ResultFiles files(common, inputs, "photometry.json");
  add_files(files, result);
  if (request.map) add_map_files(files, designs.size() > 1, result);
  files.prepare();
  const RunText text{"tracing", what_shortens_photometry(request, study, has_rotations)};
  {
    ProgressBar bar(text, common);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      const FirstAnswer first(bar, cancel, [&study](std::optional<double> remaining_s, const Cancellation* stop) {
        return first_answer_of(study, remaining_s, stop);
      });
      result = study.run(&bar, cancel);
    });
  }
  warn_of_panels(result);
  return files.write(studies::photometry_json(result), text_of(result, common), result.warnings,
                     {.complete = result.complete, .is_yes = result.passes()});
}

}  // namespace

Command photometry_command() {
  return {.name = "photometry",
          .summary = "coefficients of retroreflection and colour against a standard",
          .manual =
              "Coefficients of retroreflection at the test points of a standard, their limits, a verdict, and what "
              "to change if a point fails; the colour of the returned light, with a verdict of its own. `--class` and "
              "`--colour` are needed where the standard has several. "
              "`--map` adds maps of R_A, or of R_I if the standard limits R_I, over entrance and observation angle. "
              "Exits with 1 if a limit is missed, the colour lies outside its boundaries, or the verdict on the points "
              "is undetermined.",
          .reads = {"retrace.design/1", "limits (CSV)", "absorption of a dye (CSV)"},
          .writes = {"retrace.photometry/2"},
          .begin = begins<PhotometryOptions>(arguments, run)};
}

}  // namespace retrace::app
