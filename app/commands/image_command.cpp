#include <fmt/format.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "core/atomic_file.h"
#include "core/number_format.h"
#include "core/pictures.h"
#include "design/io/design_reader.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/image/io/image_documents.h"
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
  bool false_colour = false;
  FieldTexts fields;
};

std::vector<Argument> arguments(ImageOptions& options) {
  std::vector<Argument> all = {
      design_argument(options.design),
      {"--detector", "maps of the returned light, by position on the entrance face and by direction",
       &options.detector},
      {"--camera", "the part in the light of a lamp, as a camera sees it", &options.camera},
      {"--road", "two of the reflectors on a car ahead at night, as seen by a driver", &options.road},
      {"--false-colour",
       "camera: also write the luminance in false colours",
       &options.false_colour,
       {.needs = {any_given({"--camera"}), any_given({"--out"})}}}};
  const std::array<CommandRequest, 3> of_command = {{{requests::description<DetectorRequest>(), "--detector"},
                                                     {requests::description<CameraRequest>(), "--camera"},
                                                     {requests::description<RoadRequest>(), "--road"}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

/// Checks that pictures can be written. The check is made before a picture is computed, but after all faster checks,
/// because it takes half a second to load the library that writes pictures.
void check_can_draw(const CommonOptions& common) {
  if (!common.out.empty()) picture_files();
}

/// Returns advice on how to shorten a run with --detector: the options to change, with their current values.
Words what_shortens(const DetectorRequest& request) {
  const bool may_be_exact = request.engine == "exact" || request.engine == "auto";
  Words advice;
  if (request.engine != "exact")
    advice.push_back(
        fmt::format("give a smaller --samples (now {})", request.samples.value_or(studies::kDefaultDetectorRays)));
  if (may_be_exact) advice.emplace_back("give a larger --cutoff");
  return advice;
}

/// Returns advice on how to shorten a run with --camera: the options to change, with their current values.
Words what_shortens(const CameraRequest& request) {
  return {request.passes ? fmt::format("give fewer --passes (now {})", *request.passes)
                         : fmt::format("give a larger --noise (now {})", shortest(request.noise)),
          "give fewer --pixels"};
}

ExitCode run_detector(const ImageOptions& options, const CommonOptions& common, design::Design design) {
  studies::DetectorResult result;
  ResultFiles files(common, files_read({design}), "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.complete ? content(result) : ""; });
  };
  add("irradiance.exr", [](const auto& r) { return report::exr_file(report::irradiance_picture(r)); });
  add("irradiance.png", [](const auto& r) { return report::render_png(report::irradiance_plot(r)); });
  add("angular.exr", [](const auto& r) { return report::exr_file(report::angular_picture(r)); });
  add("angular.png", [](const auto& r) { return report::render_png(report::angular_plot(r)); });
  const auto request = request_of<DetectorRequest>(options.fields, common);
  const studies::DetectorStudy study(std::move(design), request);
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  interrupt.run(common, {"tracing", what_shortens(request)},
                [&](Progress* bar, const Cancellation* cancel) { result = study.run(bar, cancel); });
  return files.write(studies::detector_json(result), studies::detector_table(result), result.warnings,
                     {.complete = result.complete});
}

std::string camera_png(const raytrace::CameraImage& image) {
  return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
}

/// Writes previews of the unfinished camera picture to the output folder. The time between two previews is at least
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
ExitCode photograph(const ImageOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  design::Design design = design::read_design(options.design, common.overrides);
  studies::CameraResult result;
  std::vector<std::string> inputs = files_read({design});
  const auto request = request_of<CameraRequest>(options.fields, common);
  if (!request.lamp.empty()) inputs.push_back(request.lamp.string());
  ResultFiles files(common, inputs, "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.image.passes > 0 ? content(result) : ""; });
  };
  add("camera.exr", [](const auto& r) { return report::exr_file(report::luminance_picture(r)); });
  add(kCameraPng, [](const auto& r) { return camera_png(r.image); });
  if (options.false_colour)
    add("false_colour.png", [](const auto& r) { return report::render_png(report::false_colour_plot(r)); });
  const studies::CameraStudy study(std::move(design), request);
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  Preview preview(common);
  interrupt.run(common, {"rendering", what_shortens(request)}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(
        bar, cancel, [&](const raytrace::CameraImage& image) { preview(image); },
        distribute_among(session, kPassesAtATime, cancel));
  });
  for (const Warning& remark : remarks_of(session)) result.warnings.push_back(remark);
  return files.write(studies::camera_json(result), studies::camera_table(result), result.warnings,
                     {.complete = result.complete});
}

ExitCode run_camera(const ImageOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, kPassesAtATime, [&](compute::MpiSession* session) { return photograph(options, common, session); },
      [&]() -> ComputeTask {
        const auto study = std::make_shared<const studies::CameraStudy>(
            design::read_design(options.design, common.overrides), request_of<CameraRequest>(options.fields, common));
        return [study, trace = study->passes()](std::uint64_t pass, const Cancellation* cancel) {
          return trace(pass, cancel);
        };
      });
}

ExitCode run_road(const ImageOptions& options, const CommonOptions& common, design::Design design) {
  std::vector<std::string> inputs = files_read({design});
  const auto request = request_of<RoadRequest>(options.fields, common);
  if (!request.lamp.empty()) inputs.push_back(request.lamp.string());
  if (const auto dye = studies::dye_file_of(request.dye, false, {}); !dye.empty()) inputs.push_back(dye.string());
  const studies::RoadStudy study(std::move(design), request);
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
  design::Design design = design::read_design(options.design, common.overrides);
  return options.detector ? run_detector(options, common, std::move(design))
                          : run_road(options, common, std::move(design));
}

}  // namespace

Command image_command() {
  return {.name = "image",
          .summary = "pictures of a detector or a camera",
          .manual =
              "Computes pictures: maps of a detector on the entrance face, the part as a camera sees it in the light "
              "of a lamp, or two such reflectors on a car ahead at night. One of `--detector`, `--camera` and `--road` "
              "selects the kind of picture. Pictures need `--out`; OpenEXR files contain the numbers.",
          .reads = {"retrace.design/1", "absorption of a dye (CSV)", "lamps (IES LM-63, EULUMDAT)"},
          .writes = {"retrace.image/1"},
          .begin = begins<ImageOptions>(arguments, run)};
}

}  // namespace retrace::app
