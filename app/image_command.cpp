#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/message_text.h"
#include "materials/io/spectrum_reader.h"
#include "report/picture_plot.h"
#include "report/road_plot.h"
#include "studies/design/design_reader.h"
#include "studies/image/io/image_documents.h"

namespace retrace::app {
namespace {

// Between two previews of a camera picture that takes long.
constexpr std::chrono::seconds kPreview{10};

/// Numbers with `separator` between. \throw InputError naming the option if there are not `count` of them
template <class Number>
std::vector<Number> numbers_of(std::string_view text, char separator, std::size_t count, const std::string& option,
                               const std::string& form) {
  std::vector<Number> numbers;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (true) {
    Number value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{}) break;
    numbers.push_back(value);
    if (next == end) {
      at = end;
      break;
    }
    if (*next != separator) break;
    at = next + 1;
  }
  const bool finite =
      std::all_of(numbers.begin(), numbers.end(), [](Number n) { return std::isfinite(static_cast<double>(n)); });
  if (at != end || numbers.size() != count || !finite)
    throw InputError({"", 0, option}, fmt::format("must be {}, got {}", form, in_quotes(text)));
  return numbers;
}

std::array<double, 3> place_of(const std::string& text, const std::string& option) {
  const auto n = numbers_of<double>(text, ',', 3, option, "three numbers X,Y,Z in mm");
  return {n[0], n[1], n[2]};
}

studies::DetectorRequest detector_request(const CommandLine& line) {
  const ImageOptions& options = line.image;
  studies::DetectorRequest request;
  request.incidence_deg = options.incidence_deg;
  request.azimuth_deg = options.azimuth_deg;
  if (options.pixels)
    request.pixels = numbers_of<std::size_t>(*options.pixels, 'x', 1, "--pixels", "a whole number")[0];
  request.angle_pixels = options.angle_pixels;
  request.window_deg = options.window_deg;
  request.engine = studies::engine_from_name(options.engine);
  if (options.cutoff && !(*options.cutoff > 0.0 && *options.cutoff < 1.0))
    throw InputError({"", 0, "--cutoff"}, fmt::format("must lie between 0 and 1, got {}", *options.cutoff));
  request.cutoff = options.cutoff;
  if (options.samples < 1) throw InputError({"", 0, "--samples"}, "must be at least 1, got 0");
  request.rays = options.samples;
  request.seed = line.common.seed;
  return request;
}

studies::CameraRequest camera_request(const CommandLine& line) {
  const ImageOptions& options = line.image;
  studies::CameraRequest request;
  request.distance_m = options.distance_m;
  request.observation_deg = options.observation_deg;
  request.v_deg = options.v_deg;
  request.h_deg = options.h_deg;
  request.rotation_deg = options.rotation_deg;
  if (options.eye_mm) request.eye_mm = place_of(*options.eye_mm, "--eye-mm");
  if (options.lamp_mm) request.lamp_mm = place_of(*options.lamp_mm, "--lamp-mm");
  request.lamp_arcmin = options.lamp_arcmin;
  request.pupil_arcmin = options.pupil_arcmin;
  request.illuminance_lx = options.illuminance_lx;
  request.ambient_lx = options.ambient_lx;
  request.backlight_lx = options.backlight_lx;
  if (options.pixels) {
    const auto n = numbers_of<std::size_t>(*options.pixels, 'x', 2, "--pixels", "columns and rows, such as 400x300");
    request.columns = n[0];
    request.rows = n[1];
  }
  request.field_mm = options.field_mm;
  const auto film = numbers_of<double>(options.film_mm, 'x', 2, "--film-mm", "width and height, such as 100x100");
  request.film_mm = {film[0], film[1]};
  request.cylinder_mm = options.cylinder_mm;
  request.noise = options.noise;
  request.passes = options.passes;
  request.seed = line.common.seed;
  return request;
}

ExitCode exit_code_of(bool complete) {
  if (complete) return ExitCode::done;
  say("retrace: interrupted; what is finished is in the result");
  return ExitCode::interrupted;
}

/// Before any work is done for pictures that could not be written; after what is cheaper to check, as what writes them
/// takes half a second to load.
void check_can_write(const CommandLine& line) {
  if (!line.common.out.empty() && !report::can_write_pictures())
    throw InputError("this program was built without OpenImageIO, which writes pictures");
}

ExitCode run_detector(const CommandLine& line, studies::Design design) {
  const std::vector<std::string> inputs = files_read({design});
  const studies::DetectorStudy study(std::move(design), detector_request(line));
  check_can_write(line);
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common,
                  {inputs, "image.json", {"irradiance.exr", "irradiance.png", "angular.exr", "angular.png"}});
  studies::DetectorResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  const std::string json = studies::detector_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files.push_back({"image.json", json});
  if (!line.common.out.empty() && result.complete) {
    files.push_back({"irradiance.exr", report::exr_file(report::irradiance_picture(result))});
    files.push_back({"irradiance.png", report::render_png(report::irradiance_plot(result))});
    files.push_back({"angular.exr", report::exr_file(report::angular_picture(result))});
    files.push_back({"angular.png", report::render_png(report::angular_plot(result))});
  }
  write_outputs(line.common, json, files, studies::detector_table(result));
  print_warnings(line.common, result.warnings);
  return exit_code_of(result.complete);
}

std::string camera_png(const raytrace::CameraImage& image) {
  return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
}

/// Writes the picture as it is, now and then.
class Preview {
 public:
  explicit Preview(const CommandLine& line) : out_(line.common.out) {}

  void operator()(const raytrace::CameraImage& image) {
    const auto now = std::chrono::steady_clock::now();
    if (out_.empty() || now - last_ < kPreview) return;
    last_ = now;
    write_file_atomically(std::filesystem::path(out_) / "camera.png", camera_png(image));
  }

 private:
  std::string out_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

ExitCode run_camera(const CommandLine& line, studies::Design design) {
  const std::vector<std::string> inputs = files_read({design});
  const studies::CameraStudy study(std::move(design), camera_request(line));
  check_can_write(line);
  const OrderlyInterrupt interrupt;
  std::vector<std::string> names = {"camera.exr", "camera.png"};
  if (line.image.false_colour) names.emplace_back("false_colour.png");
  prepare_outputs(line.common, {inputs, "image.json", names});
  studies::CameraResult result;
  {
    ProgressBar bar("rendering", !line.common.quiet);
    Preview preview(line);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) {
      result = study.run(&bar, cancel, [&](const raytrace::CameraImage& image) { preview(image); });
    });
  }
  const std::string json = studies::camera_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files.push_back({"image.json", json});
  if (!line.common.out.empty() && result.image.passes > 0) {
    files.push_back({"camera.exr", report::exr_file(report::luminance_picture(result))});
    files.push_back({"camera.png", camera_png(result.image)});
    if (line.image.false_colour)
      files.push_back({"false_colour.png", report::render_png(report::false_colour_plot(result))});
  }
  write_outputs(line.common, json, files, studies::camera_table(result));
  print_warnings(line.common, result.warnings);
  return exit_code_of(result.complete);
}

/// The dye's file; empty for none.
std::filesystem::path dye_file(const std::string& name) {
  if (name == "none") return {};
  if (name == "red" || name == "amber") return data_directory() / ("dye_" + name + ".csv");
  if (!std::filesystem::exists(name))
    throw InputError({"", 0, "--dye"},
                     fmt::format("must be none, red, amber or a file that exists, got {}", in_quotes(name)));
  return name;
}

ExitCode run_road(const CommandLine& line, studies::Design design) {
  std::vector<std::string> inputs = files_read({design});
  studies::RoadRequest request;
  request.distance_m = read_number_list(line.image.road_distance_m, "--road-distance-m");
  request.lamp_cd = line.image.lamp_cd;
  const std::filesystem::path dye = dye_file(line.image.dye);
  if (!dye.empty()) {
    request.dye = line.image.dye;
    request.dye_absorption_per_mm = materials::read_spectral_absorption(dye);
    inputs.push_back(dye.string());
  }
  const studies::RoadStudy study(std::move(design), std::move(request), line.common.seed);
  check_can_write(line);
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {inputs, "image.json", {"road.png", "road.exr"}});
  studies::RoadResult result;
  {
    ProgressBar bar("tracing", !line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  const std::string json = studies::road_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files.push_back({"image.json", json});
  if (!line.common.out.empty() && !result.views.empty()) {
    files.push_back({"road.png", report::road_png(result)});
    files.push_back({"road.exr", report::exr_file(report::road_picture(result))});
  }
  write_outputs(line.common, json, files, studies::road_table(result));
  print_warnings(line.common, result.warnings);
  return exit_code_of(result.complete);
}

}  // namespace

ExitCode run_image_command(const CommandLine& line) {
  const ImageOptions& asked = line.image;
  if (static_cast<int>(asked.detector) + static_cast<int>(asked.camera) + static_cast<int>(asked.road) != 1)
    throw InputError("image: one of --detector, --camera and --road is required; see retrace image --help");
  studies::Design design = studies::read_design(line.image.design, line.common.overrides);
  if (asked.road) return run_road(line, std::move(design));
  return asked.detector ? run_detector(line, std::move(design)) : run_camera(line, std::move(design));
}

}  // namespace retrace::app
