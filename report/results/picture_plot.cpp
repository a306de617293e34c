#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/number_format.h"
#include "core/version.h"
#include "design/io/design_json.h"
#include "report/results/result_plots.h"
#include "studies/image/detector_study.h"

namespace retrace::report {
namespace {

using studies::DetectorResult;

/// Ratio of the brightest bin to the next one from which the brightest bin does not determine the colours.
constexpr double kMuchBrighter = 3.0;

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

/// Returns a remark about the largest standard error of bins with light.
std::string error_text(double relative_error) {
  constexpr double kSmallest = 1e-3;  // smaller errors are not visible in a picture
  return fmt::format(
      "bins with light have a standard error of {} %",
      relative_error < kSmallest ? "less than 0.1" : "at most " + fixed_visible(100.0 * relative_error, 1));
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
  if (result.face_error > 0.0) plot.remarks.push_back(error_text(result.face_error));
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
  plot.remarks.push_back(fmt::format("{}; {} % of the light leaves outside of this map",
                                     result.has_diffraction
                                         ? std::string("with diffraction, for a point source")
                                         : fmt::format("without diffraction ({})", result.without_diffraction),
                                     fixed(100.0 * result.maps.outside, 2)));
  if (result.angle_error > 0.0) plot.remarks.push_back(error_text(result.angle_error));
  ImagePanel panel{"Fraction of the light by direction",
                   "per steradian",
                   result.request.angle_pixels,
                   result.request.angle_pixels,
                   turned_over(result.maps.per_sr.value, result.request.angle_pixels),
                   2.0 * result.window_deg,
                   "°"};
  panel.is_logarithmic = true;
  // The reflection of the entrance face is not diffracted. It is in one bin, which is often much brighter than all
  // others, and the colours then end at the second brightest bin.
  if (result.has_diffraction && panel.values.size() > 1) {
    std::vector<double> values = panel.values;
    std::nth_element(values.begin(), values.begin() + 1, values.end(), std::greater<>());
    if (values[0] > kMuchBrighter * values[1] && values[1] > 0.0) {
      panel.full_value = values[1];
      plot.remarks.emplace_back("one bin, with the reflection of the entrance face, is brighter than the scale");
    }
  }
  plot.panels.push_back(std::move(panel));
  return plot;
}

FloatPicture irradiance_picture(const DetectorResult& result) {
  FloatPicture picture;
  picture.columns = result.face.columns();
  picture.rows = result.face.rows();
  picture.add_channel("leaving", result.maps.leaving.value);
  picture.add_channel("leaving.std_error", result.maps.leaving.std_error);
  picture.add_channel("entering", result.maps.entering.value);
  picture.add_channel("entering.std_error", result.maps.entering.std_error);
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
  if (result.face_error > 0.0) picture.numbers.emplace_back("retrace:bin_error", result.face_error);
  return picture;
}

FloatPicture angular_picture(const DetectorResult& result) {
  FloatPicture picture;
  picture.columns = picture.rows = result.request.angle_pixels;
  picture.add_channel("per_sr", turned_over(result.maps.per_sr.value, picture.columns));
  if (!result.maps.per_sr.std_error.empty())
    picture.add_channel("per_sr.std_error", turned_over(result.maps.per_sr.std_error, picture.columns));
  picture.texts = picture_texts("detector", result.design);
  picture.texts.emplace_back("retrace:engine", result.engine);
  picture.texts.emplace_back("retrace:unit", "share of the incident power per steradian");
  picture.texts.emplace_back("retrace:diffraction", result.has_diffraction ? "included" : "not included");
  picture.numbers = {{"retrace:half_width_deg", result.window_deg},
                     {"retrace:incidence_deg", result.request.incidence_deg},
                     {"retrace:azimuth_deg", result.request.azimuth_deg},
                     {"retrace:outside", result.maps.outside}};
  if (result.angle_error > 0.0) picture.numbers.emplace_back("retrace:bin_error", result.angle_error);
  return picture;
}

}  // namespace retrace::report
