#include "report/surface_plot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "report/results/result_plots.h"
#include "studies/closed_loop/verification.h"

namespace retrace::report::surface_plot_test {
namespace {

SurfacePlot sample() {
  GridPanel grid{"Grid", "height (nm)", 40, 30, 20.0, 15.0, {}};
  for (int i = 0; i < 1200; ++i) grid.values.push_back(std::sin(0.1 * i));
  grid.values[7] = std::numeric_limits<double>::quiet_NaN();
  GridPanel profile{"Profile", "height (nm)", 100, 1, 20.0, 0.2, {}};
  for (int i = 0; i < 100; ++i) profile.values.push_back(i == 50 ? NAN : std::cos(0.1 * i));
  LogPanel spectra{"Spectra", "f", "PSD", {{"one", {1.0, 10.0, 100.0}, {1e-3, 1e2, 0.0}}, {"none", {}, {}}}};
  return {"A surface", {grid, profile, spectra}};
}

TEST(SurfacePlot, GivesTheSameBytesAgainInOneProcess) {
  const std::string svg = render_svg(sample());
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_NE(svg.find("id=\"image1\""), std::string::npos) << "grids are pictures";
  EXPECT_EQ(svg, render_svg(sample()));
  const std::string png = render_png(sample());
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_EQ(png, render_png(sample()));
}

TEST(SurfacePlot, DrawsWhatHasNoValues) {
  SurfacePlot plot;
  plot.panels.push_back(GridPanel{"Empty", "z", 3, 2, 1.0, 1.0, std::vector<double>(6, NAN)});
  plot.panels.push_back(GridPanel{"Flat", "z", 3, 2, 1.0, 1000.0, std::vector<double>(6, 4.0)});
  plot.panels.push_back(GridPanel{"Wide", "z", 9000, 2, 1e6, 1e3, std::vector<double>(18000, 4.0)});
  plot.panels.push_back(LogPanel{"None", "x", "y", {}});
  EXPECT_FALSE(render_svg(plot).empty());
  EXPECT_FALSE(render_svg(SurfacePlot{}).empty());
  EXPECT_THROW(render_png(plot, 0.0), std::invalid_argument);
}

/// Returns the width and the height in the header of a PNG file.
std::array<std::uint32_t, 2> size_of_png(const std::string& png) {
  std::array<std::uint32_t, 2> size{};
  for (std::size_t k = 0; k < 8; ++k) size[k / 4] = size[k / 4] * 256 + static_cast<unsigned char>(png[16 + k]);
  return size;
}

TEST(SurfacePlot, ASinglePanelFillsTheFigure) {
  const GridPanel square{"", "z", 20, 20, 10.0, 10.0, std::vector<double>(400, 1.0)};
  const auto one = size_of_png(render_png(SurfacePlot{"Title", {square}}, 1.0));
  const auto two = size_of_png(render_png(SurfacePlot{"Title", {square, square}}, 1.0));
  EXPECT_LT(one[0], 700U);
  EXPECT_GT(two[0], 800U);
  GridPanel flat = square;
  flat.y_size_um = 1.0;
  EXPECT_LT(size_of_png(render_png(SurfacePlot{"Title", {flat}}, 1.0))[1] + 300U, one[1]) << "no empty area below";
}

TEST(SurfacePlot, LongTitlesAreWrapped) {
  const GridPanel grid{"", "z", 2, 2, 10.0, 10.0, std::vector<double>(4, 1.0)};
  std::string title = "A title";
  const auto size = [&] { return size_of_png(render_png(SurfacePlot{title, {grid}}, 1.0)); };
  const auto one_line = size();
  for (int k = 0; k < 12; ++k) title += " of many words";
  EXPECT_EQ(size()[0], one_line[0]);
  EXPECT_GT(size()[1], one_line[1] + 30U);
}

studies::ErrorMap error_map_with(double low_nm, double high_nm, double range_nm) {
  studies::ErrorMap map;
  map.field = {{-2.5, -1.0}, {5.0, 2.0}, 2, 2, {low_nm, high_nm, 0.0, NAN}};
  map.colour_range_nm = range_nm;
  return map;
}

TEST(ErrorMapPlot, UsesAUnitAndAScaleThatFitTheValues) {
  struct Case {
    double low_nm, high_nm, range_nm, limit;
    const char* unit;
  };
  for (const Case& c :
       {Case{-0.48, 0.31, 50.0, 0.5, "nm"}, Case{-3.0, 17.0, 50.0, 20.0, "nm"}, Case{-400.0, 9000.0, 50.0, 50.0, "nm"},
        Case{-1500.0, 700.0, 5000.0, 2.0, "µm"}, Case{0.0, 0.0, 50.0, 0.001, "nm"}}) {
    const SurfacePlot plot = error_map_plot(error_map_with(c.low_nm, c.high_nm, c.range_nm));
    ASSERT_EQ(plot.panels.size(), 1U);
    const auto& panel = std::get<GridPanel>(plot.panels[0]);
    EXPECT_NEAR(panel.deviation_limit, c.limit, 1e-9 * c.limit);
    EXPECT_NE(panel.value_label.find(fmt::format("({})", c.unit)), std::string::npos);
    ASSERT_EQ(plot.remarks.size(), 1U);
    EXPECT_NE(plot.remarks[0].find(fmt::format("-{:.3g} {}", c.limit, c.unit)), std::string::npos) << plot.remarks[0];
    const double per_nm = std::string(c.unit) == "nm" ? 1.0 : 1e-3;
    EXPECT_NEAR(panel.values[1], per_nm * c.high_nm, 1e-9);
    EXPECT_EQ(panel.lower_left_um, (std::array<double, 2>{-2500.0, -1000.0}));
  }
}

}  // namespace
}  // namespace retrace::report::surface_plot_test
