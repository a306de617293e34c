#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "app/commands.h"
#include "app/first_answer.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/shared_arguments.h"
#include "core/data_directory.h"
#include "report/results/result_plots.h"
#include "requests/number_list.h"
#include "studies/design/io/design_reader.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/standards.h"

namespace retrace::app {
namespace {

struct PhotometryOptions {
  std::string design;
  std::string standard;
  std::optional<std::string> part_class;
  std::optional<std::string> colour;
  double area_cm2 = 0.0;
  std::optional<std::string> rotation;
  std::optional<std::string> dye;
  std::optional<double> source_arcmin;
  std::optional<double> receiver_arcmin;
  double window_deg = 2.0;
  std::string light = "a";
  std::string engine = "auto";
  std::optional<std::uint64_t> samples;
  std::optional<double> cutoff;
  bool no_diffraction = false;
  bool window_power = false;
  bool no_advice = false;
};

Words standards() {
  Words words;
  for (const studies::ShippedStandard& standard : studies::shipped_standards()) words.emplace_back(standard.name);
  return words;
}

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
  const Traits of_beams = {.needs = {engine_need(studies::kExactEngines)}};
  Traits of_rays = whole(1);
  of_rays.needs = {engine_need(studies::kRayEnginesOfParts)};
  return {
      design_argument(options.design),
      {"--standard NAME|FILE",
       "r150, j594, bicycle, d4956, iso20471, stvzvo, or a limits file",
       &options.standard,
       {.words = standards, .files = ".csv", .required = true}},
      {"--class CLASS", "class of the part, such as IA [required if the standard has several]", &options.part_class,
       one_of(classes)},
      {"--colour COLOUR", "white, amber, red, yellow, ... [required if the standard has several]", &options.colour,
       one_of(colours)},
      {"--area-cm2 A",
       "area of the whole part, of which the design may be a section",
       &options.area_cm2,
       {.required = true}},
      {"--rotation LIST", "rotations of the part about its normal in degrees; the minimum counts [the standard's]",
       &options.rotation},
      dye_argument(
          options.dye,
          "none, red, amber (illustrative) or a file [by the colour, unless the design's absorption is spectral]"),
      {"--source-arcmin D", "diameter of the source [the standard's]", &options.source_arcmin},
      {"--receiver-arcmin D", "diameter of the receiver [the standard's]", &options.receiver_arcmin},
      {"--window-deg W", "half angle of the far field that is computed", &options.window_deg},
      {"--light LIGHT", "a, d65: a CIE illuminant as the eye sees it; design: the light of the design", &options.light,
       one_of(Words{"a", "d65", "design"})},
      engine_argument(options.engine, "exact, montecarlo (embree), or auto: beams where they are possible"),
      {"--samples N", fmt::format("number of Monte Carlo rays for each direction [{}]", studies::kUsualRaysOfDirection),
       &options.samples, of_rays},
      {"--cutoff W",
       "minimum power of a beam that is followed exactly, as a fraction of the light on one element. Weaker beams are "
       "resampled with auto and truncated with exact [1e-5; finite parts with resampling: see docs/commands.md]",
       &options.cutoff, of_beams},
      {"--no-diffraction", "compute the geometric far field only", &options.no_diffraction},
      {"--window-power", "integrate the power inside and outside of the far field's window, as a check",
       &options.window_power, of_beams},
      {"--no-advice", "do not search for a change of the design that passes if a point fails", &options.no_advice}};
}

/// Returns a request in which options of the command line replace settings of the standard.
/// \param request settings of the standard
studies::PhotometryRequest with_options(studies::PhotometryRequest request, const PhotometryOptions& options,
                                        const CommonOptions& common) {
  request.area_cm2 = options.area_cm2;
  if (options.rotation) request.rotation_deg = requests::read_number_list(*options.rotation, Field{"rotation_deg"});
  if (options.source_arcmin) request.apertures.source = Angle::from_deg(*options.source_arcmin / 60.0);
  if (options.receiver_arcmin) request.apertures.receiver = Angle::from_deg(*options.receiver_arcmin / 60.0);
  request.window_deg = options.window_deg;
  request.light = studies::light_from_name(options.light);
  request.colour = true;
  request.diffraction = !options.no_diffraction;
  request.window_power = options.window_power;
  request.advice = !options.no_advice;
  request.engine = studies::engine_from_name(options.engine);
  request.cutoff = options.cutoff;
  request.rays = options.samples;
  request.seed = common.seed;
  request.pictures = !common.out.empty();
  return request;
}

/// Adds the output files of the command.
/// \param result result of the computation; it is filled before the files are written
void add_files(ResultFiles& files, const studies::PhotometryResult& result) {
  files.add("photometry.csv", [&] { return studies::photometry_csv(result); });
  files.add("far_field.csv", [&] { return studies::far_field_map_csv(result); });
  files.add_drawing("far_field", [&] { return report::far_field_plot(result); });
  files.add_drawing("r_a", [&] { return report::observation_plot(result); });
}

/// Returns advice for a shorter run: options to change, with their current values.
/// \param has_rotations true if several rotations of the part are measured
Words what_shortens_photometry(const PhotometryOptions& options, const studies::PhotometryStudy& study,
                               bool has_rotations) {
  Words advice;
  if (study.follows_beams())
    advice.push_back(fmt::format("give a larger --cutoff (now {:.3g})", study.cutoff()));
  else
    advice.push_back(
        fmt::format("give a smaller --samples (now {})", options.samples.value_or(studies::kUsualRaysOfDirection)));
  if (has_rotations) advice.emplace_back("give fewer rotations (--rotation)");
  return advice;
}

/// Computes preliminary readings (rough photometric values at the test points) and returns them as a table. The
/// computation takes some seconds. Returns an empty text if the computation is cancelled.
/// \param remaining_s estimated remaining time of the main computation, in seconds; empty if it is unknown
std::string first_answer_of(const studies::PhotometryStudy& study, std::optional<double> remaining_s,
                            const Cancellation* cancel) {
  // Intended tracing time of the preliminary readings in seconds. It is about twice as long while the main computation
  // runs in parallel.
  constexpr double first_answer_s = 3.0;
  constexpr double unknown_time_s = 600.0;
  const double share = std::min(1.0, first_answer_s / remaining_s.value_or(unknown_time_s));
  const auto answer = study.first_answer(share, cancel);
  return answer ? studies::first_answer_table(*answer) : std::string();
}

ExitCode run(const PhotometryOptions& options, const CommonOptions& common) {
  const studies::Design design = studies::read_design(options.design, common.overrides);
  std::vector<std::string> inputs = files_read({design});
  inputs.push_back(studies::limits_file_of(options.standard).string());
  studies::PhotometryRequest request =
      studies::photometry_request({options.standard, options.part_class, options.colour});
  const std::filesystem::path dye =
      studies::dye_file_of(options.dye, design.substance.is_coloured(), request.programme.colour);
  if (!dye.empty()) inputs.push_back(dye.string());
  request = with_options(std::move(request), options, common);
  studies::set_dye(request, options.dye, dye);
  const bool has_rotations = request.rotation_deg.size() > 1;
  const studies::PhotometryStudy study(design, std::move(request));
  const OrderlyInterrupt interrupt;
  studies::PhotometryResult result;
  ResultFiles files(common, inputs, "photometry.json");
  add_files(files, result);
  files.prepare();
  const RunText text{"tracing", what_shortens_photometry(options, study, has_rotations)};
  {
    ProgressBar bar(text, common);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      const FirstAnswer first(bar, cancel, [&study](std::optional<double> remaining_s, const Cancellation* stop) {
        return first_answer_of(study, remaining_s, stop);
      });
      result = study.run(&bar, cancel);
    });
  }
  return files.write(studies::photometry_json(result), studies::photometry_table(result), result.warnings,
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
              "Exits with 1 if a limit is missed, the colour lies outside its boundaries, or the verdict on the points "
              "is undetermined.",
          .reads = {"retrace.design/1", "limits (CSV)", "absorption of a dye (CSV)"},
          .writes = {"retrace.photometry/1"},
          .begin = begins<PhotometryOptions>(arguments, run)};
}

}  // namespace retrace::app
