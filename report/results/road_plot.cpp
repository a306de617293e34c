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
#include "report/results/picture_display.h"
#include "report/results/result_plots.h"
#include "studies/image/road_study.h"

namespace retrace::report {
namespace {

using geometry::Vec2;
using studies::RoadPixels, studies::RoadResult, studies::RoadView;

constexpr Font kTitleFont{15.0, true};
constexpr Font kInsetFont{9.5, false};
constexpr double kHead = 34.0;
// Minimum width of a picture. Smaller pictures are enlarged by an integer factor.
constexpr double kMinViewWidth = 320.0;
// Number of pixels of the file per unit of length of the drawing. A pixel of a picture is then a pixel of the file,
// unless the picture is enlarged.
constexpr double kPixelsPerUnit = 1.5;
constexpr std::size_t kMaxColumns = 3;
// Brightness of the picture to which the logarithmic mean of the luminances is mapped. It is low, because the scene is
// at night.
constexpr double kNightKey = 0.015;

std::vector<Colour> colours_of(const RoadPixels& pixels, const ToneCurve& tone) {
  std::vector<Colour> colours;
  colours.reserve(pixels.luminance.size());
  for (std::size_t k = 0; k < pixels.luminance.size(); ++k) {
    // The tone curve is applied to the brightest component, so that bright reflectors keep their colour. Negative
    // components, which cannot be displayed, are set to 0.
    std::array<double, 3> rgb = pixels.rgb[k];
    for (double& value : rgb) value = std::max(value, 0.0);
    const double brightest = std::max({rgb[0], rgb[1], rgb[2]});
    const double factor = brightest > 0.0 ? tone.shown(brightest) / brightest : 0.0;
    for (double& value : rgb) value *= factor;
    colours.push_back(displayed(rgb, srgb_luminance(rgb)));
  }
  return colours;
}

/// Returns "1.08", or "1.08 and 2.10" if two values are displayed differently.
std::string both(const double (&values)[2], int digits) {
  const std::string left = fixed_visible(values[0], digits);
  const std::string right = fixed_visible(values[1], digits);
  return left == right ? left : fmt::format("{} and {}", left, right);
}

/// Returns the caption with the values of one reflector.
std::string reflector_text(const RoadView& view, std::size_t k) {
  const studies::RoadReflector& r = view.reflectors[k];
  return fmt::format("{}: observation angle {}\u00b0, {} lx, {} cd/m\u00b2, {} cd", studies::reflector_name(view, k),
                     both(r.observation_deg, 2), rounded_text(r.illuminance_lx[0] + r.illuminance_lx[1]),
                     rounded_text(r.luminance), rounded_text(r.intensity_cd));
}

std::string scene_text(const RoadResult& result) {
  const studies::RoadScene& s = result.scene;
  const std::string lamps = s.lamp ? s.lamp->name.substr(s.lamp->name.find_last_of('/') + 1)
                                   : fmt::format("2 x {} cd in all directions", shortest(s.lamp_cd));
  return fmt::format(
      "Luminances and intensities of the reflectors are computed. The scene is illustrative: headlamps {}, asphalt R_L "
      "{}, markings R_L {} mcd/(lx m\u00b2), R_L in the 30 m geometry.",
      lamps, shortest(1e3 * s.asphalt_r_l), shortest(1e3 * s.marking_r_l));
}

/// Returns the size of a picture on the canvas.
Size shown_size(const RoadResult& result) {
  const double width = static_cast<double>(result.scene.columns) / kPixelsPerUnit;
  const double factor = std::max(1.0, std::ceil(kMinViewWidth / width));
  return {factor * width, factor * static_cast<double>(result.scene.rows) / kPixelsPerUnit};
}

/// Draws the inset with the enlarged reflector in an upper corner of the picture, and marks the reflector.
void draw_inset(Canvas& canvas, const RoadResult& result, const RoadView& view, const ToneCurve& tone, Point corner,
                Size size) {
  const double factor = size.width / static_cast<double>(result.scene.columns);
  const auto& camera = view.inset_camera;
  const Size inset{factor * static_cast<double>(camera.columns), factor * static_cast<double>(camera.rows)};
  const double margin = 0.025 * size.width;
  const double magnification = view.camera.pixel / camera.pixel;
  const Vec2 target = factor * view.camera.position_of(result.scene.reflectors.back());
  // Frame around the part of the picture that the inset shows. It is large enough not to hide a distant reflector.
  const Size part{std::max(12.0, inset.width / magnification), std::max(8.0, inset.height / magnification)};
  const Point from{corner.x + target.x() - 0.5 * part.width, corner.y + target.y() - 0.5 * part.height};
  const double right = corner.x + size.width - margin - inset.width;
  const bool is_left = from.x + part.width > right - margin && from.y < corner.y + inset.height + 2.0 * margin;
  const Point at{is_left ? corner.x + margin : right, corner.y + margin};
  const Stroke line{kDim, 0.7, {}};
  const Stroke faint{{0.45, 0.47, 0.51}, 0.6, {}};
  const auto frame = [&](Point upper_left, Size extent, const Stroke& stroke) {
    canvas.line({upper_left,
                 {upper_left.x + extent.width, upper_left.y},
                 {upper_left.x + extent.width, upper_left.y + extent.height},
                 {upper_left.x, upper_left.y + extent.height},
                 upper_left},
                stroke);
  };
  canvas.clip(corner, size);
  if (magnification > 1.2) {
    frame(from, part, faint);
    if (from.y > at.y + inset.height) {
      canvas.line({{from.x, from.y}, {at.x, at.y + inset.height}}, faint);
      canvas.line({{from.x + part.width, from.y}, {at.x + inset.width, at.y + inset.height}}, faint);
    } else {
      const double inset_side = is_left ? at.x + inset.width : at.x;
      const double frame_side = is_left ? from.x : from.x + part.width;
      canvas.line({{frame_side, from.y}, {inset_side, at.y}}, faint);
      canvas.line({{frame_side, from.y + part.height}, {inset_side, at.y + inset.height}}, faint);
    }
  }
  canvas.image(at, inset, camera.columns, colours_of(view.inset, tone));
  frame(at, inset, line);
  if (magnification > 1.2)
    canvas.text({at.x + inset.width - 4.0, at.y + inset.height - 5.0},
                fmt::format("x {}", magnification < 10.0 ? fixed(magnification, 1) : fixed(magnification, 0)),
                kInsetFont, kBright, Align::right);
  canvas.end_clip();
}

/// Draws a view with its caption. Returns the height of both.
/// \param canvas if null, only the height is determined, with the font metrics of `metrics`
double draw_view(Canvas* canvas, const Canvas& metrics, const RoadResult& result, const RoadView& view,
                 const ToneCurve& tone, Point corner) {
  const Size size = shown_size(result);
  if (canvas != nullptr) {
    canvas->image(corner, size, result.scene.columns, colours_of(view.picture, tone));
    draw_inset(*canvas, result, view, tone, corner, size);
  }
  double y = corner.y + size.height + 18.0;
  if (canvas != nullptr)
    canvas->text({corner.x, y}, fmt::format("{} m", shortest(view.distance_m)), kNameFont, kBright, Align::left);
  for (std::size_t k = 0; k < view.reflectors.size(); ++k)
    for (const std::string& line : metrics.fitted(reflector_text(view, k), kLineFont, size.width, 2, Ellipsis::end)) {
      y += kLine;
      if (canvas != nullptr) canvas->text({corner.x, y}, line, kLineFont, kDim, Align::left);
    }
  return y - corner.y;
}

ToneCurve road_tone(const RoadResult& result) {
  const Tone tone = tone_of(result.request.tone);
  if (result.request.exposure_ev) return tone_of_exposure(*result.request.exposure_ev, tone);
  std::vector<double> all;
  for (const RoadView& view : result.views)
    all.insert(all.end(), view.picture.luminance.begin(), view.picture.luminance.end());
  return tone_of_picture(all, tone, kNightKey);
}

std::string drawn(const RoadResult& result, std::span<const RoadView> views, const ToneCurve& tone) {
  const Canvas metrics(Canvas::Format::png, {1.0, 1.0}, 1.0);
  const std::size_t count = views.size();
  const std::size_t rows = std::max<std::size_t>(1, (count + kMaxColumns - 1) / kMaxColumns);
  const std::size_t columns = std::max<std::size_t>(1, (count + rows - 1) / rows);
  double tallest = 0.0;
  for (const RoadView& view : views)
    tallest = std::max(tallest, draw_view(nullptr, metrics, result, view, tone, {0.0, 0.0}));
  const Size view_size = shown_size(result);
  const double width = 2.0 * kGap + static_cast<double>(columns) * (view_size.width + kGap) - kGap;
  std::vector<std::string> notes;
  const std::string exposure = exposure_text(tone, result.request.exposure_ev.has_value());
  for (const std::string& text :
       {scene_text(result), (result.views.size() > 1 ? "One exposure for all distances: " : "Exposure: ") + exposure})
    for (const std::string& line : metrics.fitted(text, kLineFont, width - 2.0 * kGap, 4, Ellipsis::end))
      notes.push_back(line);
  const double bar = has_bar(tone) ? kGap + kBarHeight + 18.0 : 0.0;
  const double height = kHead + static_cast<double>(rows) * (tallest + 1.5 * kGap) +
                        static_cast<double>(notes.size()) * kLine + bar + 0.5 * kGap;
  const Size size{width, std::ceil(height)};
  Canvas canvas(Canvas::Format::png, size, kPixelsPerUnit);
  canvas.fill_rectangle({0.0, 0.0}, size, kPaper);
  const std::string name = name_with_dye(result.design, result.request.dye);
  const std::string title = name + ": what a driver sees at night";
  const bool fits = canvas.text_width(title, kTitleFont) <= width - 2.0 * kGap;
  for (const std::string& line :
       canvas.fitted(fits ? title : name, kTitleFont, width - 2.0 * kGap, 1, Ellipsis::middle))
    canvas.text({kGap, 23.0}, line, kTitleFont, kBright, Align::left);
  for (std::size_t k = 0; k < count; ++k)
    draw_view(&canvas, metrics, result, views[k], tone,
              {kGap + static_cast<double>(k % columns) * (view_size.width + kGap),
               kHead + static_cast<double>(k / columns) * (tallest + 1.5 * kGap)});
  double y = kHead + static_cast<double>(rows) * (tallest + 1.5 * kGap);
  for (const std::string& line : notes) {
    canvas.text({kGap, y}, line, kLineFont, kDim, Align::left);
    y += kLine;
  }
  if (has_bar(tone)) draw_luminance_bar(canvas, tone, {kGap, y}, std::min(480.0, width - 2.0 * kGap));
  return canvas.finish();
}

}  // namespace

std::string road_png(const RoadResult& result) {
  return drawn(result, result.views, road_tone(result));
}

std::string road_view_png(const RoadResult& result, std::size_t view) {
  return drawn(result, std::span(result.views).subspan(view, 1), road_tone(result));
}

FloatPicture road_picture(const RoadResult& result) {
  const std::size_t columns = result.scene.columns;
  FloatPicture picture;
  picture.columns = columns * result.views.size();
  picture.rows = result.scene.rows;
  // Adds a channel. `value` returns its value for a pixel.
  const auto add = [&](const char* name, const auto& value) {
    std::vector<double> values;
    for (std::size_t row = 0; row < picture.rows; ++row)
      for (const RoadView& view : result.views)
        for (std::size_t k = row * columns; k < (row + 1) * columns; ++k) values.push_back(value(view.picture, k));
    picture.add_channel(name, values);
  };
  add("Y", [](const RoadPixels& pixels, std::size_t k) { return pixels.luminance[k]; });
  add("reflected", [](const RoadPixels& pixels, std::size_t k) { return pixels.reflected[k]; });
  add("veil", [](const RoadPixels& pixels, std::size_t k) { return pixels.veil[k]; });
  for (std::size_t c = 0; c < 3; ++c)
    add(std::array{"R", "G", "B"}[c], [c](const RoadPixels& pixels, std::size_t k) { return pixels.rgb[k][c]; });
  picture.texts = picture_texts("road", result.design);
  picture.texts.emplace_back("retrace:unit", "cd/m2");
  picture.numbers = {{"retrace:field_deg", result.scene.field_deg}};
  if (!result.scene.lamp) picture.numbers.emplace_back("retrace:lamp_cd", result.scene.lamp_cd);
  return picture;
}

}  // namespace retrace::report
