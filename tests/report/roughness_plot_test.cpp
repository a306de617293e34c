#include "report/results/result_plots.h"

#include <gtest/gtest.h>

#include "studies/roughness/roughness.h"

namespace retrace::report::roughness_plot_test {
namespace {

TEST(RoughnessPlot, HasACurveForEachLengthAndPointsForFacets) {
  studies::RoughnessResult result;
  result.design.title = "Brick";
  result.request.correlation_length_um = {5.0, 20.0};
  studies::FacetGroup process, first, second;
  process.name = "die";
  process.is_process = true;
  process.facets = 21;
  process.waviness_sa_nm = 32.93;
  first.table = second.table = "some/ten_facets.csv";
  result.measured = {process, first, second};
  for (const double length_um : result.request.correlation_length_um)
    for (const double sa_nm : {0.0, 10.0})
      result.points.push_back({sa_nm, 0.0, length_um, {}, 1.0 - 0.01 * sa_nm, 0.0});
  for (std::size_t k = 0; k < 3; ++k) result.points.push_back({10.0 * static_cast<double>(k), 0.0, 5.0, k, 0.5, 0.01});
  const LinePlot plot = roughness_plot(result);
  ASSERT_EQ(plot.series.size(), 4U);
  EXPECT_EQ(plot.series[0].label, "correlation length 5 µm");
  EXPECT_EQ(plot.series[1].label, "correlation length 20 µm");
  EXPECT_EQ(plot.series[1].y, (std::vector<double>{100.0, 90.0}));
  EXPECT_EQ(plot.series[2].label, "die: waviness Sa 32.9 nm, 21 facets");
  EXPECT_EQ(plot.series[3].label, "single facets: ten_facets");
  EXPECT_EQ(plot.series[3].x.size(), 2U);
  EXPECT_TRUE(plot.series[1].has_line);
  EXPECT_FALSE(plot.series[3].has_line) << "no line from one facet to the next";
  EXPECT_NE(plot.x_label.find("correlation length of 5 µm"), std::string::npos);
}

}  // namespace
}  // namespace retrace::report::roughness_plot_test
