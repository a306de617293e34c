#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/number_format.h"
#include "core/srgb.h"
#include "design/io/design_json.h"
#include "report/canvas.h"
#include "report/colour_scale.h"
#include "report/image_plot.h"
#include "report/results/picture_display.h"
#include "report/results/result_plots.h"
#include "studies/image/camera_study.h"

namespace retrace::report {
namespace {

using studies::CameraResult;

/// Returns the linear sRGB values of each pixel, in cd/m^2.
std::array<std::vector<double>, 3> rgb_of(const CameraResult& result) {
  const std::vector<double>& luminance = result.image.luminance;
  std::array<std::vector<double>, 3> rgb;
  if (!result.colours) return {luminance, luminance, luminance};
  for (std::size_t k = 0; k < luminance.size(); ++k) {
    const std::array<double, 3> pixel = result.colours->rgb(luminance[k], k);
    for (std::size_t c = 0; c < 3; ++c) rgb[c].push_back(pixel[c]);
  }
  return rgb;
}

void add_colours(FloatPicture& picture, const CameraResult& result) {
  std::vector<double> x = result.colours->x;
  std::vector<double> z = result.colours->z;
  for (double& value : x) value *= result.colours->lamp[0];
  for (double& value : z) value *= result.colours->lamp[2];
  picture.add_channel("X", x);
  picture.add_channel("Z", z);
  const std::array<std::vector<double>, 3> rgb = rgb_of(result);
  for (std::size_t c = 0; c < 3; ++c) picture.add_channel(std::array{"R", "G", "B"}[c], rgb[c]);
}

}  // namespace

FloatPicture luminance_picture(const CameraResult& result) {
  const raytrace::CameraImage& image = result.image;
  FloatPicture picture;
  picture.columns = image.columns;
  picture.rows = image.rows;
  picture.add_channel("Y", image.luminance);
  if (result.colours) add_colours(picture, result);
  std::vector<double> errors;
  for (std::size_t k = 0; k < image.luminance.size() && image.passes > 1; ++k) errors.push_back(image.std_error(k));
  picture.add_channel("std_error", errors);
  picture.add_channel("coverage", image.coverage);
  picture.texts = picture_texts("camera", result.design);
  picture.texts.emplace_back("retrace:unit", "cd/m2");
  picture.numbers = {{"retrace:width_mm", result.scene.view.width_mm},
                     {"retrace:observation_deg", result.observation_deg},
                     {"retrace:entrance_deg", result.entrance_deg},
                     {"retrace:viewing_deg", result.viewing_deg},
                     {"retrace:illuminance_lx", result.scene.lamp.illuminance_lx},
                     {"retrace:ambient_lx", result.request.ambient_lx},
                     {"retrace:lamp_arcmin", result.request.lamp_arcmin},
                     {"retrace:pupil_arcmin", result.request.pupil_arcmin},
                     {"retrace:passes", result.image.passes}};
  return picture;
}

namespace {

constexpr double kMinTileWidth = 380.0;
// Maximum size of a picture in a sheet of several pictures.
constexpr double kSheetTileWidth = 400.0;
constexpr Size kSheetTile{kSheetTileWidth, 600.0};

std::vector<Colour> displayed_pixels(const CameraResult& result, const ToneCurve& tone) {
  const raytrace::CameraImage& image = result.image;
  const std::array<std::vector<double>, 3> rgb = rgb_of(result);
  std::vector<Colour> colours;
  colours.reserve(image.luminance.size());
  for (std::size_t k = 0; k < image.luminance.size(); ++k) {
    double luminance = image.luminance[k];
    std::array<double, 3> pixel{rgb[0][k], rgb[1][k], rgb[2][k]};
    std::array<double, 3> photograph{};
    if (result.background) {
      const std::array<double, 3> behind = result.background->mean_colour(k, image.columns, image.rows);
      const double free = 1.0 - image.coverage[k];
      for (std::size_t c = 0; c < 3; ++c) (result.background->is_luminance ? pixel : photograph)[c] += free * behind[c];
      if (result.background->is_luminance) luminance += free * srgb_luminance(behind);
    }
    const double shown = tone.shown(luminance);
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = (luminance > 0.0 ? shown * pixel[c] / luminance : 0.0) + photograph[c];
    colours.push_back(displayed(pixel, shown + srgb_luminance(photograph)));
  }
  return colours;
}

double metres(const geometry::Vec3& from, const geometry::Vec3& to) {
  return 1e-3 * (from - to).norm();
}

std::string geometry_text(const CameraResult& result) {
  const raytrace::CameraScene& scene = result.scene;
  const double eye_m = metres(scene.view.eye_mm, scene.view.target_mm);
  const double lamp_m = metres(scene.lamp.position_mm, scene.view.target_mm);
  std::string text = fmt::format("distance {} m", rounded_text(eye_m));
  if (std::abs(lamp_m / eye_m - 1.0) > 1e-3) text += fmt::format(" (lamp {} m)", rounded_text(lamp_m));
  text += fmt::format(", observation angle {}\u00b0, entrance angle {}\u00b0", fixed_visible(result.observation_deg, 2),
                      fixed_visible(result.entrance_deg, 2));
  if (result.request.rotation_deg != 0.0)
    text += fmt::format(", rotation {}\u00b0", shortest(result.request.rotation_deg));
  return text;
}

std::string light_text(const CameraResult& result) {
  std::string text = fmt::format("{} lx", rounded_text(result.scene.lamp.illuminance_lx));
  if (result.image.part_means.size() > 1)
    text += fmt::format(", mean luminance {} cd/m\u00b2", rounded_text(result.image.part_mean()));
  if (result.r_a) text += fmt::format(", R_A {} cd/(lx m\u00b2)", rounded_text(*result.r_a));
  if (result.no_diffraction) text += ", without diffraction";
  return text;
}

/// Returns the size of a picture on the canvas. Small pictures are enlarged by an integer factor.
/// \param largest maximum width and height
Size shown_size(const CameraResult& result, const Size& largest) {
  const auto columns = static_cast<double>(result.image.columns);
  const auto rows = static_cast<double>(result.image.rows);
  const double factor = std::min(largest.width / columns, largest.height / rows);
  const double shown = factor >= 1.0 ? std::floor(factor) : factor;
  return {shown * columns, shown * rows};
}

/// Draws a scale bar for lengths whose right end is at `end`. Returns the width of the bar and its label.
double draw_length_bar(Canvas& canvas, const CameraResult& result, Point end, double picture_width) {
  const double width_mm = result.scene.view.width_mm;
  const double length_mm = scale_bar_length(0.6 * width_mm);
  const double drawn = picture_width * length_mm / width_mm;
  const std::string label = shortest(length_mm) + " mm";
  canvas.line({{end.x - drawn, end.y}, end}, {kBright, 2.0, {}});
  canvas.text({end.x - drawn - 6.0, end.y + 4.0}, label, kLineFont, kBright, Align::right);
  return drawn + 6.0 + canvas.text_width(label, kLineFont);
}

/// Draws a picture with its name and lines. Returns the height.
/// \param canvas if null, only the height is determined, with the font metrics of `metrics`
/// \param largest maximum width and height of the picture; the name and the lines have the same maximum width
double draw_tile(Canvas* canvas, const Canvas& metrics, const CameraResult& result, const ToneCurve& tone, Point corner,
                 const Size& largest, const std::vector<std::string>& texts) {
  const double width = largest.width;
  const Size size = shown_size(result, largest);
  const double x = corner.x + 0.5 * (width - size.width);
  if (canvas != nullptr) canvas->image({x, corner.y}, size, result.image.columns, displayed_pixels(result, tone));
  double y = corner.y + size.height + 18.0;
  if (canvas != nullptr) {
    const double bar = draw_length_bar(*canvas, result, {corner.x + width, y - 4.0}, size.width) + kGap;
    for (const std::string& line :
         canvas->fitted(name_with_dye(result.design, result.request.dye), kNameFont, width - bar, 1, Ellipsis::middle))
      canvas->text({corner.x, y}, line, kNameFont, kBright, Align::left);
  }
  for (const std::string& text : texts)
    for (const std::string& line : metrics.fitted(text, kLineFont, width, 3, Ellipsis::end)) {
      y += kLine;
      if (canvas != nullptr) canvas->text({corner.x, y}, line, kLineFont, kDim, Align::left);
    }
  return y - corner.y;
}

}  // namespace

ToneCurve camera_tone(std::span<const CameraResult> results) {
  const auto& request = results.front().request;
  const Tone tone = tone_of(request.tone);
  if (request.exposure_ev) return tone_of_exposure(*request.exposure_ev, tone);
  std::vector<double> all;
  for (const CameraResult& result : results)
    all.insert(all.end(), result.image.luminance.begin(), result.image.luminance.end());
  return tone_of_picture(all, tone);
}

std::string camera_png(const CameraResult& result, const ToneCurve& tone) {
  const double width = std::max(kMinTileWidth, static_cast<double>(result.image.columns));
  const std::vector<std::string> texts = {geometry_text(result), light_text(result),
                                          exposure_text(tone, result.request.exposure_ev.has_value())};
  const Canvas metrics(Canvas::Format::png, {1.0, 1.0}, 1.0);
  const Size largest{width, std::max(2.0 * kMinTileWidth, static_cast<double>(result.image.rows))};
  const double height = draw_tile(nullptr, metrics, result, tone, {0.0, 0.0}, largest, texts);
  const double bar = has_bar(tone) ? kGap + kBarHeight + 18.0 : 0.0;
  const Size size{width + 2.0 * kGap, std::ceil(kGap + height + bar + kGap)};
  Canvas canvas(Canvas::Format::png, size, 1.0);
  canvas.fill_rectangle({0.0, 0.0}, size, kPaper);
  draw_tile(&canvas, metrics, result, tone, {kGap, kGap}, largest, texts);
  if (has_bar(tone)) draw_luminance_bar(canvas, tone, {kGap, 2.0 * kGap + height}, width);
  return canvas.finish();
}

std::string camera_png(const CameraResult& result) {
  return camera_png(result, camera_tone({&result, 1}));
}

std::string camera_sheet_png(std::span<const CameraResult> results, const ToneCurve& tone) {
  constexpr std::size_t kMaxColumns = 4;
  const std::size_t count = results.size();
  const std::size_t rows = (count + kMaxColumns - 1) / kMaxColumns;
  const std::size_t columns = (count + rows - 1) / rows;
  const Canvas metrics(Canvas::Format::png, {1.0, 1.0}, 1.0);
  const auto texts_of = [](const CameraResult& result) {
    return std::vector<std::string>{geometry_text(result), light_text(result)};
  };
  std::vector<double> heights;
  for (std::size_t k = 0; k < count; ++k) {
    const double height = draw_tile(nullptr, metrics, results[k], tone, {0.0, 0.0}, kSheetTile, texts_of(results[k]));
    if (k % columns == 0) heights.push_back(0.0);
    heights.back() = std::max(heights.back(), height);
  }
  double height = kGap;
  for (const double row : heights) height += row + 1.5 * kGap;
  const double bar = has_bar(tone) ? kBarHeight + 24.0 : 0.0;
  const Size size{kGap + static_cast<double>(columns) * (kSheetTileWidth + kGap),
                  std::ceil(height + bar + kLine + kGap)};
  Canvas canvas(Canvas::Format::png, size, 1.0);
  canvas.fill_rectangle({0.0, 0.0}, size, kPaper);
  double y = kGap;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = kGap + static_cast<double>(k % columns) * (kSheetTileWidth + kGap);
    draw_tile(&canvas, metrics, results[k], tone, {x, y}, kSheetTile, texts_of(results[k]));
    if (k % columns + 1 == columns) y += heights[k / columns] + 1.5 * kGap;
  }
  y = height;
  if (has_bar(tone))
    draw_luminance_bar(canvas, tone, {kGap, y}, std::min(2.0 * kSheetTileWidth, size.width - 2.0 * kGap));
  const std::vector<std::string> last =
      canvas.fitted(exposure_text(tone, results.front().request.exposure_ev.has_value()), kLineFont,
                    size.width - 2.0 * kGap, 1, Ellipsis::end);
  for (const std::string& line : last) canvas.text({kGap, y + bar + kLine - 4.0}, line, kLineFont, kDim, Align::left);
  return canvas.finish();
}

ImagePlot false_colour_plot(const CameraResult& result) {
  ImagePlot plot;
  plot.title = design::short_name(result.design);
  plot.remarks.push_back(fmt::format("{} lx, observation angle {}°, entrance angle {}°",
                                     rounded_text(result.scene.lamp.illuminance_lx),
                                     fixed_visible(result.observation_deg, 2), fixed_visible(result.entrance_deg, 2)));
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
