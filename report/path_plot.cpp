#include "report/path_plot.h"

#include <algorithm>
#include <array>

#include "report/style.h"

namespace retrace::report {
namespace {

using geometry::Vec2;

constexpr Colour kMaterial{0.88, 0.88, 0.88};
constexpr std::array<Colour, 5> kColours = {kBlue, kVermilion, kBluishGreen, kReddishPurple, kBlack};
constexpr Font kPathRemarkFont{11.5, false};
constexpr Font kPathLabelFont{13.0, false};
constexpr Font kPathTickFont{11.0, false};
constexpr AxisStyle kPathAxis{.font = kPathTickFont, .x_label_gap = 17.0, .y_label_gap = 7.0, .baseline = 4.0};
constexpr double kPathPlanWidth = 560.0;
constexpr double kPathLeft = 74.0;
constexpr double kPathBelow = 52.0;
constexpr double kLegendLine = 20.0;

struct Box {
  Vec2 low = Vec2::Zero();
  Vec2 high = Vec2::Ones();
};

Box box_of(const PathPlot& plot) {
  std::vector<double> x;
  std::vector<double> y;
  const auto take = [&](const Vec2& p) {
    x.push_back(p.x());
    y.push_back(p.y());
  };
  for (const Vec2& p : plot.material) take(p);
  for (const PathKind& kind : plot.kinds)
    for (const auto& [from, to] : kind.moves) {
      take(from);
      take(to);
    }
  const Range across = drawable(extent_of(x).value_or(Range{0.0, 1.0}));
  const Range up = drawable(extent_of(y).value_or(Range{0.0, 1.0}));
  const double room = 0.04 * std::max(across.span(), up.span());
  return {{across.low - room, up.low - room}, {across.high + room, up.high + room}};
}

void draw_heading(Canvas& canvas, const PathPlot& plot, double figure_width) {
  draw_title(canvas, figure_width, plot.title, {kMargin, kMargin + kTitleFont.size}, Align::left);
  double y = kMargin + kTitleFont.size + added_title_height(plot.title, figure_width);
  for (const std::string& remark : plot.remarks) {
    y += kPathRemarkFont.size + 5.0;
    draw_within(canvas, figure_width - 2.0 * kMargin, Ellipsis::end, {kMargin, y}, remark, kPathRemarkFont, kFaint,
                Align::left);
  }
}

/// Draws the moves of one kind and their entry in the legend.
void draw_moves(Canvas& canvas, const PathPlot& plot, std::size_t k, const std::function<Point(const Vec2&)>& at,
                double legend_top) {
  Stroke stroke{kColours[k % kColours.size()], 0.9, {}};
  if (plot.kinds[k].dashed) stroke.dashes = {4.0, 3.0};
  for (const auto& [from, to] : plot.kinds[k].moves) canvas.line({at(from), at(to)}, stroke);
  const Point sample{kPathLeft + 140.0 * static_cast<double>(k % 4),
                     legend_top + kLegendLine * static_cast<double>(k / 4)};
  stroke.width = 2.0;
  canvas.line({sample, {sample.x + 24.0, sample.y}}, stroke);
  canvas.text({sample.x + 30.0, sample.y + 4.0}, plot.kinds[k].label, kPathTickFont, kText, Align::left);
}

}  // namespace

std::string render(const PathPlot& plot, PlotFormat format, double scale) {
  const Box box = box_of(plot);
  const Vec2 size = box.high - box.low;
  const double height = kPathPlanWidth * std::clamp(size.y() / size.x(), 0.15, 1.4);
  const double unit = std::min(kPathPlanWidth / size.x(), height / size.y());
  const double figure_width = kPathLeft + kPathPlanWidth + kMargin;
  const double top = kMargin + kTitleFont.size + added_title_height(plot.title, figure_width) + 14.0 +
                     (kPathRemarkFont.size + 5.0) * static_cast<double>(plot.remarks.size());
  const double legend_top = top + height + kPathBelow + 8.0;
  const Size figure{figure_width,
                    legend_top + kLegendLine * static_cast<double>((plot.kinds.size() + 3) / 4) + kMargin};
  Canvas canvas(format, figure, scale);
  canvas.fill_rectangle({0.0, 0.0}, figure, kWhite);
  draw_heading(canvas, plot, figure.width);

  const auto at = [&](const Vec2& p) {
    return Point{kPathLeft + (p.x() - box.low.x()) * unit, top + height - (p.y() - box.low.y()) * unit};
  };
  std::vector<Point> material;
  for (const Vec2& p : plot.material) material.push_back(at(p));
  if (!material.empty()) {
    canvas.fill({material}, kMaterial);
    canvas.line(material, {kAxis, 1.0, {}});
  }
  for (std::size_t k = 0; k < plot.kinds.size(); ++k) draw_moves(canvas, plot, k, at, legend_top);

  const AxisScale across{{box.low.x(), box.low.x() + kPathPlanWidth / unit}, kPathLeft, kPathLeft + kPathPlanWidth};
  const AxisScale up{{box.low.y(), box.low.y() + height / unit}, top + height, top};
  canvas.line({{kPathLeft, top}, {kPathLeft, top + height}, {kPathLeft + kPathPlanWidth, top + height}},
              {kAxis, 1.0, {}});
  draw_x_ticks(canvas, kPathAxis, across, make_ticks(across.values, 6), top + height);
  draw_y_ticks(canvas, kPathAxis, up, make_ticks(up.values, 6), kPathLeft);
  canvas.text({kPathLeft + 0.5 * kPathPlanWidth, top + height + 38.0}, plot.x_label, kPathLabelFont, kText,
              Align::centre);
  canvas.text({18.0, top + 0.5 * height}, plot.y_label, kPathLabelFont, kText, Align::centre, true);
  return canvas.finish();
}

}  // namespace retrace::report
