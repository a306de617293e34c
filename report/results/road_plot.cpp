#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/number_format.h"
#include "design/io/design_json.h"
#include "report/canvas.h"
#include "report/colour_scale.h"
#include "report/results/result_plots.h"
#include "studies/image/road_study.h"

namespace retrace::report {
namespace {

using studies::RoadResult, studies::RoadView;

constexpr Colour kBackground{0.07, 0.075, 0.09};
constexpr Colour kText{0.93, 0.93, 0.93};
constexpr Colour kFaint{0.66, 0.68, 0.72};
constexpr double kMargin = 14.0;
constexpr double kHead = 40.0;
constexpr double kCaption = 46.0;
constexpr double kViewWidth = 330.0;
// Brightness of the picture to which the logarithmic mean of the luminances is mapped. It is low, because the scene is
// at night.
constexpr double kNightKey = 0.045;

/// Returns the colour of white light after the dye, in linear sRGB with luminance 1. Components may be outside of the
/// range of the display.
std::array<double, 3> tint_of(const std::string& dye) {
  if (dye == "red") return {3.2, 0.42, 0.28};
  if (dye == "amber") return {2.1, 0.76, 0.08};
  return {1.0, 1.0, 1.0};
}

std::vector<double> all_luminances(const RoadResult& result) {
  std::vector<double> all;
  for (const RoadView& view : result.views) all.insert(all.end(), view.luminance.begin(), view.luminance.end());
  return all;
}

std::vector<Colour> colours_of(const RoadResult& result, const RoadView& view, const double* shown) {
  const std::array<double, 3> tint = tint_of(result.scene.dye);
  std::vector<Colour> colours;
  colours.reserve(view.luminance.size());
  for (std::size_t k = 0; k < view.luminance.size(); ++k) {
    const double part = view.luminance[k] > 0.0 ? view.coloured[k] / view.luminance[k] : 0.0;
    std::array<double, 3> channel{};
    for (std::size_t c = 0; c < 3; ++c) {
      // Light from the reflectors has the colour of the dye. All other light is white. Overexposed pixels become white,
      // as on film.
      const double colour = part * tint[c] + (1.0 - part);
      channel[c] = srgb_byte(shown[k] * colour + 0.3 * std::max(0.0, shown[k] - 0.75)) / 255.0;
    }
    colours.push_back({channel[0], channel[1], channel[2]});
  }
  return colours;
}

}  // namespace

std::string road_png(const RoadResult& result, double scale) {
  const auto views = static_cast<double>(result.views.size());
  const double height = kViewWidth * static_cast<double>(result.scene.rows) / static_cast<double>(result.scene.columns);
  const Size size{kMargin + std::max(1.0, views) * (kViewWidth + kMargin), kHead + height + kCaption};
  Canvas canvas(Canvas::Format::png, size, scale);
  canvas.fill_rectangle({0.0, 0.0}, size, kBackground);
  const std::string title =
      fmt::format("{}{}: view of a driver, lit by the car's own headlamps", design::short_name(result.design),
                  result.scene.dye.empty() ? "" : ", " + result.scene.dye);
  for (const std::string& line : canvas.fitted(title, {15.0, true}, size.width - 2.0 * kMargin, 1, Ellipsis::middle))
    canvas.text({kMargin, 25.0}, line, {15.0, true}, kText, Align::left);
  const std::vector<double> shown = tone_mapped(all_luminances(result), kNightKey);
  double x = kMargin;
  const double* at = shown.data();
  for (const RoadView& view : result.views) {
    canvas.image({x, kHead}, {kViewWidth, height}, result.scene.columns, colours_of(result, view, at));
    at += view.luminance.size();
    canvas.text({x, kHead + height + 18.0}, fmt::format("{} m", shortest(view.distance_m)), {13.0, true}, kText,
                Align::left);
    canvas.text({x, kHead + height + 35.0},
                fmt::format("observation angle {}\u00b0, reflectors {} and {} cd/m\u00b2",
                            fixed_visible(view.reflectors[0].observation_deg[0], 2),
                            fixed(view.reflectors[0].luminance, 1), fixed(view.reflectors[1].luminance, 1)),
                {11.0, false}, kFaint, Align::left);
    x += kViewWidth + kMargin;
  }
  return canvas.finish();
}

FloatPicture road_picture(const RoadResult& result) {
  const std::size_t columns = result.scene.columns;
  FloatPicture picture;
  picture.columns = columns * result.views.size();
  picture.rows = result.scene.rows;
  std::vector<double> luminance;
  std::vector<double> reflected;
  for (std::size_t row = 0; row < picture.rows; ++row)
    for (const RoadView& view : result.views) {
      const auto from = static_cast<std::ptrdiff_t>(row * columns);
      const auto to = static_cast<std::ptrdiff_t>((row + 1) * columns);
      luminance.insert(luminance.end(), view.luminance.begin() + from, view.luminance.begin() + to);
      reflected.insert(reflected.end(), view.coloured.begin() + from, view.coloured.begin() + to);
    }
  picture.channels = {{"Y", luminance}, {"reflected", reflected}};
  picture.texts = picture_texts("road", result.design);
  picture.texts.emplace_back("retrace:unit", "cd/m2");
  picture.numbers = {{"retrace:field_deg", result.scene.field_deg}, {"retrace:lamp_cd", result.request.lamp_cd}};
  return picture;
}

}  // namespace retrace::report
