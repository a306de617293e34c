#include "report/surface_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

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

}  // namespace
}  // namespace retrace::report::surface_plot_test
