#include "retrace/image.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "studies/image/camera_series.h"
#include "studies/image/io/image_documents.h"

namespace retrace {
namespace {

/// Runs the study of one kind of picture. Copies warnings and completeness to the result, and adds its JSON document
/// and its table.
/// \return result of the study
template <class Study, class Request, class Found>
std::shared_ptr<const Found> run(const Design& design, const Request& request, const Running& running,
                                 ImageResult& result, std::string (*json)(const Found&),
                                 std::string (*table)(const Found&)) {
  const Study study(design.content().design, request);
  const auto found = std::make_shared<Found>();
  run_with_threads(running.threads, [&] { *found = study.run(running.progress, running.cancellation); });
  result.warnings = found->warnings;
  result.complete = found->complete;
  result.json = json(*found);
  result.table = table(*found);
  return found;
}

Picture picture_of(const std::string& name, FloatPicture numbers, Drawing drawing) {
  return {name, numbers.columns, numbers.rows, std::move(numbers.channels), std::move(drawing)};
}

}  // namespace

ImageResult detector(const Design& design, const DetectorRequest& request, const Running& running) {
  ImageResult result;
  const auto found =
      run<studies::DetectorStudy>(design, request, running, result, studies::detector_json, studies::detector_table);
  if (!found->has_maps()) return result;
  result.pictures = {picture_of("irradiance", report::irradiance_picture(*found),
                                drawing_of([found] { return report::irradiance_plot(*found); })),
                     picture_of("angular", report::angular_picture(*found),
                                drawing_of([found] { return report::angular_plot(*found); }))};
  return result;
}

ImageResult camera(const Design& design, const CameraRequest& request, const Running& running) {
  ImageResult result;
  const auto found =
      run<studies::CameraStudy>(design, request, running, result, studies::camera_json, studies::camera_table);
  if (found->image.passes == 0) return result;
  result.pictures = {picture_of("camera", report::luminance_picture(*found),
                                drawing_of_text([found] { return report::camera_png(*found); }, false))};
  return result;
}

ImageResult camera_series(const std::vector<Design>& designs, const std::vector<CameraRequest>& requests,
                          const Running& running) {
  std::vector<design::Design> contents;
  for (const Design& design : designs) contents.push_back(design.content().design);
  const studies::CameraSeries series(contents, requests);
  const auto found = std::make_shared<studies::CameraSeriesResult>();
  run_with_threads(running.threads, [&] { *found = series.run(running.progress, running.cancellation); });
  ImageResult result;
  result.warnings = found->warnings;
  result.complete = found->complete;
  result.json = studies::camera_series_json(found->pictures, found->warnings, found->complete);
  result.table = studies::camera_series_table(found->pictures);
  if (found->pictures.empty()) return result;
  const auto tone = std::make_shared<const report::ToneCurve>(report::camera_tone(found->pictures));
  for (std::size_t k = 0; k < found->pictures.size(); ++k)
    result.pictures.push_back(
        picture_of(fmt::format("camera_{:02}", k + 1), report::luminance_picture(found->pictures[k]),
                   drawing_of_text([found, tone, k] { return report::camera_png(found->pictures[k], *tone); }, false)));
  result.sheet = drawing_of_text([found, tone] { return report::camera_sheet_png(found->pictures, *tone); }, false);
  return result;
}

ImageResult road(const Design& design, const RoadRequest& request, const Running& running) {
  ImageResult result;
  const auto found = run<studies::RoadStudy>(design, request, running, result, studies::road_json, studies::road_table);
  if (found->views.empty()) return result;
  result.pictures = {picture_of("road", report::road_picture(*found),
                                drawing_of_text([found] { return report::road_png(*found); }, false))};
  return result;
}

}  // namespace retrace
