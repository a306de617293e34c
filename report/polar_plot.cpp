#include "report/polar_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_format.h"
#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Colour kRing{0.85, 0.85, 0.85};
constexpr Colour kHolds{1.0, 1.0, 1.0};
constexpr Font kPolarLabelFont{12.0, false};
constexpr Font kPolarTickFont{10.0, false};
constexpr double kDisc = 250.0;  ///< diameter of a disc
constexpr Size kPolarCell{290.0, 304.0};
constexpr double kBarRoom = 96.0;
constexpr double kPolarBarWidth = 14.0;
constexpr std::size_t kMaxPerRow = 3;
/// Number of decades that the colour scale covers, downwards from the largest value.
constexpr double kPolarDecades = 4.0;

std::vector<Point> circle(Point centre, double radius) {
  constexpr int kCorners = 120;
  std::vector<Point> points;
  for (int k = 0; k <= kCorners; ++k) {
    const double a = 2.0 * std::numbers::pi * k / kCorners;
    points.push_back({centre.x + radius * std::cos(a), centre.y - radius * std::sin(a)});
  }
  return points;
}

/// Returns the range of the colour scale as decimal logarithms. It ends at the largest value and covers kPolarDecades.
Range decades_of(const PolarPlot& plot) {
  double largest = 0.0;
  for (const PolarPanel& panel : plot.panels)
    for (const double v : panel.values)
      if (std::isfinite(v)) largest = std::max(largest, v);
  if (!(largest > 0.0)) return {-kPolarDecades, 0.0};
  const double top = std::log10(largest);
  return {top - kPolarDecades, top};
}

void draw_disc(Canvas& canvas, const PolarPanel& panel, Point centre, Range decades) {
  const double radius = 0.5 * kDisc;
  std::vector<Colour> colours;
  for (std::size_t row = panel.columns; row-- > 0;)
    for (std::size_t column = 0; column < panel.columns; ++column) {
      const double v = panel.values[row * panel.columns + column];
      colours.push_back(colour_at(kViridis, v > 0.0 ? (std::log10(v) - decades.low) / decades.span() : 0.0));
    }
  if (colours.empty()) return;
  canvas.clip(circle(centre, radius));
  canvas.image({centre.x - radius, centre.y - radius}, {kDisc, kDisc}, panel.columns, colours);
  canvas.end_clip();
}

void draw_rings(Canvas& canvas, const PolarPanel& panel, Point centre) {
  const double scale = 0.5 * kDisc / panel.radius_deg;
  const Ticks ticks = make_ticks({0.0, panel.radius_deg}, 4);
  for (std::size_t k = 0; k < ticks.positions.size(); ++k) {
    if (!(ticks.positions[k] > 0.0)) continue;
    canvas.line(circle(centre, scale * ticks.positions[k]), {kRing, 0.7, {3.0, 3.0}});
    canvas.text({centre.x + 0.7071 * scale * ticks.positions[k] - 2.0, centre.y + 0.7071 * scale * ticks.positions[k]},
                ticks.labels[k] + "°", kPolarTickFont, kRing, Align::right);
  }
  canvas.line({{centre.x - 5.0, centre.y}, {centre.x + 5.0, centre.y}}, {kRing, 0.8, {}});
  canvas.line({{centre.x, centre.y - 5.0}, {centre.x, centre.y + 5.0}}, {kRing, 0.8, {}});
  canvas.line(circle(centre, 0.5 * kDisc), {kText, 1.0, {}});
}

struct PolarMarkStyle {
  Marker shape = Marker::circle;
  double outline = 4.6;
  double size = 3.4;
  Colour colour = kHolds;
};

PolarMarkStyle style_of(PolarMark::Kind kind) {
  switch (kind) {
    case PolarMark::Kind::holds: return {};
    case PolarMark::Kind::open: return {Marker::square, 5.2, 3.8, kSkyBlue};
    case PolarMark::Kind::fails: return {Marker::triangle, 6.2, 4.6, kOrange};
  }
  return {};
}

void draw_marks(Canvas& canvas, const PolarPanel& panel, Point centre) {
  const double scale = 0.5 * kDisc / panel.radius_deg;
  for (const PolarMark& mark : panel.marks) {
    const Point at{centre.x + scale * mark.right_deg, centre.y - scale * mark.up_deg};
    const PolarMarkStyle style = style_of(mark.kind);
    canvas.marker(at, style.shape, style.outline, kBlack);
    canvas.marker(at, style.shape, style.size, style.colour);
    canvas.text({at.x + 8.0, at.y + 3.6}, mark.label, kPolarTickFont, kWhite, Align::left);
  }
}

void draw_bar(Canvas& canvas, Point corner, Range decades, std::string_view label) {
  draw_colour_bar(canvas, kViridis, corner, {kPolarBarWidth, kDisc});
  const AxisScale scale{decades, corner.y + kDisc, corner.y};
  for (int e = static_cast<int>(std::ceil(decades.low)); e <= static_cast<int>(std::floor(decades.high)); ++e) {
    canvas.line({{corner.x + kPolarBarWidth, scale.at(e)}, {corner.x + kPolarBarWidth + 4.0, scale.at(e)}},
                {kText, 1.0, {}});
    const std::string text = e >= -3 && e <= 4 ? shortest(std::pow(10.0, e)) : fmt::format("1e{}", e);
    canvas.text({corner.x + kPolarBarWidth + 7.0, scale.at(e) + 3.6}, text, kPolarTickFont, kText, Align::left);
  }
  canvas.text({corner.x + kBarRoom - 24.0, corner.y + 0.5 * kDisc}, label, kPolarLabelFont, kText, Align::centre, true);
}

}  // namespace

std::string render(const PolarPlot& plot, PlotFormat format, double scale) {
  const std::size_t abreast = std::clamp<std::size_t>(plot.panels.size(), 1, kMaxPerRow);
  const std::size_t rows = std::max<std::size_t>(1, (plot.panels.size() + abreast - 1) / abreast);
  const Size size{2.0 * kMargin + static_cast<double>(abreast) * kPolarCell.width + kBarRoom,
                  2.0 * kMargin + 24.0 + static_cast<double>(rows) * kPolarCell.height};
  Canvas canvas(format, size, scale);
  canvas.fill_rectangle({0.0, 0.0}, size, kWhite);
  draw_title(canvas, size, plot.title);
  const Range decades = decades_of(plot);
  for (std::size_t k = 0; k < plot.panels.size(); ++k) {
    const PolarPanel& panel = plot.panels[k];
    const Point cell{kMargin + kPolarCell.width * static_cast<double>(k % abreast),
                     kMargin + 24.0 + kPolarCell.height * static_cast<double>(k / abreast)};
    const Point centre{cell.x + 0.5 * kPolarCell.width, cell.y + 34.0 + 0.5 * kDisc};
    canvas.text({centre.x, cell.y + 24.0}, panel.title, kPanelFont, kText, Align::centre);
    draw_disc(canvas, panel, centre, decades);
    draw_rings(canvas, panel, centre);
    draw_marks(canvas, panel, centre);
  }
  draw_bar(canvas, {kMargin + static_cast<double>(abreast) * kPolarCell.width + 10.0, kMargin + 58.0}, decades,
           plot.value_label);
  return canvas.finish();
}

}  // namespace retrace::report
