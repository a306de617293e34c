#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "core/atomic_file.h"
#include "core/number_format.h"
#include "core/pictures.h"
#include "core/task_progress.h"
#include "design/io/design_reader.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "requests/number_list.h"
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
  std::vector<std::string> designs;
  bool detector = false;
  bool camera = false;
  bool road = false;
  bool false_colour = false;
  FieldTexts fields;
};

std::vector<Argument> arguments(ImageOptions& options) {
  std::vector<Argument> all = {
      {"DESIGN", "design files (several only with --camera); - is standard input", &options.designs, files(".toml")},
      {"--detector", "maps of the returned light, by position on the entrance face and by direction",
       &options.detector},
      {"--camera", "the part in the light of a lamp, as a camera sees it", &options.camera},
      {"--road", "reflectors on a car ahead or a sign at night, as seen by a driver", &options.road},
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

/// Writes previews of the unfinished camera picture to the output folder. The time between two previews is at least
/// kPreview.
class Preview {
 public:
  explicit Preview(const CommonOptions& common) : out_(common.out) {}

  void operator()(const studies::CameraResult& result) {
    const auto now = std::chrono::steady_clock::now();
    if (out_.empty() || now - last_ < kPreview) return;
    last_ = now;
    write_file_atomically(std::filesystem::path(out_) / kCameraPng, report::camera_png(result));
  }

 private:
  std::string out_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Returns all files that a picture of a camera or a road reads.
template <class Request>
std::vector<std::string> files_of(const std::vector<design::Design>& designs, const Request& request) {
  std::vector<std::string> files = files_read(designs);
  if (!request.lamp.empty()) files.push_back(request.lamp.string());
  if constexpr (requires { request.background; })
    if (!request.background.empty()) files.push_back(request.background.string());
  if (const auto dye = studies::dye_file_of(request.dye, false, {}); !dye.empty()) files.push_back(dye.string());
  return files;
}

/// Computes the camera picture and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode photograph(const ImageOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  design::Design design = design::read_design(options.designs.front(), common.overrides);
  studies::CameraResult result;
  const auto request = request_of<CameraRequest>(options.fields, common);
  const std::vector<std::string> inputs = files_of({design}, request);
  ResultFiles files(common, inputs, "image.json");
  const auto add = [&](const std::string& name, auto content) {
    files.add(name, [&result, content] { return result.image.passes > 0 ? content(result) : ""; });
  };
  add("camera.exr", [](const auto& r) { return report::exr_file(report::luminance_picture(r)); });
  add(kCameraPng, [](const auto& r) { return report::camera_png(r); });
  if (options.false_colour)
    add("false_colour.png", [](const auto& r) { return report::render_png(report::false_colour_plot(r)); });
  const studies::CameraStudy study(std::move(design), request);
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  Preview preview(common);
  interrupt.run(common, {"rendering", what_shortens(request)}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(
        bar, cancel, [&](const studies::CameraResult& unfinished) { preview(unfinished); },
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
        const auto study =
            std::make_shared<const studies::CameraStudy>(design::read_design(options.designs.front(), common.overrides),
                                                         request_of<CameraRequest>(options.fields, common));
        return [study, trace = study->passes()](std::uint64_t pass, const Cancellation* cancel) {
          return trace(pass, cancel);
        };
      });
}

/// Fields of a camera picture that may be lists. A list gives a sequence of pictures.
constexpr std::array<std::string_view, 5> kSequenceFields = {"distance_m", "observation_deg", "v_deg", "h_deg",
                                                             "rotation_deg"};
constexpr std::size_t kMaxPictures = 64;

/// Returns the fields of each picture of a sequence. If no field is a list, there is one picture.
std::vector<FieldTexts> sequence_of(const FieldTexts& fields) {
  std::vector<FieldTexts> sequence;
  std::string listed;
  for (const std::string_view name : kSequenceFields) {
    const std::string option = requests::option_of(*requests::row_of(requests::description<CameraRequest>(), name));
    const auto found = fields.values.find(option);
    if (found == fields.values.end() || !found->second) continue;
    if (found->second->find_first_of(",:") == std::string::npos) continue;
    const std::vector<double> values = requests::read_number_list(*found->second, Field{name});
    if (!listed.empty())
      throw InputError(Field{name}, fmt::format("only one option may be a list, and {} is one already", listed));
    if (values.size() > kMaxPictures)
      throw InputError(Field{name}, fmt::format("must be 1 to {} values, got {}", kMaxPictures, values.size()));
    listed = option;
    for (const double value : values) {
      FieldTexts one = fields;
      one.values[option] = shortest(value);
      sequence.push_back(std::move(one));
    }
  }
  if (sequence.empty()) sequence.push_back(fields);
  return sequence;
}

/// Computes several camera pictures, one for each design or for each value of a list, and displays them with the same
/// exposure.
ExitCode run_series(const ImageOptions& options, const CommonOptions& common, const std::vector<FieldTexts>& sequence) {
  if (sequence.size() > 1 && options.designs.size() > 1)
    throw InputError("image: a list of values is possible only for one design");
  if (options.false_colour) throw InputError("image: --false-colour is possible only for one picture");
  std::vector<design::Design> designs;
  for (const std::string& file : options.designs) designs.push_back(design::read_design(file, common.overrides));
  const auto request = request_of<CameraRequest>(sequence.front(), common);
  const bool is_sequence = sequence.size() > 1;
  const std::size_t count = std::max(sequence.size(), designs.size());
  std::vector<std::unique_ptr<const studies::CameraStudy>> studies;
  std::vector<studies::CameraResult> results;
  std::optional<report::ToneCurve> curve;
  ResultFiles files(common, files_of(designs, request), "image.json");
  const auto tone = [&results, &curve] {
    if (!curve) curve = report::camera_tone(results);
    return *curve;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const std::string name = fmt::format("camera_{:02}", k + 1);
    files.add(name + ".exr", [&results, k] {
      return k < results.size() ? report::exr_file(report::luminance_picture(results[k])) : "";
    });
    files.add(name + ".png",
              [&results, k, tone] { return k < results.size() ? report::camera_png(results[k], tone()) : ""; });
    studies.push_back(std::make_unique<const studies::CameraStudy>(
        designs[is_sequence ? 0 : k], request_of<CameraRequest>(sequence[is_sequence ? k : 0], common)));
  }
  files.add(is_sequence ? "sheet.png" : kCameraPng,
            [&results, tone] { return results.empty() ? "" : report::camera_sheet_png(results, tone()); });
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  interrupt.run(common, {"rendering", what_shortens(request)}, [&](Progress* bar, const Cancellation* cancel) {
    for (std::size_t k = 0; k < count && !is_cancelled(cancel); ++k) {
      PartProgress part(bar, static_cast<double>(k) / static_cast<double>(count),
                        static_cast<double>(k + 1) / static_cast<double>(count));
      studies::CameraResult result = studies[k]->run(&part, cancel);
      if (result.image.passes > 0) results.push_back(std::move(result));
    }
  });
  Warnings warnings;
  for (const studies::CameraResult& result : results)
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
  const bool is_complete =
      results.size() == count && std::ranges::all_of(results, [](const auto& result) { return result.complete; });
  return files.write(studies::camera_series_json(results, warnings, is_complete), studies::camera_series_table(results),
                     warnings, {.complete = is_complete});
}

ExitCode run_road(const ImageOptions& options, const CommonOptions& common, design::Design design) {
  const auto request = request_of<RoadRequest>(options.fields, common);
  const std::vector<std::string> inputs = files_of({design}, request);
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
  for (std::size_t k = 0; request.distance_m.size() > 1 && k < request.distance_m.size(); ++k)
    files.add(fmt::format("road_{:02}.png", k + 1),
              [&result, k] { return k < result.views.size() ? report::road_view_png(result, k) : ""; });
  files.prepare();
  interrupt.run(common, {"tracing", {"give fewer distances (--road-distance-m)"}},
                [&](Progress* bar, const Cancellation* cancel) { result = study.run(bar, cancel); });
  return files.write(studies::road_json(result), studies::road_table(result), result.warnings,
                     {.complete = result.complete});
}

ExitCode run(const ImageOptions& options, const CommonOptions& common) {
  if (static_cast<int>(options.detector) + static_cast<int>(options.camera) + static_cast<int>(options.road) != 1)
    throw InputError("image: one of --detector, --camera and --road is required; see retrace image --help");
  if (options.designs.size() > 1 && !options.camera)
    throw InputError("image: several designs are possible only with --camera");
  if (std::ranges::count(options.designs, "-") > 1) throw InputError("standard input (-) can be given only one time");
  if (options.camera) {
    const std::vector<FieldTexts> sequence = sequence_of(options.fields);
    return sequence.size() > 1 || options.designs.size() > 1 ? run_series(options, common, sequence)
                                                             : run_camera(options, common);
  }
  design::Design design = design::read_design(options.designs.front(), common.overrides);
  return options.detector ? run_detector(options, common, std::move(design))
                          : run_road(options, common, std::move(design));
}

}  // namespace

Command image_command() {
  return {
      .name = "image",
      .summary = "pictures of a detector or a camera",
      .manual =
          "Computes pictures: maps of a detector on the entrance face, the part as a camera sees it in the light "
          "of a lamp, or such reflectors on a car ahead or a sign at night. One of `--detector`, `--camera` and "
          "`--road` "
          "selects the kind of picture. Pictures need `--out`; OpenEXR files contain the numbers. `--camera` accepts "
          "several designs, which are shown next to each other with the same exposure. Alternatively, one of the "
          "angles or the distance can be a list, which gives a sequence of pictures.",
      .reads = {"retrace.design/1", "absorption of a dye (CSV)", "lamps (IES LM-63, EULUMDAT)"},
      .writes = {"retrace.image/1"},
      .begin = begins<ImageOptions>(arguments, run)};
}

}  // namespace retrace::app
