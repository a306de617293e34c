#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/image_options.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/shared_arguments.h"
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
// Written by previews too.
constexpr const char* kCameraPng = "camera.png";

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

studies::DetectorRequest detector_request(const ImageOptions& options, const CommonOptions& common) {
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
  request.seed = common.seed;
  return request;
}

studies::CameraRequest camera_request(const ImageOptions& options, const CommonOptions& common) {
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
  request.seed = common.seed;
  return request;
}

ExitCode exit_code_of(bool complete) {
  if (complete) return ExitCode::done;
  say("retrace: interrupted; what is finished is in the result");
  return ExitCode::interrupted;
}

/// Before any work is done for pictures that could not be written; after what is cheaper to check, as what writes them
/// takes half a second to load.
void check_can_draw(const CommonOptions& common) {
  if (!common.out.empty() && !report::can_write_pictures())
    throw InputError("this program was built without OpenImageIO, which writes pictures");
}

ExitCode run_detector(const ImageOptions& options, const CommonOptions& common, studies::Design design) {
  studies::DetectorResult result;
  ResultFiles files(common, files_read({design}), "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.complete ? content(result) : ""; });
  };
  add("irradiance.exr", [](const auto& r) { return report::exr_file(report::irradiance_picture(r)); });
  add("irradiance.png", [](const auto& r) { return report::render_png(report::irradiance_plot(r)); });
  add("angular.exr", [](const auto& r) { return report::exr_file(report::angular_picture(r)); });
  add("angular.png", [](const auto& r) { return report::render_png(report::angular_plot(r)); });
  const studies::DetectorStudy study(std::move(design), detector_request(options, common));
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  {
    ProgressBar bar("tracing", !common.quiet);
    interrupt.run(common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  files.write(studies::detector_json(result), studies::detector_table(result));
  print_warnings(common, result.warnings);
  return exit_code_of(result.complete);
}

std::string camera_png(const raytrace::CameraImage& image) {
  return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
}

/// Writes the picture as it is, now and then.
class Preview {
 public:
  explicit Preview(const CommonOptions& common) : out_(common.out) {}

  void operator()(const raytrace::CameraImage& image) {
    const auto now = std::chrono::steady_clock::now();
    if (out_.empty() || now - last_ < kPreview) return;
    last_ = now;
    write_file_atomically(std::filesystem::path(out_) / kCameraPng, camera_png(image));
  }

 private:
  std::string out_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

ExitCode run_camera(const ImageOptions& options, const CommonOptions& common, studies::Design design) {
  studies::CameraResult result;
  ResultFiles files(common, files_read({design}), "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.image.passes > 0 ? content(result) : ""; });
  };
  add("camera.exr", [](const auto& r) { return report::exr_file(report::luminance_picture(r)); });
  add(kCameraPng, [](const auto& r) { return camera_png(r.image); });
  if (options.false_colour)
    add("false_colour.png", [](const auto& r) { return report::render_png(report::false_colour_plot(r)); });
  const studies::CameraStudy study(std::move(design), camera_request(options, common));
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  {
    ProgressBar bar("rendering", !common.quiet);
    Preview preview(common);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      result = study.run(&bar, cancel, [&](const raytrace::CameraImage& image) { preview(image); });
    });
  }
  files.write(studies::camera_json(result), studies::camera_table(result));
  print_warnings(common, result.warnings);
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

ExitCode run_road(const ImageOptions& options, const CommonOptions& common, studies::Design design) {
  std::vector<std::string> inputs = files_read({design});
  studies::RoadRequest request;
  request.distance_m = read_number_list(options.road_distance_m, "--road-distance-m");
  request.lamp_cd = options.lamp_cd;
  const std::filesystem::path dye = dye_file(options.dye);
  if (!dye.empty()) {
    request.dye = options.dye;
    request.dye_absorption_per_mm = materials::read_spectral_absorption(dye);
    inputs.push_back(dye.string());
  }
  const studies::RoadStudy study(std::move(design), std::move(request), common.seed);
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  studies::RoadResult result;
  ResultFiles files(common, inputs, "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.views.empty() ? "" : content(result); });
  };
  add("road.png", [](const auto& r) { return report::road_png(r); });
  add("road.exr", [](const auto& r) { return report::exr_file(report::road_picture(r)); });
  files.prepare();
  {
    ProgressBar bar("tracing", !common.quiet);
    interrupt.run(common.threads, [&](const Cancellation* cancel) { result = study.run(&bar, cancel); });
  }
  files.write(studies::road_json(result), studies::road_table(result));
  print_warnings(common, result.warnings);
  return exit_code_of(result.complete);
}

ExitCode run(const ImageOptions& options, const CommonOptions& common) {
  if (static_cast<int>(options.detector) + static_cast<int>(options.camera) + static_cast<int>(options.road) != 1)
    throw InputError("image: one of --detector, --camera and --road is required; see retrace image --help");
  studies::Design design = studies::read_design(options.design, common.overrides);
  if (options.road) return run_road(options, common, std::move(design));
  return options.detector ? run_detector(options, common, std::move(design))
                          : run_camera(options, common, std::move(design));
}

}  // namespace

Command image_command() {
  return {.name = "image",
          .summary = "pictures: what a detector or a camera sees",
          .manual =
              "Pictures: maps of a detector on the entrance face, the part as a camera sees it in the light of a "
              "lamp, or two such reflectors on a car ahead at night; one of `--detector`, `--camera` and `--road` "
              "says which. Pictures need `--out`; OpenEXR files have the numbers.",
          .reads = {"retrace.design/1", "absorption of a dye (CSV)"},
          .writes = {"retrace.image/1"},
          .begin = begins<ImageOptions>(image_arguments, run)};
}

}  // namespace retrace::app
