#include "report/results/result_plots.h"

#include <gtest/gtest.h>

#include "report/plot_contents.h"
#include "studies/rre/rre.h"

namespace retrace::report::rre_plot_test {
namespace {

studies::RreResult result_of(const std::vector<std::string>& titles, const std::vector<double>& incidences_deg) {
  studies::RreResult result;
  for (std::size_t d = 0; d < titles.size(); ++d) {
    design::Design design;
    design.title = titles[d];
    result.designs.push_back(design);
    for (const double incidence_deg : incidences_deg) {
      studies::RrePoint point;
      point.design = d;
      point.incidence_deg = incidence_deg;
      point.acceptance_half_angle_deg = 0.5;
      point.rre = 0.1 * static_cast<double>(d) + 0.001 * incidence_deg;
      result.points.push_back(point);
    }
  }
  return result;
}

TEST(RrePlot, DesignsOfTheSameTitleAreCurvesOfTheirOwn) {
  const LinePlot plot = rre_plot(result_of({"Prisms", "Cubes", "Prisms"}, {0.0, 10.0}));
  ASSERT_EQ(plot.series.size(), 3U);
  EXPECT_EQ(plot.series[0].label, "Prisms (1)");
  EXPECT_EQ(plot.series[1].label, "Cubes");
  EXPECT_EQ(plot.series[2].label, "Prisms (2)");
  for (const Series& series : plot.series) EXPECT_EQ(series.x, (std::vector<double>{0.0, 10.0}));
  EXPECT_DOUBLE_EQ(plot.series[2].y[1], 21.0);
}

TEST(RrePlot, CurvesRunFromLeftToRight) {
  const LinePlot plot = rre_plot(result_of({"Prisms"}, {20.0, 0.0, -5.0, 10.0}));
  ASSERT_EQ(plot.series.size(), 1U);
  EXPECT_EQ(plot.title, "Prisms: retroreflective efficiency");
  EXPECT_EQ(plot.series[0].label, "");
  EXPECT_EQ(plot.series[0].x, (std::vector<double>{-5.0, 0.0, 10.0, 20.0}));
  EXPECT_DOUBLE_EQ(plot.series[0].y[3], 2.0);
}

/// Returns points of curves over incidence, for each combination of design, azimuth and cone.
std::vector<EfficiencyPoint> points_of(std::size_t designs, std::size_t azimuths, std::size_t cones, bool has_values) {
  std::vector<EfficiencyPoint> points;
  for (std::size_t d = 0; d < designs; ++d)
    for (std::size_t a = 0; a < azimuths; ++a)
      for (std::size_t c = 0; c < cones; ++c)
        for (const double incidence_deg : {0.0, 10.0}) {
          points.push_back({"n = " + std::to_string(d), incidence_deg, 10.0 * static_cast<double>(a),
                            0.5 * static_cast<double>(c + 1), 0.5, 0.0});
          if (has_values) points.back().design_value = static_cast<double>(d);
        }
  return points;
}

TEST(RrePlot, UpToEightCurvesHaveALegend) {
  const LinePlot plot = rre_plot(points_of(2, 4, 1, false));
  EXPECT_EQ(plot.series.size(), 8U);
  EXPECT_EQ(plot.scale_label, "");
  EXPECT_FALSE(plot.legend.has_value());
  EXPECT_EQ(plot.series[1].label, "n = 0, azimuth 10°");
}

TEST(RrePlot, ManyAzimuthsAreColoursOfAScale) {
  const LinePlot plot = rre_plot(points_of(1, 36, 1, false));
  ASSERT_EQ(plot.series.size(), 36U);
  EXPECT_EQ(plot.scale_label, "Azimuth (°)");
  ASSERT_TRUE(plot.legend.has_value());
  EXPECT_TRUE(plot.legend->empty());
  for (std::size_t k = 0; k < 36; ++k) EXPECT_EQ(plot.series[k].scale_value, 10.0 * static_cast<double>(k));
  const auto range = scale_range(plot);
  ASSERT_TRUE(range.has_value());
  EXPECT_EQ(range->low, 0.0);
  EXPECT_EQ(range->high, 350.0);
}

TEST(RrePlot, DashesDistinguishFewDesignsAtManyAzimuths) {
  const LinePlot plot = rre_plot(points_of(2, 12, 1, false));
  ASSERT_TRUE(plot.legend.has_value());
  ASSERT_EQ(plot.legend->size(), 2U);
  EXPECT_EQ(plot.legend->at(0).label, "n = 0");
  EXPECT_EQ(plot.legend->at(1).label, "n = 1");
  EXPECT_EQ(plot.series[11].look, 0U);
  EXPECT_EQ(plot.series[12].look, 1U);
  EXPECT_EQ(plot.series[12].scale_value, 0.0);
}

TEST(RrePlot, ManyDesignsAtManyAzimuthsHaveAColourEach) {
  const LinePlot plot = rre_plot(points_of(6, 12, 1, false));
  EXPECT_EQ(plot.scale_label, "");
  ASSERT_TRUE(plot.legend.has_value());
  ASSERT_EQ(plot.legend->size(), 6U);
  EXPECT_EQ(plot.legend->at(5).label, "n = 5, azimuth 0° to 110°");
}

TEST(RrePlot, DesignsThatDifferInANumberAreColoursOfAScale) {
  const LinePlot plot = rre_plot(points_of(12, 1, 1, true), "element.aperture_mm");
  EXPECT_EQ(plot.scale_label, "element.aperture_mm");
  EXPECT_EQ(plot.series[7].scale_value, 7.0);
  const LinePlot words = rre_plot(points_of(12, 1, 1, false));
  EXPECT_EQ(words.scale_label, "");
  EXPECT_FALSE(words.legend.has_value());
}

/// Returns polar maps of two designs with the same title.
/// \param second_cone acceptance cone of the second design
studies::RreResult maps_of_two(double second_cone) {
  studies::RreResult result;
  result.has_map = true;
  for (const std::size_t d : {0U, 1U}) {
    design::Design design;
    design.title = "Prisms";
    design.detector.acceptance_half_angle_deg = {d == 0 ? 0.5 : second_cone};
    result.designs.push_back(design);
    for (const double azimuth : {0.0, 120.0, 240.0})
      for (const double incidence : {0.0, 60.0}) {
        studies::RrePoint point;
        point.design = d;
        point.incidence_deg = incidence;
        point.azimuth_deg = azimuth;
        point.acceptance_half_angle_deg = design.detector.acceptance_half_angle_deg.front();
        point.rre = d == 0 ? 0.25 : 0.5;
        result.points.push_back(point);
      }
  }
  return result;
}

// Equal names of designs are numbered.
TEST(RreMapPlot, DesignsOfTheSameTitleHaveDifferentNames) {
  const studies::RreResult result = maps_of_two(0.5);
  const PolarPlot plot = rre_map_plot(result);
  ASSERT_EQ(plot.panels.size(), 2U);
  EXPECT_EQ(plot.panels[0].title, "Prisms (1)");
  EXPECT_EQ(plot.panels[1].title, "Prisms (2)");
  ASSERT_TRUE(rre_maps_can_be_compared(result));
  const PolarPlot difference = rre_map_difference_plot(result);
  EXPECT_EQ(difference.title, "Prisms (2) minus Prisms (1)");
  for (const double value : difference.panels.front().values) EXPECT_NEAR(value, 25.0, 1e-12);
}

TEST(RreMapPlot, OnlyCompleteMapsOfEqualConesCanBeCompared) {
  EXPECT_FALSE(rre_maps_can_be_compared(maps_of_two(1.0)));
  studies::RreResult incomplete = maps_of_two(0.5);
  incomplete.complete = false;
  incomplete.points.resize(3);
  EXPECT_FALSE(rre_maps_can_be_compared(incomplete));
  EXPECT_TRUE(rre_map_plot(incomplete).panels.empty());
}

}  // namespace
}  // namespace retrace::report::rre_plot_test
