#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/output.h"
#include "app/request_options.h"
#include "core/message_text.h"
#include "core/threads.h"
#include "core/toml_file.h"
#include "fabrication/check/io/program_files.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/read/nc_program.h"
#include "geometry/io/facet_planes_reader.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/closed_loop/as_machined.h"
#include "studies/closed_loop/io/verification_files.h"
#include "studies/closed_loop/verification.h"
#include "studies/planing/io/planing_files.h"
#include "studies/planing/planing_study.h"
#include "studies/turning/io/turning_files.h"
#include "studies/turning/turn.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

struct VerifyOptions {
  std::string job;  ///< path of a job file, or of the file of a turned or planed part
  std::vector<std::string> programs;
  FieldTexts fields;
  std::string as_machined;  ///< output file for the design of the machined part; not written if empty
  std::string map;          ///< output file for the error map (PNG); not written if empty
  std::string servo;        ///< input file with the strokes of the fast tool servo; empty if not given
};

std::vector<Argument> arguments(VerifyOptions& options) {
  std::vector<Argument> all = {
      {"JOB|PART", "job file, or the file of a planed or turned part", &options.job, files(".toml")},
      {"PROGRAM", "NC programs, in the order in which they run; FILE@LINE: stopped after that line", &options.programs,
       files("")}};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<VerificationRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  all.push_back({"--map FILE", "jobs: draw the material that the programs leave above the facets, as a PNG file",
                 &options.map, files(".png")});
  all.push_back(
      {"--as-machined FILE", "jobs: write the machined part as a design", &options.as_machined, files(".toml")});
  all.push_back({"--servo FILE", "turned parts with a fast tool servo: file with its strokes, servo.csv of `turn`",
                 &options.servo, files(".csv")});
  return all;
}

VerificationRequest request_of_command(const VerifyOptions& options, const CommonOptions& common) {
  auto request = request_of<VerificationRequest>(options.fields, common);
  request.job = options.job;
  request.programs = options.programs;
  return request;
}

/// Runs a study and measures its duration.
/// \param elapsed_s receives the duration in seconds
template <class Study>
auto timed(const CommonOptions& common, double& elapsed_s, const Study& study) {
  std::optional<decltype(study())> run;
  const auto start = std::chrono::steady_clock::now();
  run_with_threads(common.threads.value_or(0), [&] { run = study(); });
  elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return *std::move(run);
}

/// Kinds of files that define what NC programs must cut. A file without the key `schema` is a planed part if it has a
/// table `mill` or `lathe`, and a job otherwise.
enum class Kind { job, planed_part, turned_part };
constexpr std::string_view kSchemas[] = {"retrace.job/1", "retrace.planed_part/1", "retrace.turned_part/1"};

Kind kind_of(const std::string& file) {
  TomlTable table = parse_toml(read_file(file), file);
  const std::optional<std::string> schema = table.text("schema");
  if (!schema) return table.has("mill") || table.has("lathe") ? Kind::planed_part : Kind::job;
  const auto* const found = std::find(std::begin(kSchemas), std::end(kSchemas), *schema);
  if (found == std::end(kSchemas))
    table.fail("schema", fmt::format("must be {}, got {}", alternatives(kSchemas), in_quotes(*schema)));
  return static_cast<Kind>(found - std::begin(kSchemas));
}

/// Refuses options that do not apply to files of kind `kind`.
void refuse_others(const VerifyOptions& options, const VerificationRequest& request, Kind kind) {
  const auto refuse = [&](const std::string& option, const char* whom) {
    throw InputError({"", 0, option}, fmt::format("only allowed for the files of {}, but {} is a file of another kind",
                                                  whom, options.job));
  };
  if (kind != Kind::turned_part && !options.servo.empty()) refuse("--servo", "turned parts");
  if (kind == Kind::job) return;
  const std::pair<std::string, bool> of_jobs[] = {
      {requests::option_of_field("next_stage"), !request.next_stage.empty()},
      {requests::option_of_field("tolerance_nm"), request.tolerance_nm.has_value()},
      {"--map", !options.map.empty()},
      {"--as-machined", !options.as_machined.empty()}};
  for (const auto& [option, is_given] : of_jobs)
    if (is_given) refuse(option, "jobs");
}

/// Returns the files of the programs and the file of the job or part.
std::vector<std::string> program_files(const VerifyOptions& options) {
  std::vector<std::string> files;
  for (const std::string& program : options.programs) files.push_back(fabrication::program_name(program).file);
  files.push_back(options.job);
  return files;
}

/// Verifies programs of a turned or planed part with a study, and writes the results.
template <class Study>
ExitCode run_part(const VerifyOptions& options, const CommonOptions& common, const Study& study) {
  std::vector<std::string> inputs = program_files(options);
  if (!options.servo.empty()) inputs.push_back(options.servo);
  const ResultFiles files(common, std::move(inputs), "verification.json");
  files.check();
  double elapsed_s = 0.0;
  const auto run = timed(common, elapsed_s, study);
  files.prepare();
  return files.write(studies::verification_json(run, elapsed_s), studies::verification_table(run), run.part_warnings(),
                     {.is_yes = run.passes()});
}

std::vector<std::string> inputs_of(const VerifyOptions& options) {
  std::vector<std::string> files = program_files(options);
  if (const fs::path machine = fabrication::read_job(options.job).machine; machine.has_extension())
    files.push_back(machine.string());
  return files;
}

/// Returns the path of the table of facet planes that belongs to an as-machined design, such as part_facets.csv for
/// part.toml. Returns an empty path if `design` is empty.
fs::path facets_file_of(const fs::path& design) {
  return design.empty() ? fs::path() : design.parent_path() / (design.stem().string() + "_facets.csv");
}

ExitCode run_job(const VerifyOptions& options, const VerificationRequest& request, const CommonOptions& common) {
  const fs::path facets_file = facets_file_of(options.as_machined);
  studies::VerificationRun run;
  std::string design;
  std::string facets;
  ResultFiles files(common, inputs_of(options), "verification.json");
  files.add_named("--as-machined", options.as_machined, [&] { return design; });
  files.add_named("--as-machined", facets_file, [&] { return facets; });
  files.add_named("--map", options.map,
                  [&] { return report::render_png(report::error_map_plot(studies::error_map(run))); });
  files.check();
  double elapsed_s = 0.0;
  run = timed(common, elapsed_s, [&] { return studies::run_verification(request); });
  if (!options.as_machined.empty()) {
    const studies::AsMachined part = studies::as_machined(run);
    append(run.warnings, part.warnings);
    design = studies::as_machined_toml(run, part, facets_file.filename().string());
    if (part.planes) facets = geometry::facet_planes_text(*part.planes);
  }
  files.prepare();
  return files.write(studies::verification_json(run, elapsed_s), studies::verification_table(run), run.warnings,
                     {.is_yes = run.result.passes()});
}

ExitCode run(const VerifyOptions& options, const CommonOptions& common) {
  const VerificationRequest request = request_of_command(options, common);
  const Kind kind = kind_of(options.job);
  refuse_others(options, request, kind);
  switch (kind) {
    case Kind::job: break;
    case Kind::planed_part:
      return run_part(options, common,
                      [&] { return studies::verify_planing(options.job, options.programs, request.dialect); });
    case Kind::turned_part:
      return run_part(options, common, [&] {
        return studies::verify_turning({options.job, options.programs, request.dialect, options.servo});
      });
  }
  return run_job(options, request, common);
}

}  // namespace

Command verify_command() {
  return {
      .name = "verify",
      .summary = "check of NC programs against their fabrication job or part",
      .manual =
          "Reads NC programs as a controller does, cuts the blank with the axes of the job's machine, and reports, "
          "with the lines of the programs, what differs from the design. `--as-machined` writes the machined part as a "
          "design, `--map` draws the remaining material. Programs of planed and turned parts from any source are "
          "compared with the file of the part. Exits with 1 if there are findings.",
      .reads = {"retrace.job/1", "retrace.machine/1", "retrace.planed_part/1", "retrace.turned_part/1", "NC programs"},
      .writes = {"retrace.verification/2", "retrace.design/1"},
      .refuses_set = "not allowed with verify, which reads no design",
      .begin = begins<VerifyOptions>(arguments, run)};
}

}  // namespace retrace::app
