#include "report/polar_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

#include "report/label_layout.h"
#include "report/results/result_plots.h"
#include "studies/photometry/photometry.h"

namespace retrace::report::polar_plot_test {
namespace {

PolarPlot sample() {
  PolarPanel panel{"V 0°, H 0°",
                   2.0,
                   21,
                   {},
                   {{0.0, 0.33, "300 mcd/lx", PolarMark::Kind::holds}, {0.0, 1.5, "2 mcd/lx", PolarMark::Kind::fails}}};
  for (int k = 0; k < 441; ++k) panel.values.push_back(std::exp(-0.01 * k));
  return {"A far field", "R_A", {panel, panel, panel, panel}};
}

TEST(PolarPlot, GivesTheSameBytesAgainInOneProcess) {
  const std::string svg = render_svg(sample());
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_EQ(svg, render_svg(sample()));
  const std::string png = render_png(sample());
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_EQ(png, render_png(sample()));
}

TEST(PolarPlot, DrawsEachKindOfMarkOtherwise) {
  std::set<std::string> drawings;
  for (const auto kind : {PolarMark::Kind::holds, PolarMark::Kind::open, PolarMark::Kind::fails}) {
    PolarPlot plot = sample();
    plot.panels[0].marks[0].kind = kind;
    drawings.insert(render_svg(plot));
  }
  EXPECT_EQ(drawings.size(), 3U);
}

TEST(PolarPlot, DrawsWhatHasNoValues) {
  EXPECT_FALSE(render_svg(PolarPlot{}).empty());
  PolarPlot plot = sample();
  plot.panels[0].values.assign(441, 0.0);
  plot.panels[1].values.assign(441, std::numeric_limits<double>::quiet_NaN());
  plot.panels[2].columns = 0;
  plot.panels[2].values.clear();
  EXPECT_FALSE(render_svg(plot).empty());
  EXPECT_THROW(render_png(plot, 0.0), std::invalid_argument);
}

/// A linear scale has contour lines at its ticks. They are drawn in addition to the pixels.
TEST(PolarPlot, DrawsContourLinesOnLinearScales) {
  const auto paths_of = [](PolarScale scale) {
    PolarPlot plot = sample();
    plot.scale = scale;
    const std::string svg = render_svg(plot);
    std::size_t count = 0;
    for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) ++count;
    return count;
  };
  EXPECT_GT(paths_of(PolarScale::linear), paths_of(PolarScale::decades));
  EXPECT_GT(paths_of(PolarScale::difference), paths_of(PolarScale::decades));
}

TEST(PolarPlot, LabelsOfMarksDoNotOverlap) {
  std::mt19937 random(5);
  for (int run = 0; run < 40; ++run) {
    PolarPanel panel = sample().panels[0];
    panel.marks.clear();
    // Directions within a small cone, so that labels next to their marks would overlap.
    std::uniform_real_distribution<double> direction(-0.15, 0.15);
    for (int k = 0; k < 3 + run % 12; ++k)
      panel.marks.push_back({direction(random), direction(random), "12345 mcd/lx", PolarMark::Kind::fails});
    const std::vector<LabelBox> boxes = mark_label_boxes(panel);
    ASSERT_EQ(boxes.size(), panel.marks.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_GT(boxes[i].size.width, 20.0);
      EXPECT_LT(std::abs(boxes[i].corner.x + 0.5 * boxes[i].size.width), 150.0) << "inside of the cell";
      for (std::size_t j = i + 1; j < boxes.size(); ++j) EXPECT_FALSE(boxes[i].overlaps(boxes[j])) << run;
      for (const PolarMark& mark : panel.marks) {
        const double per_deg = 125.0 / panel.radius_deg;
        const LabelBox centre{{per_deg * mark.right_deg - 1.0, -per_deg * mark.up_deg - 1.0}, {2.0, 2.0}};
        EXPECT_FALSE(boxes[i].overlaps(centre)) << "a label covers a mark";
      }
    }
  }
}

TEST(PolarPlot, ALabelWithRoomIsNextToItsMark) {
  const std::vector<PlacedLabel> labels =
      place_labels({{{0.0, 0.0}, 3.0, {40.0, 12.0}}, {{0.0, 50.0}, 3.0, {40.0, 12.0}}}, {}, {{-100, -100}, {200, 200}});
  for (const PlacedLabel& label : labels) {
    EXPECT_FALSE(label.has_leader);
    EXPECT_GT(label.box.corner.x, 3.0);
  }
  // Without room inside the bounds, labels are outside of them and have lines to their marks.
  const std::vector<PlacedLabel> outside =
      place_labels({{{0.0, 0.0}, 3.0, {40.0, 12.0}}, {{0.0, 0.0}, 3.0, {40.0, 12.0}}}, {}, {{-5, -5}, {10, 10}});
  EXPECT_FALSE(outside[0].box.overlaps(outside[1].box));
}

TEST(PhotometryPlot, MarksTheTestPointsOfEachDirection) {
  studies::PhotometryResult result;
  result.design.title = "Cubes";
  result.maps = {{0.0, 0.0, 2.0, 2, {1.0, 2.0, 3.0, 4.0}}, {10.0, 0.0, 2.0, 2, {1.0, 2.0, 3.0, 4.0}}};
  result.curves = {{20.0, {0.0, 1.0}, {1000.0, 0.0}}};
  for (const double v : {0.0, 10.0, 10.0}) {
    studies::PhotometricPoint point;
    point.test_point.v_deg = point.v_deg = v;
    point.test_point.observation_deg = 0.33;
    point.r_i_mcd_per_lx = 12.3;
    point.limit_mcd_per_lx = 20.0;
    result.points.push_back(point);
  }
  const PolarPlot field = far_field_plot(result);
  ASSERT_EQ(field.panels.size(), 2U);
  EXPECT_EQ(field.panels[1].title, "V 10°, H 0°");
  ASSERT_EQ(field.panels[1].marks.size(), 2U);
  EXPECT_EQ(field.panels[1].marks[0].label, "12 mcd/lx");
  EXPECT_EQ(field.panels[1].marks[0].up_deg, 0.33);
  EXPECT_EQ(field.panels[1].marks[0].kind, PolarMark::Kind::fails);
  result.points[1].lacks_diffraction = true;
  EXPECT_EQ(far_field_plot(result).panels[1].marks[0].kind, PolarMark::Kind::open);
  EXPECT_EQ(far_field_plot(result).panels[1].marks[1].kind, PolarMark::Kind::fails);
  const LinePlot curves = observation_plot(result);
  ASSERT_EQ(curves.series.size(), 1U);
  EXPECT_EQ(curves.series[0].label, "entrance angle β = 20°");
  EXPECT_TRUE(curves.y_is_logarithmic);
  EXPECT_EQ(curves.series[0].y, (std::vector<double>{1000.0, 0.0}));
  EXPECT_FALSE(render_svg(curves).empty());
}

}  // namespace
}  // namespace retrace::report::polar_plot_test
