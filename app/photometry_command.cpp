#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "core/data_directory.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/threads.h"
#include "report/photometry_plot.h"
#include "studies/design/design_reader.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/standards.h"

namespace retrace::app {
namespace {

constexpr double kMostRotations = 720;

/// The file with the limits: the shipped one, or the user's.
std::filesystem::path limits_file(const PhotometryOptions& options) {
  if (studies::find_standard(options.standard) != nullptr) return data_directory() / "photometry_limits.csv";
  if (!std::filesystem::exists(options.standard))
    throw InputError({"", 0, "--standard"}, fmt::format("must be r150, j594, bicycle or a file that exists, got {}",
                                                        in_quotes(options.standard)));
  return options.standard;
}

studies::TestProgramme programme_of(const PhotometryOptions& options, const std::filesystem::path& file) {
  const studies::ShippedStandard* const shipped = studies::find_standard(options.standard);
  const auto standard = shipped != nullptr ? std::optional(std::string(shipped->in_table)) : std::nullopt;
  return studies::programme_of(studies::read_limits(file), standard, options.part_class, options.colour);
}

/// The dye's file; empty for none.
std::filesystem::path dye_file(const PhotometryOptions& options, const studies::Design& design,
                               const studies::TestProgramme& programme) {
  const bool is_told = options.dye.has_value();
  const bool design_is_coloured = !design.absorption_by_wavelength.empty();
  const std::string name = is_told ? *options.dye : (design_is_coloured ? "none" : programme.colour);
  if (name == "red" || name == "amber") return data_directory() / ("dye_" + name + ".csv");
  if (name == "none" || !is_told) return {};
  if (!std::filesystem::exists(name))
    throw InputError({"", 0, "--dye"},
                     fmt::format("must be none, red, amber or a file that exists, got {}", in_quotes(name)));
  return name;
}

raytrace::PhotometricApertures apertures_of(const PhotometryOptions& options) {
  const studies::ShippedStandard* const shipped = studies::find_standard(options.standard);
  raytrace::PhotometricApertures apertures = shipped != nullptr ? shipped->apertures : studies::default_apertures();
  if (options.source_arcmin) apertures.source = Angle::from_deg(*options.source_arcmin / 60.0);
  if (options.receiver_arcmin) apertures.receiver = Angle::from_deg(*options.receiver_arcmin / 60.0);
  return apertures;
}

std::vector<double> rotations_of(const PhotometryOptions& options) {
  if (options.rotation) {
    std::vector<double> turns = read_number_list(*options.rotation, "--rotation");
    if (static_cast<double>(turns.size()) > kMostRotations)
      throw InputError({"", 0, "--rotation"},
                       fmt::format("must be at most {} turns, got {}", kMostRotations, turns.size()));
    return turns;
  }
  const studies::ShippedStandard* const shipped = studies::find_standard(options.standard);
  return shipped != nullptr ? shipped->rotation_deg : std::vector<double>{0.0};
}

studies::PhotometryRequest request_of(const CommandLine& line, studies::TestProgramme programme,
                                      const std::filesystem::path& limits, const std::filesystem::path& dye) {
  const PhotometryOptions& options = line.photometry;
  studies::PhotometryRequest request;
  request.programme = std::move(programme);
  request.limits_source = studies::find_standard(options.standard) != nullptr ? options.standard : limits.string();
  request.area_cm2 = *options.area_cm2;
  request.rotation_deg = rotations_of(options);
  request.apertures = apertures_of(options);
  request.window_deg = options.window_deg;
  if (options.light != "a" && options.light != "design")
    throw InputError({"", 0, "--light"}, fmt::format("must be a or design, got {}", in_quotes(options.light)));
  request.own_light = options.light == "design";
  if (!dye.empty()) {
    request.dye = options.dye.value_or(request.programme.colour);
    request.dye_absorption_per_mm = materials::read_spectral_absorption(dye);
  }
  request.diffraction = !options.no_diffraction;
  request.advice = !options.no_advice;
  request.engine = studies::engine_from_name(options.engine);
  if (options.cutoff && !(*options.cutoff > 0.0 && *options.cutoff < 1.0))
    throw InputError({"", 0, "--cutoff"}, fmt::format("must lie between 0 and 1, got {}", *options.cutoff));
  request.cutoff = options.cutoff;
  request.rays = options.samples;
  request.seed = line.common.seed;
  request.pictures = !line.common.out.empty();
  return request;
}

std::vector<OutputFile> files_of(const studies::PhotometryResult& result, const std::string& json) {
  const report::PolarPlot field = report::far_field_plot(result);
  const report::LinePlot curves = report::observation_plot(result);
  return {{"photometry.json", json},
          {"photometry.csv", studies::photometry_csv(result)},
          {"far_field.csv", studies::far_field_map_csv(result)},
          {"far_field.svg", report::render_svg(field)},
          {"far_field.png", report::render_png(field)},
          {"r_a.svg", report::render_svg(curves)},
          {"r_a.png", report::render_png(curves)}};
}

}  // namespace

ExitCode run_photometry_command(const CommandLine& line) {
  const PhotometryOptions& options = line.photometry;
  const studies::Design design = studies::read_design(options.design, line.common.overrides);
  const std::filesystem::path limits = limits_file(options);
  studies::TestProgramme programme = programme_of(options, limits);
  const std::filesystem::path dye = dye_file(options, design, programme);
  std::vector<std::string> inputs = files_read({design});
  inputs.push_back(limits.string());
  if (!dye.empty()) inputs.push_back(dye.string());
  const studies::PhotometryStudy study(design, request_of(line, std::move(programme), limits, dye));
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common,
                  {inputs,
                   "photometry.json",
                   {"photometry.csv", "far_field.csv", "far_field.svg", "far_field.png", "r_a.svg", "r_a.png"}});
  studies::PhotometryResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    raytrace::run_with_threads(line.common.threads.value_or(0),
                               [&] { result = study.run(&bar, &interrupt.cancellation()); });
  }
  const std::string json = studies::photometry_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = files_of(result, json);
  write_outputs(line.common, json, files, studies::photometry_table(result));
  print_warnings(line.common, result.warnings);
  if (!result.complete) {
    say("retrace: interrupted; what is finished is in the result");
    return ExitCode::interrupted;
  }
  return result.verdict == studies::Verdict::fail ? ExitCode::answer_is_no : ExitCode::done;
}

}  // namespace retrace::app
