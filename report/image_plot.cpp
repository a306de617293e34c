#include "report/image_plot.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/number_format.h"
#include "report/colour_scale.h"
#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Font kImageLabelFont{11.5, false};
constexpr Font kImageTickFont{10.5, false};

constexpr AxisStyle kImageBarAxis{.font = kImageTickFont, .tick = 4.0, .y_label_gap = 7.0, .baseline = 3.6};

constexpr double kRemarkHeight = 17.0;
constexpr double kPicture = 340.0;    ///< length of the longer side of a picture
constexpr double kPanelTop = 30.0;    ///< space for the title of a panel
constexpr double kImageBelow = 40.0;  ///< space for the scale bar
constexpr double kImageBarGap = 14.0;
constexpr double kImageBarWidth = 14.0;
constexpr double kBarTexts = 86.0;
constexpr int kBarSteps = 128;
constexpr double kImageDecades = 4.0;

/// Maps values to fractions of the colour scale.
struct ValueScale {
  double full = 1.0;
  bool is_logarithmic = false;

  double fraction(double value) const {
    if (!is_logarithmic) return value / full;
    return value > 0.0 ? 1.0 + std::log10(value / full) / kImageDecades : 0.0;
  }
};

ValueScale scale_of(const ImagePanel& panel) {
  double full = panel.full_value;
  if (!(full > 0.0) && !panel.values.empty()) full = *std::max_element(panel.values.begin(), panel.values.end());
  return {full > 0.0 ? full : 1.0, panel.is_logarithmic};
}

Colour colour_of(double fraction) {
  const auto [r, g, b] = light_colour(fraction);
  return {r, g, b};
}

Size picture_size(const ImagePanel& panel) {
  const double aspect = static_cast<double>(panel.columns) / static_cast<double>(panel.rows);
  // Narrow pictures are drawn with a minimum width.
  return aspect >= 1.0 ? Size{kPicture, std::max(8.0, kPicture / aspect)}
                       : Size{std::max(8.0, kPicture * aspect), kPicture};
}

double panel_width(const ImagePanel& panel) {
  return std::max(200.0, picture_size(panel).width) + kImageBarGap + kImageBarWidth + kBarTexts;
}

void draw_value_bar(Canvas& canvas, const ImagePanel& panel, const ValueScale& scale, Point corner, double height) {
  std::vector<Colour> colours;
  for (int k = 0; k < kBarSteps; ++k) colours.push_back(colour_of(1.0 - (k + 0.5) / kBarSteps));
  canvas.image(corner, {kImageBarWidth, height}, 1, colours);
  draw_frame(canvas, corner, {kImageBarWidth, height});
  const auto y_at = [&](double value) { return corner.y + height * (1.0 - scale.fraction(value)); };
  const double x = corner.x + kImageBarWidth;
  if (scale.is_logarithmic) {
    const double top = std::log10(scale.full);
    const Ticks ticks = decade_ticks({top - kImageDecades, top});
    for (std::size_t k = 0; k < ticks.positions.size(); ++k)
      draw_bar_tick(canvas, kImageBarAxis, {x, y_at(std::pow(10.0, ticks.positions[k]))}, ticks.labels[k]);
  } else {
    const Ticks ticks = make_ticks({0.0, scale.full}, height > 150.0 ? 5 : 2);
    for (std::size_t k = 0; k < ticks.positions.size(); ++k)
      draw_bar_tick(canvas, kImageBarAxis, {x, y_at(ticks.positions[k])}, ticks.labels[k]);
  }
  if (height > 150.0)
    canvas.text({x + kBarTexts - 22.0, corner.y + 0.5 * height}, panel.value_label, kImageLabelFont, kText,
                Align::centre, true);
}

void draw_scale_bar(Canvas& canvas, const ImagePanel& panel, Point corner, double picture_width) {
  if (panel.length_unit.empty()) return;
  const double length = scale_bar_length(panel.width);
  const double drawn = picture_width * length / panel.width;
  const double y = corner.y + 16.0;
  canvas.line({{corner.x, y}, {corner.x + drawn, y}}, {kText, 3.0, {}});
  const std::string gap = panel.length_unit == "°" ? "" : " ";
  canvas.text({corner.x + drawn + 8.0, y + 4.0}, shortest(length) + gap + panel.length_unit, kImageLabelFont, kText,
              Align::left);
}

/// Draws circles around the centre of a picture.
void draw_circles(Canvas& canvas, const ImagePanel& panel, Point corner, Size size) {
  constexpr int kSides = 180;
  for (const double radius : panel.circles) {
    const double drawn = radius * size.width / panel.width;
    std::vector<Point> points;
    for (int k = 0; k <= kSides; ++k) {
      const double angle = kTwoPi * k / kSides;
      points.push_back({corner.x + 0.5 * size.width + drawn * std::cos(angle),
                        corner.y + 0.5 * size.height + drawn * std::sin(angle)});
    }
    canvas.line(points, {kWhite, 1.0, {4.0, 3.0}});
  }
}

void draw(Canvas& canvas, const ImagePanel& panel, Point corner) {
  canvas.text({corner.x, corner.y + 16.0}, panel.title, kPanelFont, kText, Align::left);
  const ValueScale scale = scale_of(panel);
  const Point at{corner.x, corner.y + kPanelTop};
  const Size size = picture_size(panel);
  draw_values(canvas, at, size, panel.columns, panel.values,
              [&](double value) { return colour_of(scale.fraction(value)); });
  draw_circles(canvas, panel, at, size);
  draw_frame(canvas, at, size);
  draw_value_bar(canvas, panel, scale, {at.x + size.width + kImageBarGap, at.y}, size.height);
  draw_scale_bar(canvas, panel, {at.x, at.y + size.height}, size.width);
}

}  // namespace

double scale_bar_length(double width) {
  const double wanted = 0.25 * width;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  double best = decade;
  for (const double step : {2.0, 5.0, 10.0})
    if (std::abs(std::log(step * decade / wanted)) < std::abs(std::log(best / wanted))) best = step * decade;
  return best;
}

std::string render(const ImagePlot& plot, PlotFormat format, double scale) {
  double width = 2.0 * kMargin;
  double height = 0.0;
  for (const ImagePanel& panel : plot.panels) {
    width += panel_width(panel);
    height = std::max(height, kPanelTop + picture_size(panel).height + kImageBelow);
  }
  width = std::max(width, 420.0);
  const std::vector<std::string> remarks = wrapped(plot.remarks, kImageLabelFont, width - 2.0 * kMargin);
  const double added = added_title_height(plot.title, width);
  const double head = kMargin + 26.0 + added + kRemarkHeight * static_cast<double>(remarks.size());
  const Size size{std::ceil(width), std::ceil(head + height + 8.0)};
  Canvas canvas(format, size, scale);
  canvas.fill_rectangle({0.0, 0.0}, size, kWhite);
  draw_title(canvas, width, plot.title, {kMargin, kMargin + 12.0}, Align::left);
  for (std::size_t k = 0; k < remarks.size(); ++k)
    canvas.text({kMargin, kMargin + 32.0 + added + kRemarkHeight * static_cast<double>(k)}, remarks[k], kImageLabelFont,
                kText, Align::left);
  double x = kMargin;
  for (const ImagePanel& panel : plot.panels) {
    draw(canvas, panel, {x, head});
    x += panel_width(panel);
  }
  return canvas.finish();
}

}  // namespace retrace::report
