#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/number_list.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/shared_arguments.h"
#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/pictures.h"
#include "core/text.h"
#include "materials/io/spectrum_reader.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "studies/design/io/design_reader.h"
#include "studies/design/request_limits.h"
#include "studies/image/io/image_documents.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace::app {
namespace {

// Minimum time between two previews of an unfinished camera picture.
constexpr std::chrono::seconds kPreview{10};
// Number of passes that each MPI rank computes at a time. A pass traces four light paths per pixel and uses all threads
// of the rank.
constexpr std::size_t kPassesAtATime = 1;
// Name of the camera picture. Previews are written to the same file.
constexpr const char* kCameraPng = "camera.png";

/// Options of `retrace image`. Exactly one of `detector`, `camera` and `road` must be true.
struct ImageOptions {
  std::string design;
  bool detector = false;
  bool camera = false;
  bool road = false;

  // Requests for each kind of picture. Many options write their value directly into a member of one of these requests.
  studies::DetectorRequest detected;
  studies::CameraRequest photographed;
  studies::RoadRequest driven;

  std::string engine = "auto";
  std::optional<std::string> eye_mm;
  std::optional<std::string> lamp_mm;
  std::optional<std::string> film_mm;
  bool false_colour = false;
  std::string road_distance_m = "10,30,100";
  std::optional<std::string> lamp;
  double lamp_aim_deg = 0.0;
  std::string dye = "none";
  std::optional<std::string> pixels;
};

constexpr std::uint64_t kMostWhole = std::numeric_limits<std::uint32_t>::max();

std::vector<Argument> detector_arguments(ImageOptions& o) {
  Traits samples = whole(1, studies::kMaxRaysOfPoint);
  samples.needs = {engine_need(studies::kRayEnginesOfParts)};
  return {{"--detector", "maps of the returned light, by position on the entrance face and by direction", &o.detector},
          {"--incidence T", "detector: angle of incidence in degrees", &o.detected.incidence_deg},
          {"--azimuth P", "detector: azimuth of the source in degrees", &o.detected.azimuth_deg},
          engine_argument(o.engine, "detector: exact, montecarlo (embree), or auto: exact where it is possible"),
          {"--cutoff W",
           "detector, exact: minimum power of a beam, as a fraction of the incident power [truncates at most 1e-5]",
           &o.detected.cutoff,
           {.needs = {engine_need(studies::kExactEngines)}}},
          {"--samples N", fmt::format("detector: number of Monte Carlo rays [{}]", studies::kUsualDetectorRays),
           &o.detected.rays, samples},
          {"--window-deg W", "detector: half width of the angular map", &o.detected.window_deg},
          {"--angle-pixels N", "detector: pixels along a side of the angular map", &o.detected.angle_pixels,
           whole(0, kMostWhole)}};
}

std::vector<Argument> camera_arguments(ImageOptions& o) {
  Need eye_or_lamp = absent("--eye-mm");
  eye_or_lamp.push_back(absent("--lamp-mm").front());
  Traits passes = whole(0, kMostWhole);
  passes.needs = {absent("--noise")};
  return {
      {"--camera", "the part in the light of a lamp, as a camera sees it", &o.camera},
      {"--distance-m D",
       "camera: distance of the lamp and the eye from the part",
       &o.photographed.distance_m,
       {.needs = {eye_or_lamp}}},
      {"--observation-deg A",
       "camera: observation angle in degrees; the eye is above the lamp",
       &o.photographed.observation_deg,
       {.needs = {absent("--eye-mm")}}},
      {"--v-deg V", "camera: vertical angle of the lamp", &o.photographed.v_deg},
      {"--h-deg H", "camera: horizontal angle of the lamp", &o.photographed.h_deg},
      {"--rotation-deg E", "camera: rotation of the part about its normal", &o.photographed.rotation_deg},
      {"--eye-mm X,Y,Z", "camera: position of the eye [from distance and angles]", &o.eye_mm},
      {"--lamp-mm X,Y,Z", "camera: position of the lamp [from distance and angles]", &o.lamp_mm},
      {"--lamp-arcmin D", "camera: angular diameter of the lamp", &o.photographed.lamp_arcmin},
      {"--pupil-arcmin D", "camera: angular diameter of the eye's pupil", &o.photographed.pupil_arcmin},
      {"--illuminance-lx E",
       "camera: illuminance by the lamp at the part, on a plane normal to the light",
       &o.photographed.illuminance_lx,
       {.needs = {absent("--lamp")}}},
      {"--ambient-lx E", "camera: illuminance of the face by uniform light from the front", &o.photographed.ambient_lx},
      {"--backlight-lx E", "camera: uniform light from behind and around the part", &o.photographed.backlight_lx},
      {"--field-mm W", "camera: width of the picture, measured at the part [the part and a margin]",
       &o.photographed.field_mm},
      {"--film-mm WxH",
       fmt::format("camera: width and height of the sheet that shows an infinite design [{}x{}]",
                   studies::kUsualFilmMm[0], studies::kUsualFilmMm[1]),
       &o.film_mm},
      {"--cylinder-mm R", "camera: radius of the cylinder around which the sheet is bent; negative: inside it [plane]",
       &o.photographed.cylinder_mm},
      {"--noise E", "camera: relative noise of pixels to reach", &o.photographed.noise},
      {"--passes N", "camera: number of passes of four light paths per pixel, instead of --noise",
       &o.photographed.passes, passes},
      {"--false-colour",
       "camera: also write the luminance in false colours",
       &o.false_colour,
       {.needs = {any_given({"--out"})}}}};
}

std::vector<Argument> road_arguments(ImageOptions& o) {
  return {{"--road", "two of the reflectors on a car ahead at night, as seen by a driver", &o.road},
          {"--road-distance-m LIST", "road: distances of the car ahead", &o.road_distance_m},
          {"--lamp-cd I",
           "road: intensity of each headlamp towards the reflectors",
           &o.driven.lamp_cd,
           {.needs = {absent("--lamp")}}},
          {"--lamp-height-m H", "road: height of the centres of the headlamps", &o.driven.lamp_height_m},
          dye_argument(o.dye, "road: none, red, amber (illustrative) or a file")};
}

std::vector<Argument> arguments(ImageOptions& options) {
  Traits lamp_file = files("");
  lamp_file.needs = {any_given({"--camera", "--road"})};
  std::vector<Argument> all = {
      design_argument(options.design),
      {"--pixels N|CxR",
       "detector: pixels along the longer side of the face [400]; camera: columns and rows [400x300]",
       &options.pixels,
       {.needs = {any_given({"--detector", "--camera"})}}},
      {"--lamp FILE",
       "camera, road: IES or EULUMDAT file (.ies, .ldt) of the lamp or headlamps [uses --illuminance-lx, --lamp-cd]",
       &options.lamp, lamp_file},
      {"--lamp-aim-deg D",
       "camera, road: downward tilt of the axis of a lamp from --lamp, in degrees",
       &options.lamp_aim_deg,
       {.needs = {any_given({"--lamp"})}}}};
  for (std::vector<Argument> some : {detector_arguments(options), camera_arguments(options), road_arguments(options)}) {
    // The first option of each list (--detector, --camera, --road) selects the kind of picture. All other options of
    // the list require it.
    for (std::size_t k = 1; k < some.size(); ++k) {
      std::vector<Need>& needs = some[k].traits.needs;
      needs.insert(needs.begin(), any_given({some.front().name}));
    }
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Parses a list of numbers.
/// \param count number of elements that the list must have
/// \param form description of the expected text, for messages
/// \throw InputError with the name of the option if `text` is not a list of `count` numbers
std::vector<double> numbers_of(const std::string& text, char separator, std::size_t count, const std::string& option,
                               const std::string& form) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, separator)) numbers.push_back(number_in(part).value_or(NAN));
  if (numbers.size() != count || std::any_of(numbers.begin(), numbers.end(), [](double n) { return std::isnan(n); }))
    throw InputError({"", 0, option}, fmt::format("must be {}, got {}", form, in_quotes(text)));
  return numbers;
}

/// Parses `count` pixel counts that are separated by "x", such as 400x300.
/// \param form description of the expected text, for messages
/// \throw InputError if a pixel count is not a non-negative integer
std::vector<std::size_t> pixels_of(const std::string& text, std::size_t count, const std::string& form) {
  std::vector<std::size_t> pixels;
  for (const double n : numbers_of(text, 'x', count, "--pixels", form)) {
    if (!(n >= 0.0 && n < 1e15) || n != std::floor(n))
      throw InputError({"", 0, "--pixels"}, fmt::format("must be {}, got {}", form, in_quotes(text)));
    pixels.push_back(static_cast<std::size_t>(n));
  }
  return pixels;
}

std::array<double, 3> place_of(const std::string& text, const std::string& option) {
  const std::vector<double> n = numbers_of(text, ',', 3, option, "three numbers X,Y,Z in mm");
  return {n[0], n[1], n[2]};
}

studies::DetectorRequest detector_request(const ImageOptions& options, const CommonOptions& common) {
  studies::DetectorRequest request = options.detected;
  if (options.pixels) request.pixels = pixels_of(*options.pixels, 1, "a whole number")[0];
  request.engine = studies::engine_from_name(options.engine);
  request.seed = common.seed;
  return request;
}

std::optional<studies::PhotometricLamp> lamp_of(const ImageOptions& options) {
  if (!options.lamp) return std::nullopt;
  return studies::read_lamp(*options.lamp, "--lamp");
}

studies::CameraRequest camera_request(const ImageOptions& options, const CommonOptions& common) {
  studies::CameraRequest request = options.photographed;
  if (options.eye_mm) request.eye_mm = place_of(*options.eye_mm, "--eye-mm");
  if (options.lamp_mm) request.lamp_mm = place_of(*options.lamp_mm, "--lamp-mm");
  if (options.pixels) {
    const auto n = pixels_of(*options.pixels, 2, "columns and rows, such as 400x300");
    request.columns = n[0];
    request.rows = n[1];
  }
  if (options.film_mm) {
    const auto film = numbers_of(*options.film_mm, 'x', 2, "--film-mm", "width and height, such as 100x100");
    request.film_mm = {film[0], film[1]};
  }
  request.lamp = lamp_of(options);
  request.lamp_aim_deg = options.lamp_aim_deg;
  request.seed = common.seed;
  return request;
}

/// Checks that pictures can be written, before any of them is computed. Call this function after cheaper checks,
/// because loading the library that writes pictures takes half a second.
void check_can_draw(const CommonOptions& common) {
  if (!common.out.empty()) picture_files();
}

/// Returns advice for a shorter run with --detector: options to change, with their current values.
Words what_shortens_detector(const ImageOptions& options) {
  const bool may_be_exact = options.engine == "exact" || options.engine == "auto";
  Words advice;
  if (options.engine != "exact")
    advice.push_back(
        fmt::format("give a smaller --samples (now {})", options.detected.rays.value_or(studies::kUsualDetectorRays)));
  if (may_be_exact) advice.emplace_back("give a larger --cutoff");
  return advice;
}

/// Returns advice for a shorter run with --camera: options to change, with their current values.
Words what_shortens_camera(const ImageOptions& options) {
  const studies::CameraRequest& request = options.photographed;
  return {request.passes ? fmt::format("give fewer --passes (now {})", *request.passes)
                         : fmt::format("give a larger --noise (now {})", shortest(request.noise)),
          "give fewer --pixels"};
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
  interrupt.run(common, {"tracing", what_shortens_detector(options)},
                [&](Progress* bar, const Cancellation* cancel) { result = study.run(bar, cancel); });
  return files.write(studies::detector_json(result), studies::detector_table(result), result.warnings,
                     {.complete = result.complete});
}

std::string camera_png(const raytrace::CameraImage& image) {
  return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
}

/// Writes a preview of the unfinished camera picture to the output folder, at most one time in each period of length
/// kPreview.
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

/// Computes the camera picture and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode photograph(const ImageOptions& options, const CommonOptions& common, studies::MpiSession* session) {
  studies::Design design = studies::read_design(options.design, common.overrides);
  studies::CameraResult result;
  std::vector<std::string> inputs = files_read({design});
  if (options.lamp) inputs.push_back(*options.lamp);
  ResultFiles files(common, inputs, "image.json");
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
  Preview preview(common);
  interrupt.run(common, {"rendering", what_shortens_camera(options)}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(
        bar, cancel, [&](const raytrace::CameraImage& image) { preview(image); },
        share_among(session, kPassesAtATime, cancel));
  });
  for (const Warning& remark : remarks_of(session)) result.warnings.push_back(remark);
  return files.write(studies::camera_json(result), studies::camera_table(result), result.warnings,
                     {.complete = result.complete});
}

ExitCode run_camera(const ImageOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, kPassesAtATime, [&](studies::MpiSession* session) { return photograph(options, common, session); },
      [&]() -> ComputeTask {
        const auto study = std::make_shared<const studies::CameraStudy>(
            studies::read_design(options.design, common.overrides), camera_request(options, common));
        return [study, trace = study->passes()](std::uint64_t pass, const Cancellation* cancel) {
          return trace(pass, cancel);
        };
      });
}

ExitCode run_road(const ImageOptions& options, const CommonOptions& common, studies::Design design) {
  std::vector<std::string> inputs = files_read({design});
  studies::RoadRequest request = options.driven;
  request.distance_m = read_number_list(options.road_distance_m, "--road-distance-m");
  if (options.lamp) inputs.push_back(*options.lamp);
  request.lamp = lamp_of(options);
  request.lamp_aim_deg = options.lamp_aim_deg;
  const std::filesystem::path dye = studies::dye_file_of(options.dye, false, {});
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
  interrupt.run(common, {"tracing", {"give fewer distances (--road-distance-m)"}},
                [&](Progress* bar, const Cancellation* cancel) { result = study.run(bar, cancel); });
  return files.write(studies::road_json(result), studies::road_table(result), result.warnings,
                     {.complete = result.complete});
}

ExitCode run(const ImageOptions& options, const CommonOptions& common) {
  if (static_cast<int>(options.detector) + static_cast<int>(options.camera) + static_cast<int>(options.road) != 1)
    throw InputError("image: one of --detector, --camera and --road is required; see retrace image --help");
  if (options.camera) return run_camera(options, common);
  studies::Design design = studies::read_design(options.design, common.overrides);
  return options.detector ? run_detector(options, common, std::move(design))
                          : run_road(options, common, std::move(design));
}

}  // namespace

Command image_command() {
  return {.name = "image",
          .summary = "pictures: what a detector or a camera sees",
          .manual =
              "Pictures: maps of a detector on the entrance face, the part as a camera sees it in the light of a "
              "lamp, or two such reflectors on a car ahead at night; one of `--detector`, `--camera` and `--road` "
              "says which. Pictures need `--out`; OpenEXR files have the numbers.",
          .reads = {"retrace.design/1", "absorption of a dye (CSV)", "lamps (IES LM-63, EULUMDAT)"},
          .writes = {"retrace.image/1"},
          .begin = begins<ImageOptions>(arguments, run)};
}

}  // namespace retrace::app
