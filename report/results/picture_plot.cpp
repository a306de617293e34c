#include <fmt/format.h>

#include "core/number_format.h"
#include "core/version.h"
#include "design/io/design_json.h"
#include "report/colour_scale.h"
#include "report/results/result_plots.h"
#include "studies/image/camera_study.h"
#include "studies/image/detector_study.h"

namespace retrace::report {
namespace {

using studies::CameraResult, studies::DetectorResult;

/// Reverses the order of the rows. Grids of directions begin with the lowest row, pictures with the top row.
std::vector<double> turned_over(const std::vector<double>& values, std::size_t columns) {
  std::vector<double> result;
  result.reserve(values.size());
  for (std::size_t row = values.size() / columns; row-- > 0;)
    result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(row * columns),
                  values.begin() + static_cast<std::ptrdiff_t>((row + 1) * columns));
  return result;
}

std::string direction_text(const DetectorResult& result) {
  std::string text = fmt::format("light at incidence {}°", shortest(result.request.incidence_deg));
  if (result.request.azimuth_deg != 0.0) text += fmt::format(", azimuth {}°", shortest(result.request.azimuth_deg));
  return text;
}

void add_channel(FloatPicture& picture, const std::string& name, const std::vector<double>& values) {
  if (!values.empty()) picture.channels.emplace_back(name, values);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> picture_texts(const char* kind, const design::Design& design) {
  return {{"Software", std::string("retrace ") + kVersion},
          {"retrace:schema", "retrace.image/1"},
          {"retrace:kind", kind},
          {"retrace:design", design.source_name()}};
}

ImagePlot irradiance_plot(const DetectorResult& result) {
  ImagePlot plot;
  plot.title = design::short_name(result.design);
  plot.remarks.push_back(fmt::format("{}; returned within {}°: RRE {} %{}", direction_text(result),
                                     shortest(result.acceptance_half_angle_deg), fixed(100.0 * result.maps.rre, 2),
                                     result.is_period ? "; one period of an infinite array" : ""));
  const auto panel = [&](const char* title, const std::vector<double>& values) {
    return ImagePanel{title,
                      "irradiance divided by that of the beam",
                      result.face.columns(),
                      result.face.rows(),
                      values,
                      result.face.bounds_mm().size().x(),
                      "mm"};
  };
  plot.panels.push_back(panel("Light on the detector", result.maps.leaving.value));
  plot.panels.push_back(panel("Positions at which it entered", result.maps.entering.value));
  return plot;
}

ImagePlot angular_plot(const DetectorResult& result) {
  ImagePlot plot;
  plot.title = design::short_name(result.design);
  plot.remarks.push_back(direction_text(result) + "; around the direction back to the source");
  plot.remarks.push_back(fmt::format("{} % of the light leaves beyond {}°", fixed(100.0 * result.maps.outside, 2),
                                     shortest(result.request.window_deg)));
  ImagePanel panel{"Fraction of the light by direction",
                   "per steradian",
                   result.request.angle_pixels,
                   result.request.angle_pixels,
                   turned_over(result.maps.per_sr.value, result.request.angle_pixels),
                   2.0 * result.request.window_deg,
                   "°"};
  panel.is_logarithmic = true;
  plot.panels.push_back(std::move(panel));
  return plot;
}

FloatPicture irradiance_picture(const DetectorResult& result) {
  FloatPicture picture;
  picture.columns = result.face.columns();
  picture.rows = result.face.rows();
  add_channel(picture, "leaving", result.maps.leaving.value);
  add_channel(picture, "leaving.std_error", result.maps.leaving.std_error);
  add_channel(picture, "entering", result.maps.entering.value);
  add_channel(picture, "entering.std_error", result.maps.entering.std_error);
  picture.texts = picture_texts("detector", result.design);
  picture.texts.emplace_back("retrace:engine", result.engine);
  picture.texts.emplace_back("retrace:unit", "irradiance over that of the beam on the face");
  const geometry::Rectangle& bounds = result.face.bounds_mm();
  picture.numbers = {{"retrace:x_from_mm", bounds.lower.x()},
                     {"retrace:y_from_mm", bounds.lower.y()},
                     {"retrace:x_to_mm", bounds.upper.x()},
                     {"retrace:y_to_mm", bounds.upper.y()},
                     {"retrace:incidence_deg", result.request.incidence_deg},
                     {"retrace:azimuth_deg", result.request.azimuth_deg},
                     {"retrace:acceptance_half_angle_deg", result.acceptance_half_angle_deg},
                     {"retrace:rre", result.maps.rre}};
  return picture;
}

FloatPicture angular_picture(const DetectorResult& result) {
  FloatPicture picture;
  picture.columns = picture.rows = result.request.angle_pixels;
  add_channel(picture, "per_sr", turned_over(result.maps.per_sr.value, picture.columns));
  if (!result.maps.per_sr.std_error.empty())
    add_channel(picture, "per_sr.std_error", turned_over(result.maps.per_sr.std_error, picture.columns));
  picture.texts = picture_texts("detector", result.design);
  picture.texts.emplace_back("retrace:engine", result.engine);
  picture.texts.emplace_back("retrace:unit", "share of the incident power per steradian");
  picture.numbers = {{"retrace:half_width_deg", result.request.window_deg},
                     {"retrace:incidence_deg", result.request.incidence_deg},
                     {"retrace:azimuth_deg", result.request.azimuth_deg},
                     {"retrace:outside", result.maps.outside}};
  return picture;
}

FloatPicture luminance_picture(const CameraResult& result) {
  const raytrace::CameraImage& image = result.image;
  FloatPicture picture;
  picture.columns = image.columns;
  picture.rows = image.rows;
  add_channel(picture, "Y", image.luminance);
  std::vector<double> errors;
  for (std::size_t k = 0; k < image.luminance.size() && image.passes > 1; ++k) errors.push_back(image.std_error(k));
  add_channel(picture, "std_error", errors);
  add_channel(picture, "coverage", image.coverage);
  picture.texts = picture_texts("camera", result.design);
  picture.texts.emplace_back("retrace:unit", "cd/m2");
  picture.numbers = {{"retrace:width_mm", result.scene.view.width_mm},
                     {"retrace:observation_deg", result.observation_deg},
                     {"retrace:entrance_deg", result.entrance_deg},
                     {"retrace:viewing_deg", result.viewing_deg},
                     {"retrace:illuminance_lx", result.request.illuminance_lx},
                     {"retrace:ambient_lx", result.request.ambient_lx},
                     {"retrace:lamp_arcmin", result.request.lamp_arcmin},
                     {"retrace:pupil_arcmin", result.request.pupil_arcmin},
                     {"retrace:passes", result.image.passes}};
  return picture;
}

std::vector<unsigned char> tone_mapped_pixels(const std::vector<double>& luminance) {
  std::vector<unsigned char> rgb;
  for (const double shown : tone_mapped(luminance)) rgb.insert(rgb.end(), 3, srgb_byte(shown));
  return rgb;
}

ImagePlot false_colour_plot(const CameraResult& result) {
  ImagePlot plot;
  plot.title = design::short_name(result.design);
  plot.remarks.push_back(fmt::format("{} lx, observation angle {}°, entrance angle {}°",
                                     shortest(result.request.illuminance_lx), fixed_visible(result.observation_deg, 2),
                                     fixed_visible(result.entrance_deg, 2)));
  if (result.image.part_means.size() > 1)
    plot.remarks.push_back(fmt::format("mean luminance of the part {} cd/m²", fixed(result.image.part_mean(), 3)));
  ImagePanel panel{"Luminance",
                   "luminance (cd/m²)",
                   result.image.columns,
                   result.image.rows,
                   result.image.luminance,
                   result.scene.view.width_mm,
                   "mm"};
  panel.is_logarithmic = true;
  plot.panels.push_back(std::move(panel));
  return plot;
}

}  // namespace retrace::report
