#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/first_answer.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
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
#include "studies/image/camera_series.h"
#include "studies/image/io/image_documents.h"
#include "studies/photometry/io/standard_reader.h"

namespace retrace::app {
namespace {

// Minimum time between two previews of an unfinished camera picture.
constexpr std::chrono::seconds kPreview{5};
// Number of passes that each MPI rank computes at a time. A pass traces four light paths per pixel and uses all threads
// of the rank.
constexpr std::size_t kPassesAtATime = 1;
// Number of pictures of a series that each MPI rank computes at a time.
constexpr std::size_t kPicturesAtATime = 1;
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
    advice.push_back(request.samples ? fmt::format("give a smaller --samples (now {})", *request.samples)
                                     : fmt::format("give a larger --bin-error (now {})", shortest(request.bin_error)));
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
    files.add(name, [&result, content] { return result.has_maps() ? content(result) : ""; });
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

/// Reports the unfinished camera picture: prints a line about it, and writes a preview to the output folder. The time
/// between two reports is at least kPreview.
class Preview {
 public:
  Preview(const CommonOptions& common, ProgressBar& bar) : out_(common.out), bar_(bar) {}

  void operator()(const studies::CameraResult& result) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < kPreview) return;
    last_ = now;
    bar_.write_lines("so far: " + studies::camera_table(result));
    if (!out_.empty()) write_file_atomically(std::filesystem::path(out_) / kCameraPng, report::camera_png(result));
  }

 private:
  std::string out_;
  ProgressBar& bar_;
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

/// Computes a coarse picture without diffraction. Returns lines about it, or an empty text if the computation is
/// cancelled.
std::string preliminary_picture(const design::Design& design, CameraRequest request, const Cancellation* cancel) {
  request.diffraction = false;
  request.passes = 2;
  request.columns = 100;
  request.rows = 75;
  request.background.clear();
  const studies::CameraResult result = studies::CameraStudy(design, request).run(nullptr, cancel);
  return result.complete ? "preliminary, without diffraction: " + studies::camera_table(result) : std::string();
}

/// Computes the camera picture and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode photograph(const ImageOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  const design::Design design = design::read_design(options.designs.front(), common.overrides);
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
  const studies::CameraStudy study(design, request);
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  {
    ProgressBar bar({"rendering", what_shortens(request)}, common);
    Preview preview(common, bar);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      const FirstAnswer first(bar, cancel, [&](std::optional<double>, const Cancellation* stop) {
        return preliminary_picture(design, request, stop);
      });
      result = study.run(
          &bar, cancel, [&](const studies::CameraResult& unfinished) { preview(unfinished); },
          distribute_among(session, kPassesAtATime, cancel));
    });
  }
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

/// Returns the fields of each picture of a sequence. If no field is a list of several different values, there is one
/// picture.
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
    if (values.size() > studies::CameraSeries::kMaxPictures)
      throw InputError(Field{name}, fmt::format("must be 1 to {} values, got {}", studies::CameraSeries::kMaxPictures,
                                                values.size()));
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

/// Several designs, or several requests, for which `retrace image --camera` computes pictures with the same exposure.
struct SeriesInput {
  std::vector<design::Design> designs;
  std::vector<CameraRequest> requests;
};

SeriesInput series_input(const ImageOptions& options, const CommonOptions& common,
                         const std::vector<FieldTexts>& sequence) {
  SeriesInput input;
  for (const std::string& file : options.designs) input.designs.push_back(design::read_design(file, common.overrides));
  for (const FieldTexts& fields : sequence) input.requests.push_back(request_of<CameraRequest>(fields, common));
  return input;
}

/// Computes the pictures of a series and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode photograph_series(const ImageOptions& options, const CommonOptions& common,
                           const std::vector<FieldTexts>& sequence, compute::MpiSession* session) {
  const SeriesInput input = series_input(options, common, sequence);
  const CameraRequest& request = input.requests.front();
  const studies::CameraSeries series(input.designs, input.requests);
  studies::CameraSeriesResult result;
  std::optional<report::ToneCurve> curve;
  ResultFiles files(common, files_of(input.designs, request), "image.json");
  const auto tone = [&result, &curve] {
    if (!curve) curve = report::camera_tone(result.pictures);
    return *curve;
  };
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::string name = fmt::format("camera_{:02}", k + 1);
    const auto add = [&](const char* extension, auto content) {
      files.add(name + extension, [&result, k, content] {
        const auto place = std::ranges::find(result.positions, k);
        if (place == result.positions.end()) return std::string();
        return content(result.pictures[static_cast<std::size_t>(place - result.positions.begin())]);
      });
    };
    add(".exr", [](const auto& picture) { return report::exr_file(report::luminance_picture(picture)); });
    add(".png", [tone](const auto& picture) { return report::camera_png(picture, tone()); });
  }
  files.add(sequence.size() > 1 ? "sheet.png" : kCameraPng, [&result, tone] {
    return result.pictures.empty() ? "" : report::camera_sheet_png(result.pictures, tone());
  });
  check_can_draw(common);
  const OrderlyInterrupt interrupt;
  files.prepare();
  interrupt.run(common, {"rendering", what_shortens(request)}, [&](Progress* bar, const Cancellation* cancel) {
    result = series.run(bar, cancel, distribute_among(session, kPicturesAtATime, cancel));
  });
  for (const Warning& remark : remarks_of(session)) result.warnings.push_back(remark);
  return files.write(studies::camera_series_json(result.pictures, result.warnings, result.complete),
                     studies::camera_series_table(result.pictures), result.warnings, {.complete = result.complete});
}

/// Computes several camera pictures, one for each design or for each value of a list, and displays them with the same
/// exposure.
ExitCode run_series(const ImageOptions& options, const CommonOptions& common, const std::vector<FieldTexts>& sequence) {
  if (sequence.size() > 1 && options.designs.size() > 1)
    throw InputError("image: a list of values is possible only for one design");
  if (options.false_colour) throw InputError("image: --false-colour is possible only for one picture");
  return run_on_ranks(
      common, kPicturesAtATime,
      [&](compute::MpiSession* session) { return photograph_series(options, common, sequence, session); },
      [&]() -> ComputeTask {
        const SeriesInput input = series_input(options, common, sequence);
        const auto series = std::make_shared<const studies::CameraSeries>(input.designs, input.requests);
        return [series, compute = series->pictures()](std::uint64_t picture, const Cancellation* cancel) {
          return compute(picture, cancel);
        };
      });
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

/// Checks that exactly one kind of picture is requested.
void check_kind(const ImageOptions& options) {
  std::vector<std::string> given;
  for (const auto& [is_given, name] : {std::pair{options.detector, "--detector"}, std::pair{options.camera, "--camera"},
                                       std::pair{options.road, "--road"}})
    if (is_given) given.emplace_back(name);
  if (given.size() == 1) return;
  if (given.empty())
    throw InputError("image: one of --detector, --camera and --road is required; see retrace image --help");
  throw InputError(fmt::format("image: must be one kind of picture (--detector, --camera or --road), got {}",
                               fmt::join(given, " and ")));
}

ExitCode run(const ImageOptions& options, const CommonOptions& common) {
  check_kind(options);
  if (options.designs.size() > 1 && !options.camera)
    throw InputError("image: several designs are possible only with --camera");
  if (std::ranges::count(options.designs, "-") > 1) throw InputError("standard input (-) can be given only one time");
  if (options.camera) {
    const std::vector<FieldTexts> sequence = sequence_of(options.fields);
    if (sequence.size() > 1 || options.designs.size() > 1) return run_series(options, common, sequence);
    ImageOptions one = options;
    one.fields = sequence.front();
    return run_camera(one, common);
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
          "of a lamp, or reflectors of the design on a car ahead or a sign at night. One of `--detector`, `--camera` "
          "and `--road` selects the kind of picture. Pictures need `--out`; OpenEXR files contain the numbers. "
          "`--camera` accepts several designs, which are shown next to each other with the same exposure. "
          "Alternatively, one of the angles or the distance can be a list, which gives a sequence of pictures.",
      .reads = {"retrace.design/1", "absorption of a dye (CSV)", "lamps (IES LM-63, EULUMDAT)"},
      .writes = {"retrace.image/1"},
      .begin = begins<ImageOptions>(arguments, run)};
}

}  // namespace retrace::app
