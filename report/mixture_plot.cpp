#include "report/mixture_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Font kMixtureFont{11.0, false};
constexpr double kZonePlan = 260.0, kMixtureTop = 62.0, kGoalRow = 20.0, kZoneColumn = 62.0, kGoalWidth = 176.0;
constexpr double kTotalWidth = 74.0, kPriceWidth = 60.0, kAsideOfPlan = 34.0, kZoneLine = 17.0;
constexpr double kBaseline = 0.36;  ///< distance from the centre of a text to its baseline, as a fraction of the font
                                    ///< size
/// Darkness of the background above which letters are white.
constexpr double kDarkGround = 0.55;

Colour colour_of_zone(std::size_t zone) {
  constexpr std::array<Colour, 7> kColours = {kBlue,   kVermilion, kBluishGreen, kReddishPurple,
                                              kOrange, kSkyBlue,   kFaint};
  return kColours[zone % kColours.size()];
}

Colour mixed_with_white(Colour colour, double share) {
  const auto mixed = [&](double channel) { return 1.0 - share * (1.0 - channel); };
  return {mixed(colour.red), mixed(colour.green), mixed(colour.blue)};
}

Size mixture_figure(const MixturePlot& plot) {
  const double matrix = kGoalWidth + kTotalWidth + kPriceWidth + kZoneColumn * static_cast<double>(plot.zones.size());
  const double rows = kGoalRow * static_cast<double>(plot.goals.size() + 1);
  const double plan = kZonePlan + 14.0 + kZoneLine * static_cast<double>(plot.zones.size());
  return {2.0 * kMargin + kZonePlan + kAsideOfPlan + matrix, kMixtureTop + std::max(rows, plan) + kMargin};
}

/// Draws the part as seen from the light, with its zones as stripes, and a legend with the cells of the zones.
void draw_zones(Canvas& canvas, const MixturePlot& plot) {
  double from = 0.0;
  for (std::size_t z = 0; z < plot.zones.size(); ++z) {
    const double height = kZonePlan * plot.zones[z].area_fraction;
    const double top = kMixtureTop + kZonePlan - from - height;
    canvas.fill_rectangle({kMargin, top}, {kZonePlan, height}, colour_of_zone(z));
    if (height > kMixtureFont.size + 2.0)
      draw_within(canvas, kZonePlan - 8.0, Ellipsis::end,
                  {kMargin + 0.5 * kZonePlan, top + 0.5 * height + kBaseline * kMixtureFont.size},
                  fmt::format("{:.1f} %", 100.0 * plot.zones[z].area_fraction), kMixtureFont, kWhite, Align::centre);
    from += height;
  }
  draw_frame(canvas, {kMargin, kMixtureTop}, {kZonePlan, kZonePlan});
  double baseline = kMixtureTop + kZonePlan + 14.0 + kMixtureFont.size;
  for (std::size_t z = 0; z < plot.zones.size(); ++z, baseline += kZoneLine) {
    canvas.fill_rectangle({kMargin, baseline - 9.0}, {10.0, 10.0}, colour_of_zone(z));
    draw_within(canvas, kZonePlan - 16.0, Ellipsis::end, {kMargin + 16.0, baseline},
                fmt::format("{}: {}", z + 1, plot.zones[z].label), kMixtureFont, kText, Align::left);
  }
}

/// Matrix with one row for each goal. A row contains the contributions of all zones, the total and the price of the
/// goal (its shadow price in the linear program). The larger the fraction that a zone contributes, the darker its cell.
class GoalMatrix {
 public:
  GoalMatrix(Canvas& canvas, const MixturePlot& plot)
      : canvas_(canvas), plot_(plot), left_(kMargin + kZonePlan + kAsideOfPlan) {
    first_column_ = left_ + kGoalWidth;
    total_ = first_column_ + kZoneColumn * static_cast<double>(plot.zones.size());
  }

  void draw() {
    for (std::size_t z = 0; z < plot_.zones.size(); ++z)
      write(fmt::format("zone {}", z + 1), first_column_ + kZoneColumn * (static_cast<double>(z) + 0.5), 0, kPanelFont,
            colour_of_zone(z), Align::centre);
    write(plot_.total_label, total_ + kTotalWidth - 8.0, 0, kPanelFont, kText, Align::right);
    write("price", total_ + kTotalWidth + kPriceWidth - 8.0, 0, kPanelFont, kText, Align::right);
    for (std::size_t k = 0; k < plot_.goals.size(); ++k) draw_goal(plot_.goals[k], k + 1);
  }

 private:
  double top_of(std::size_t row) const { return kMixtureTop + kGoalRow * static_cast<double>(row); }

  void write(const std::string& text, double x, std::size_t row, Font font, Colour colour, Align align) {
    const double width = align == Align::left ? kGoalWidth - 8.0 : kTotalWidth;
    draw_within(canvas_, width, Ellipsis::end, {x, top_of(row) + 0.5 * kGoalRow + kBaseline * font.size}, text, font,
                colour, align);
  }

  void draw_goal(const MixtureGoal& goal, std::size_t row) {
    const bool binds = goal.price > 0.0;
    write(goal.label, left_, row, {kMixtureFont.size, binds}, kText, Align::left);
    double all = 0.0;
    for (const double given : goal.contributions) all += std::max(0.0, given);
    for (std::size_t z = 0; z < goal.contributions.size(); ++z) {
      const double share = all > 0.0 ? std::max(0.0, goal.contributions[z]) / all : 0.0;
      const double x = first_column_ + kZoneColumn * static_cast<double>(z);
      canvas_.fill_rectangle({x + 1.0, top_of(row) + 1.0}, {kZoneColumn - 2.0, kGoalRow - 2.0},
                             mixed_with_white(colour_of_zone(z), share));
      write(fmt::format("{:.3g}", goal.contributions[z]), x + 0.5 * kZoneColumn, row, kMixtureFont,
            share > kDarkGround ? kWhite : kText, Align::centre);
    }
    write(goal.total, total_ + kTotalWidth - 8.0, row, {kMixtureFont.size, binds}, kText, Align::right);
    if (binds)
      write(fmt::format("{:.3f}", goal.price), total_ + kTotalWidth + kPriceWidth - 8.0, row, {kMixtureFont.size, true},
            kText, Align::right);
  }

  Canvas& canvas_;
  const MixturePlot& plot_;
  double left_;
  double first_column_ = 0.0;
  double total_ = 0.0;
};

}  // namespace

std::string render(const MixturePlot& plot, PlotFormat format, double scale) {
  Size figure = mixture_figure(plot);
  const double added = added_title_height(plot.title, figure.width);
  figure.height += added;
  Canvas canvas(format, figure, scale);
  canvas.fill_rectangle({0.0, 0.0}, figure, kWhite);
  draw_title(canvas, figure, plot.title);
  canvas.move_origin({0.0, added});
  draw_zones(canvas, plot);
  GoalMatrix(canvas, plot).draw();
  return canvas.finish();
}

}  // namespace retrace::report
