#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "app/commands.h"
#include "app/job_output.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "requests/descriptions.h"
#include "studies/calibration/io/calibration_files.h"
#include "studies/metrology/metrology.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

struct CorrectOptions {
  std::string job;
  std::vector<std::string> maps;
  FieldTexts reading;
};

std::vector<Argument> arguments(CorrectOptions& options) {
  std::vector<Argument> all = {job_argument(options.job, "job file whose programs cut the part"),
                               {"MAP",
                                "height maps of the part, each as FILE@X,Y or FILE@X,Y,TURN: position of the map's "
                                "centre on the workpiece, in mm, and rotation of the map about Z, in degrees",
                                &options.maps, files("")}};
  const std::array<CommandRequest, 1> of_command = {{{requests::height_map_reading()}}};
  for (Argument& argument : field_arguments(of_command, options.reading)) all.push_back(std::move(argument));
  return all;
}

[[noreturn]] void refuse_place(const std::string& text) {
  throw InputError(
      {"", 0, "MAP"},
      "the position of the centre of the map in mm must follow the name of the file, as in facets.txt@0.25,-0.5; got " +
          in_quotes(text));
}

/// Reads the file name and the position of a height map from a text. The returned map does not contain heights yet.
/// \param text FILE@X,Y or FILE@X,Y,TURN
studies::FacetMap place_of(const std::string& text) {
  constexpr double kFarthestMm = 1e4;
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0) refuse_place(text);
  std::vector<double> numbers;
  for (const std::string_view word : split(std::string_view(text).substr(at + 1), ',')) {
    const std::optional<double> number = number_in(word);
    if (!number || !(std::abs(*number) <= kFarthestMm)) refuse_place(text);
    numbers.push_back(*number);
  }
  if (numbers.size() < 2 || numbers.size() > 3) refuse_place(text);
  studies::FacetMap map;
  map.file = text.substr(0, at);
  map.centre_mm = {numbers[0], numbers[1]};
  map.rotation_deg = numbers.size() == 3 ? numbers[2] : 0.0;
  return map;
}

/// Returns a copy of the job that uses the corrected machine file. The job and the machine file are both written to
/// `folder`. The design file stays where it is, and its path in the job is made relative to `folder`.
fabrication::Job corrected_job(fabrication::Job job, const fs::path& file, const fs::path& folder) {
  job.machine = "machine.toml";
  std::error_code error;
  const fs::path design = file.parent_path() / job.design;
  if (!job.design.empty() && fs::is_regular_file(design, error)) job.design = name_from(folder, design);
  return job;
}

ExitCode run(const CorrectOptions& options, const CommonOptions& common) {
  std::vector<studies::FacetMap> maps;
  for (const std::string& text : options.maps) maps.push_back(place_of(text));
  const studies::FabricationResult plan = studies::fabricate(options.job);
  std::vector<std::string> inputs = {options.job};
  if (fs::path(plan.job.machine).has_extension()) inputs.push_back(plan.job.machine);
  for (const studies::FacetMap& map : maps) inputs.push_back(map.file);
  ResultFiles files(common, inputs, "correction.json");
  std::optional<studies::Correction> result;
  files.add("machine.toml", [&] { return fabrication::machine_text(result->calibration.machine); });
  files.add("job.toml", [&] { return fabrication::job_text(corrected_job(plan.job, options.job, common.out)); });
  files.add("residuals.csv", [&] { return studies::residuals_csv(result->calibration); });
  files.check();
  Warnings warnings;
  MetrologyRequest reading;
  set_fields(requests::height_map_reading(), &reading, options.reading, common);
  for (studies::FacetMap& map : maps) {
    surface_models::HeightMapFile file = surface_models::read_height_map(map.file, studies::reading_of(reading));
    for (const Warning& warning : file.warnings) warnings.push_back(warning);
    map.heights = std::move(file.map);
  }
  result = studies::correct(plan, std::move(maps));
  files.prepare();
  append(warnings, result->calibration.warnings);
  return files.write(studies::correction_json(*result), studies::correction_table(*result), warnings);
}

}  // namespace

Command correct_command() {
  return {.name = "correct",
          .summary = "a corrected machine and job, from height maps of the part that the job cut",
          .manual =
              "Registers height maps of a part with its design and measures the deviations of each facet and of the "
              "blank's face. From these it estimates the set-up errors, each with its uncertainty. Writes the "
              "corrected machine file and a job for it, and predicts the deviations of the next part.",
          .reads = {"retrace.job/1", "retrace.machine/1", "height map (text, SDF, GSF, GWY)"},
          .writes = {"retrace.correction/2", "retrace.machine/1", "retrace.job/1"},
          .refuses_set = "not allowed with correct, which reads no design",
          .begin = begins<CorrectOptions>(arguments, run)};
}

}  // namespace retrace::app
