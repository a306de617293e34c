// Tests of plots over a rectangular grid: levels of the colour scale, and drawings of zeros and missing values.
#include "report/contour_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace retrace::report::contour_plot_test {
namespace {

using Texts = std::vector<std::string>;

ContourPlot plot_of(std::vector<double> values, ContourScale scale = ContourScale::decades) {
  ContourPlot plot;
  plot.title = "title";
  plot.scale = scale;
  ContourPanel panel;
  panel.x = {0.0, 0.2, 2.0};
  panel.y = {0.0, 60.0};
  panel.values = std::move(values);
  panel.values.resize(6, panel.values.back());
  plot.panels.push_back(panel);
  return plot;
}

TEST(ContourPlot, LevelsAreRoundNumbersOfAtMostFourDecades) {
  const ContourLevels levels = contour_levels(plot_of({3.0, 700.0}));
  EXPECT_EQ(levels.labels, (Texts{"5", "10", "20", "50", "100", "200", "500"}));
  EXPECT_NEAR(levels.low, std::log10(3.0), 1e-12);
  EXPECT_NEAR(levels.high, std::log10(700.0), 1e-12);
  for (std::size_t k = 0; k < levels.positions.size(); ++k)
    EXPECT_NEAR(std::pow(10.0, levels.positions[k]), std::stod(levels.labels[k]), 1e-9);
  const ContourLevels with_zero = contour_levels(plot_of({0.0, 1000.0}));
  EXPECT_NEAR(with_zero.high - with_zero.low, 4.0, 1e-12);
  EXPECT_EQ(contour_levels(plot_of({1e6, 5e6})).labels, (Texts{"10⁶", "2·10⁶", "5·10⁶"}));
  EXPECT_FALSE(contour_levels(plot_of({100.0, 100.0})).labels.empty());
}

TEST(ContourPlot, RatiosHaveTheSameRangeInBothDirections) {
  const ContourLevels wide = contour_levels(plot_of({0.1, 2.0}, ContourScale::ratio));
  EXPECT_EQ(wide.low, -wide.high);
  EXPECT_EQ(wide.labels, (Texts{"0.1", "0.2", "0.5", "1", "2", "5", "10"}));
  const ContourLevels narrow = contour_levels(plot_of({0.95, 1.25}, ContourScale::ratio));
  EXPECT_NEAR(narrow.high, std::log10(1.25), 1e-12);
  EXPECT_EQ(narrow.labels.front(), "0.80");
}

TEST(ContourPlot, IsDrawnWithoutLight) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& values : {std::vector{0.0}, {kNan}, {kNan, 0.0, 5.0}})
    for (const ContourScale scale : {ContourScale::decades, ContourScale::ratio}) {
      const std::string svg = render_svg(plot_of(values, scale));
      EXPECT_NE(svg.find("</svg>"), std::string::npos);
      EXPECT_EQ(svg.find("nan"), std::string::npos);
    }
}

}  // namespace
}  // namespace retrace::report::contour_plot_test
