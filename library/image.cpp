#include "retrace/image.h"

#include <memory>

#include "core/threads.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/io/picture_file.h"
#include "report/results/result_plots.h"
#include "studies/image/io/image_documents.h"

namespace retrace {
namespace {

/// Runs the study of one kind of picture and copies warnings and completeness to the result.
/// \return result of the study
template <class Study>
auto run(const Study& study, const Running& running, ImageResult& result) {
  const auto found = std::make_shared<decltype(study.run(running.progress, running.cancellation))>();
  run_with_threads(running.threads, [&] { *found = study.run(running.progress, running.cancellation); });
  result.warnings = found->warnings;
  result.complete = found->complete;
  return found;
}

Picture picture_of(const std::string& name, FloatPicture numbers, Drawing drawing) {
  return {name, numbers.columns, numbers.rows, std::move(numbers.channels), std::move(drawing)};
}

}  // namespace

ImageResult detector(const Design& design, const DetectorRequest& request, const Running& running) {
  const studies::DetectorStudy study(design.content().design, request);
  ImageResult result;
  const auto found = run(study, running, result);
  result.json = studies::detector_json(*found);
  result.table = studies::detector_table(*found);
  if (!found->complete) return result;
  result.pictures = {picture_of("irradiance", report::irradiance_picture(*found),
                                drawing_of([found] { return report::irradiance_plot(*found); })),
                     picture_of("angular", report::angular_picture(*found),
                                drawing_of([found] { return report::angular_plot(*found); }))};
  return result;
}

ImageResult camera(const Design& design, const CameraRequest& request, const Running& running) {
  const studies::CameraStudy study(design.content().design, request);
  ImageResult result;
  const auto found = run(study, running, result);
  result.json = studies::camera_json(*found);
  result.table = studies::camera_table(*found);
  if (found->image.passes == 0) return result;
  const auto png = [found] {
    const raytrace::CameraImage& image = found->image;
    return report::png_file(image.columns, image.rows, report::tone_mapped_pixels(image.luminance));
  };
  result.pictures = {picture_of("camera", report::luminance_picture(*found), drawing_of_text(png, false))};
  return result;
}

ImageResult road(const Design& design, const RoadRequest& request, const Running& running) {
  const studies::RoadStudy study(design.content().design, request);
  ImageResult result;
  const auto found = run(study, running, result);
  result.json = studies::road_json(*found);
  result.table = studies::road_table(*found);
  if (found->views.empty()) return result;
  result.pictures = {picture_of("road", report::road_picture(*found),
                                drawing_of_text([found] { return report::road_png(*found); }, false))};
  return result;
}

}  // namespace retrace
