#include "report/map_plot.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "report/results/result_plots.h"
#include "studies/rre/rre.h"

namespace retrace::report::map_plot_test {
namespace {

using geometry::Polygon;
using geometry::Vec2;

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return geometry::to_polygon({{x0, y0}, {x1, y1}});
}

MapPlot plot_of(std::size_t panels, bool is_periodic = false) {
  MapPlot plot{"Title", "mm", "Efficiency (%)", "dead", 100.0, {}};
  for (std::size_t k = 0; k < panels; ++k) {
    MapPanel panel;
    panel.title = "incidence " + std::to_string(k);
    panel.remarks = {"remark"};
    panel.outline = rectangle(0.0, 0.0, 2.0, 1.0);
    panel.is_periodic = is_periodic;
    panel.lines = {{Vec2(1.0, 0.0), Vec2(1.0, 1.0)}};
    panel.regions = {{rectangle(0.0, 0.0, 1.0, 1.0), 90.0}, {rectangle(1.0, 0.0, 1.5, 1.0), 30.0}};
    plot.panels.push_back(panel);
  }
  return plot;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

bool is_svg(const std::string& text) {
  return text.starts_with("<?xml") && text.find("</svg>") != std::string::npos;
}

TEST(MapPlot, SameMapGivesTheSameBytes) {
  for (const bool is_periodic : {false, true}) {
    EXPECT_EQ(render_svg(plot_of(3, is_periodic)), render_svg(plot_of(3, is_periodic)));
    EXPECT_EQ(render_png(plot_of(3, is_periodic)), render_png(plot_of(3, is_periodic)));
  }
}

TEST(MapPlot, EveryRegionAndPanelShows) {
  const std::string whole = render_svg(plot_of(2));
  EXPECT_TRUE(is_svg(whole));
  MapPlot less = plot_of(2);
  less.panels[1].regions.pop_back();
  EXPECT_NE(render_svg(less), whole);
  less = plot_of(2);
  less.panels[1].regions[1].value = 60.0;
  EXPECT_NE(render_svg(less), whole);
  // The picture is wider if there are more panels in a row, and higher if there are more rows.
  const std::string three = render_png(plot_of(3), 1.0);
  const std::string twenty = render_png(plot_of(20), 1.0);
  EXPECT_GT(big_endian(three, 16), big_endian(render_png(plot_of(1), 1.0), 16));
  EXPECT_GT(big_endian(twenty, 20), 2 * big_endian(three, 20) - 200);
}

TEST(MapPlot, SurvivesDegenerateInput) {
  MapPlot plot = plot_of(5);
  plot.panels[0] = {};
  plot.panels[1].outline = rectangle(0.0, 0.0, 100.0, 0.5);
  plot.panels[2].outline = rectangle(0.0, 0.0, 0.5, 100.0);
  plot.panels[3].regions = {{{}, 1.0}, {rectangle(0.0, 0.0, 1e-9, 1e-9), 1e9}};
  plot.panels[4].regions.clear();
  EXPECT_TRUE(is_svg(render_svg(plot)));
  EXPECT_TRUE(is_svg(render_svg(MapPlot{})));
  EXPECT_THROW(render_png(plot, 0.0), std::invalid_argument);
}

studies::RreResult result_of(std::size_t directions) {
  studies::RreResult result;
  result.designs.resize(1);
  result.designs[0].title = "Prisms";
  result.faces.push_back({rectangle(0.0, 0.0, 2.0, 1.0), false, {}, {}});
  for (std::size_t k = 0; k < directions; ++k) {
    studies::Footprint footprint;
    footprint.regions = {{rectangle(0.0, 0.0, 1.0, 1.0), 0.5}};
    footprint.entrance_area_mm2 = 2.0;
    footprint.active_area_mm2 = 1.0;
    studies::ReturnedLight light;
    light.at.incidence_deg = -static_cast<double>(k);
    light.footprint = footprint;
    result.returned.push_back(light);
  }
  return result;
}

TEST(FootprintPlot, HasAPanelADirectionUpToItsCap) {
  const MapPlot plot = footprint_plot(result_of(2));
  ASSERT_EQ(plot.panels.size(), 2U);
  EXPECT_EQ(plot.title, "Prisms");
  EXPECT_EQ(plot.panels[1].title, "incidence \u22121°");
  EXPECT_EQ(plot.panels[1].remarks, (std::vector<std::string>{"50.0 % active, returns 25.0 %"}));
  EXPECT_EQ(plot.panels[1].regions.at(0).value, 50.0);
  EXPECT_EQ(footprint_plot(result_of(30)).panels.size(), kMaxFootprintPanels);
}

TEST(FootprintPlot, NamesDesignsWhereThereAreSeveral) {
  studies::RreResult result = result_of(1);
  result.designs.resize(2);
  const MapPlot plot = footprint_plot(result);
  EXPECT_EQ(plot.panels.at(0).title, "Prisms");
  EXPECT_EQ(plot.panels.at(0).remarks.at(0), "incidence 0°");
}

}  // namespace
}  // namespace retrace::report::map_plot_test
