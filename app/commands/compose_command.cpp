#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/job_output.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/shared_arguments.h"
#include "app/study_bar.h"
#include "design/io/design_reader.h"
#include "report/results/result_plots.h"
#include "requests/row.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/compose/io/composition_files.h"
#include "studies/compose/io/zone_designs.h"
#include "studies/fabrication/job_maker.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/machining_limits.h"
#include "studies/sweep/shared_sweep.h"

namespace retrace::app {
namespace {

/// Returns the text of the design file for the cells of zone `zone`, counted from 0. Returns an empty text if there is
/// no such zone.
std::string zone_design(const studies::Study& study, const std::vector<studies::Zone>& zones, std::size_t zone) {
  return zone < zones.size() ? studies::zone_design_text(study, zones, zone) : "";
}

struct ComposeOptions : StudyOptions {
  std::string design;
  std::string layout = "stripes";
  bool for_worst = false;
  std::string job;  ///< output file for the fabrication job of the whole part; not written if empty
  MakingOptions making;
  std::optional<double> x_length_mm;
  std::optional<double> y_length_mm;
};

std::vector<Argument> compose_arguments(ComposeOptions& options) {
  std::vector<Argument> all = study_arguments(options);
  all.push_back(
      {"--design FILE", "write the design of the whole part, with its zones", &options.design, files(".toml")});
  all.push_back({"--layout WORD", "arrangement of the zones in --design: stripes, blocks or rows", &options.layout,
                 one_of(words_of(studies::kZoneLayouts))});
  all.back().traits.needs = {any_given({"--design"})};
  all.push_back(
      {"--for-worst",
       "write the zones that are best for the worst parts; compose.worst_fraction of the study is their fraction",
       &options.for_worst,
       {.needs = {any_given({"--out", "--design"})}}});
  for (const auto& [name, help, length] :
       {std::tuple{"--x-length-mm L", "x length of the part in --design, with --y-length-mm [as in the study's design]",
                   &options.x_length_mm},
        {"--y-length-mm L", "y length of the part in --design, with --x-length-mm [as in the study's design]",
         &options.y_length_mm}}) {
    all.push_back({name, help, length});
    all.back().traits.needs = {any_given({"--design"})};
  }
  all.push_back({"--job FILE", "write the fabrication job of the part in --design", &options.job, files(".toml")});
  all.back().traits.needs = {any_given({"--design"})};
  for (Argument& argument : making_arguments(options.making, "--job")) all.push_back(std::move(argument));
  return all;
}

/// Checks the options of the fabrication job. The check is made before the search, because a search can take a long
/// time.
/// \throw InputError
void check_job_of(const ComposeOptions& options, const JobRequest& request) {
  if (options.job.empty()) return;
  if (request.tool_width_mm == 0.0) throw InputError(Field{"tool_width_mm"}, "is required with --job");
  studies::check_job_request(request);
  studies::check_cuts_zones(request);
}

studies::ZonedDesignRequest zoned_design_of(const ComposeOptions& options) {
  studies::ZonedDesignRequest request;
  request.layout = studies::read_zone_layout(options.layout);
  if (options.x_length_mm.has_value() != options.y_length_mm.has_value())
    throw InputError({"", 0, options.x_length_mm ? "--y-length-mm" : "--x-length-mm"},
                     "is required, because --x-length-mm and --y-length-mm must be given together");
  if (options.x_length_mm) request.size_mm = {*options.x_length_mm, *options.y_length_mm};
  return request;
}

/// Contents of the output files that describe the whole part with its zones.
struct WholePart {
  std::string design;                        ///< text of the design file; empty if not requested
  std::optional<studies::GeneratedJob> job;  ///< fabrication job; no value if it is not requested
  bool is_complete = true;                   ///< false if a requested file cannot be made
};

/// Returns the design and the fabrication job of the whole part, if they are requested.
/// \param warnings receives the reason if the design or the job cannot be made. All other results are written in any
/// case
WholePart whole_part_of(const ComposeOptions& options, const JobRequest& making, const studies::Study& study,
                        const std::vector<studies::Zone>& zones, const studies::ZonedDesignRequest& zoned,
                        Warnings& warnings) {
  WholePart whole;
  if (options.design.empty()) return whole;
  try {
    whole.design = studies::zoned_design_text(study, zones, zoned);
    if (options.job.empty()) return whole;
    whole.job = studies::make_job(design::parse_design(whole.design, options.design), making);
    append(warnings, whole.job->warnings);
  } catch (const InputError& error) {
    warnings.push_back({"zones_not_written", fmt::format("the file {} is not written: {}",
                                                         whole.design.empty() ? options.design : options.job,
                                                         error.message(requests::option_of_field))});
    whole.is_complete = false;
  }
  return whole;
}

studies::Study study_of_parts(const ComposeOptions& options, const CommonOptions& common) {
  return studies::with_machining_limits(studies::read_study(options.study, common.overrides, common.seed));
}

/// Searches for the best composition and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode compose_part(const ComposeOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  const auto start = std::chrono::steady_clock::now();
  const studies::Study study = study_of_parts(options, common);
  const studies::ComposeRequest request = studies::read_compose(study);
  const OrderlyInterrupt interrupt;
  if (options.for_worst && !(request.errors && request.errors->worst_fraction))
    throw InputError({"", 0, "--for-worst"}, "requires the key compose.worst_fraction in the study");
  studies::Composition composition;
  const auto written_zones = [&] {
    if (options.for_worst) return studies::robust_zones(composition);
    return composition.best ? composition.best->zones : std::vector<studies::Zone>{};
  };
  std::vector<std::string> inputs = study.files;
  const JobRequest making = job_request(options.making, common);
  for (const std::string& file : files_of_making(making)) inputs.push_back(file);
  ResultFiles files(common, inputs, "composition.json");
  files.add("composition.csv", [&] { return studies::composition_csv(study, request, composition); });
  files.add_drawing("composition", [&] { return report::composition_plot(study, request, composition); });
  for (std::size_t zone = 0; zone < studies::max_zone_designs(request); ++zone)
    files.add(fmt::format("zone_{}.toml", zone + 1), [&, zone] { return zone_design(study, written_zones(), zone); });
  const studies::ZonedDesignRequest zoned = zoned_design_of(options);
  if (!options.design.empty()) studies::check_zoned_design(study, zoned);
  check_job_of(options, making);
  WholePart whole;
  files.add_named("--design", options.design, [&] { return whole.design; });
  files.add_named("--job", options.job, [&] { return whole.job ? job_text_at(*whole.job, options.job) : ""; });
  const std::filesystem::path file = files.reserve("composition.sqlite");
  files.prepare();
  compute::ResultStore store(file, studies::compose_layout(study), if_exists_of(options));
  {
    SearchBar bar(
        {"composing", to_shorten_study(study, fmt::format("give a smaller compose.scan (now {})", request.scan))},
        "cells", common);
    bar.on_best(
        [&](const studies::Variant& best) {
          return fmt::format("minimum of all goals {:.5g} with one kind of cell", *best.objective);
        },
        {});
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      if (const DistributeTasks share = distribute_among(session, slots(common), cancel))
        studies::distribute_sweep(studies::compose_scan(study, request), store, &bar, share);
      composition = studies::compose(study, request, store, &bar, cancel);
    });
  }
  if (!composition.complete) studies::choose_best_so_far(study, request, store, composition);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string why_not = studies::why_not_reached(study, request, composition);
  Warnings warnings = remarks_of(session);
  const Warnings without_effect = studies::keys_without_effect(study);
  append(warnings, without_effect);
  if (composition.best) whole = whole_part_of(options, making, study, written_zones(), zoned, warnings);
  const ExitCode code = files.write(
      studies::composition_json(study, request, composition, elapsed_s),
      without_middle(studies::composition_text(study, request, composition), common, "composition.json"), warnings,
      {.complete = composition.complete,
       .interrupted = fmt::format("cells evaluated: {}", composition.evaluations),
       .is_yes = why_not.empty()});
  if (code == ExitCode::answer_is_no) print_to_stderr("retrace: no part meets all constraints: " + why_not);
  return code == ExitCode::done && !whole.is_complete ? ExitCode::failed : code;
}

ExitCode run_compose(const ComposeOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, slots(common), [&](compute::MpiSession* session) { return compose_part(options, common, session); },
      [&] {
        const studies::Study study = study_of_parts(options, common);
        return studies::compute_task(studies::compose_scan(study, studies::read_compose(study)));
      });
}

}  // namespace

Command compose_command() {
  return {
      .name = "compose",
      .summary = "the best division of a part into zones of cells, as defined in a study file",
      .manual =
          "Searches by linear programming for the cells, and their fractions of the area, that maximize the worst of "
          "all goals. Reports the active constraints and their prices. Evaluated cells are kept in "
          "`composition.sqlite` in the output folder and are reused by the next run. `--design` writes the part with "
          "its zones as one design, `--job` its fabrication job. Exits with 1 if no part meets all constraints.",
      .reads = {"retrace.study/1", "retrace.design/1", "retrace.machine/1", "retrace.process/1"},
      .writes = {"retrace.composition/2", "retrace.design/1", "retrace.job/1"},
      .begin = begins(compose_arguments, run_compose)};
}

}  // namespace retrace::app
