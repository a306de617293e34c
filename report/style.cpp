#include "report/style.h"

#include <algorithm>
#include <utility>

namespace retrace::report {

Colour colour_at(const ColourScale& scale, double fraction) {
  const double at = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(scale.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), scale.size() - 2);
  const double t = at - static_cast<double>(k);
  const Colour& a = scale[k];
  const Colour& b = scale[k + 1];
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue)};
}

void draw_colour_bar(Canvas& canvas, const ColourScale& scale, Point corner, Size size) {
  constexpr std::size_t kSteps = 128;
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < kSteps; ++i)
    colours.push_back(colour_at(scale, 1.0 - static_cast<double>(i) / static_cast<double>(kSteps - 1)));
  canvas.image(corner, size, 1, colours);
}

void draw_frame(Canvas& canvas, Point corner, Size size, double width) {
  const Point far{corner.x + size.width, corner.y + size.height};
  canvas.line({corner, {far.x, corner.y}, far, {corner.x, far.y}, corner}, {kAxis, width, {}});
}

void draw_within(Canvas& canvas, double width, Ellipsis ellipsis, Point baseline, std::string_view text, Font font,
                 Colour colour, Align align) {
  for (const std::string& line : canvas.fitted(text, font, width, 1, ellipsis))
    canvas.text(baseline, line, font, colour, align);
}

void draw_values(Canvas& canvas, Point corner, Size size, std::size_t columns, const std::vector<double>& values,
                 const std::function<Colour(double)>& colour) {
  std::vector<Colour> pixels;
  pixels.reserve(values.size());
  for (const double value : values) pixels.push_back(colour(value));
  canvas.image(corner, size, columns, pixels);
}

std::vector<double> with_reversed_rows(const std::vector<double>& values, std::size_t columns) {
  std::vector<double> reversed;
  reversed.reserve(values.size());
  for (std::size_t row = values.size() / columns; row-- > 0;) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
    reversed.insert(reversed.end(), first, first + static_cast<std::ptrdiff_t>(columns));
  }
  return reversed;
}

Canvas measuring_canvas() {
  return {Canvas::Format::png, {8.0, 8.0}, 1.0};
}

std::vector<std::string> title_lines(std::string_view title, double figure_width) {
  return measuring_canvas().fitted(title, kTitleFont, figure_width - 2.0 * kMargin, kMaxTitleLines, Ellipsis::middle);
}

double added_title_height(std::string_view title, double figure_width) {
  const std::size_t lines = title_lines(title, figure_width).size();
  return lines > 1 ? kTitleLineHeight * static_cast<double>(lines - 1) : 0.0;
}

void draw_title(Canvas& canvas, Size figure, std::string_view title) {
  draw_title(canvas, figure.width, title, {0.5 * figure.width, kMargin + kTitleFont.size}, Align::centre);
}

Colour contour_colour(Colour area) {
  return 0.3 * area.red + 0.6 * area.green + 0.1 * area.blue > 0.55 ? kText : kWhite;
}

void draw_title(Canvas& canvas, double figure_width, std::string_view title, Point baseline, Align align) {
  for (const std::string& line : title_lines(title, figure_width)) {
    canvas.text(baseline, line, kTitleFont, kText, align);
    baseline.y += kTitleLineHeight;
  }
}

std::vector<std::string> wrapped(const std::vector<std::string>& texts, Font font, double width) {
  constexpr int kMaxLines = 3;
  const Canvas canvas = measuring_canvas();
  std::vector<std::string> lines;
  for (const std::string& text : texts)
    for (std::string& line : canvas.fitted(text, font, width, kMaxLines, Ellipsis::end))
      lines.push_back(std::move(line));
  return lines;
}

void draw_x_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label) {
  canvas.line({at, {at.x, at.y + look.tick}}, {kAxis, look.width, {}});
  canvas.text({at.x, at.y + look.x_label_gap}, label, look.font, kText, Align::centre);
}

void draw_y_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label) {
  canvas.line({{at.x - look.tick, at.y}, at}, {kAxis, look.width, {}});
  canvas.text({at.x - look.y_label_gap, at.y + look.baseline}, label, look.font, kText, Align::right);
}

void draw_bar_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label) {
  canvas.line({at, {at.x + look.tick, at.y}}, {kAxis, look.width, {}});
  canvas.text({at.x + look.y_label_gap, at.y + look.baseline}, label, look.font, kText, Align::left);
}

void draw_x_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double y) {
  for (std::size_t k = 0; k < ticks.positions.size(); ++k)
    draw_x_tick(canvas, look, {scale.at(ticks.positions[k]), y}, ticks.labels[k]);
}

void draw_y_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double x) {
  for (std::size_t k = 0; k < ticks.positions.size(); ++k)
    draw_y_tick(canvas, look, {x, scale.at(ticks.positions[k])}, ticks.labels[k]);
}

void draw_bar_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double x) {
  for (std::size_t k = 0; k < ticks.positions.size(); ++k)
    draw_bar_tick(canvas, look, {x, scale.at(ticks.positions[k])}, ticks.labels[k]);
}

}  // namespace retrace::report
