#include "report/results/result_plots.h"

#include <gtest/gtest.h>

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
  EXPECT_EQ(plot.series[0].label, "Prisms (design 0)");
  EXPECT_EQ(plot.series[1].label, "Cubes");
  EXPECT_EQ(plot.series[2].label, "Prisms (design 2)");
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

}  // namespace
}  // namespace retrace::report::rre_plot_test
