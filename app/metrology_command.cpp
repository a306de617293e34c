#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "app/commands.h"
#include "app/output.h"
#include "report/metrology_plot.h"
#include "studies/metrology/io/metrology_files.h"
#include "studies/metrology/metrology.h"

namespace retrace::app {
namespace {

double spacing_of(std::string_view text, const std::string& whole) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || !(value > 0.0))
    throw InputError({"", 0, "--pixel-um"}, "must be one number > 0, or two for x and y as in 0.5,0.6, got " + whole);
  return value;
}

studies::MetrologyRequest request_of(const CommandLine& line) {
  const MetrologyOptions& options = line.metrology;
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "metrology reads no design");
  studies::MetrologyRequest request;
  request.file = options.file;
  if (options.pixel_um) {
    const std::string& text = *options.pixel_um;
    const std::size_t comma = text.find(',');
    request.reading.x_pixel_um = spacing_of(std::string_view(text).substr(0, comma), text);
    request.reading.y_pixel_um = comma == std::string::npos
                                     ? *request.reading.x_pixel_um
                                     : spacing_of(std::string_view(text).substr(comma + 1), text);
  }
  request.reading.height_unit = options.height_unit;
  request.reading.lateral_unit = options.lateral_unit;
  request.reading.channel = options.channel;
  request.form_degree = studies::form_degree_of(options.form);
  request.cutoff_um = options.cutoff_um;
  request.feed_mm_per_min = options.feed_mm_per_min;
  request.edge = options.edge;
  return request;
}

}  // namespace

ExitCode run_metrology_command(const CommandLine& line) {
  const studies::MetrologyResult result = studies::measure_surface(request_of(line));
  const std::vector<std::string> others = {"surface.toml", "psd.csv", "metrology.svg", "metrology.png"};
  prepare_outputs(line.common, {{line.metrology.file}, "metrology.json", others});
  const std::string json = studies::metrology_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) {
    const report::SurfacePlot plot = report::metrology_plot(result);
    files = {{"metrology.json", json},
             {"surface.toml", studies::surface_toml(result)},
             {"psd.csv", studies::spectra_csv(result)},
             {"metrology.svg", report::render_svg(plot)},
             {"metrology.png", report::render_png(plot)}};
  }
  write_outputs(line.common, json, files, studies::metrology_text(result));
  print_warnings(line.common, result.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
