// The page of `retrace report` and the drawings of results show the same plots.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "design/io/design_reader.h"
#include "report/page/sections.h"
#include "report/results/result_plots.h"
#include "studies/forces/forces_study.h"
#include "studies/forces/io/forces_files.h"
#include "studies/roughness/io/roughness_files.h"
#include "studies/roughness/roughness.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre.h"

namespace retrace::report::same_plots_test {
namespace {

/// Returns the plot that the page shows for one document.
LinePlot plot_on_page(const std::string& kind, const std::string& text) {
  const ResultDocument document{kind + ".json", kind, text.size(), nlohmann::ordered_json::parse(text)};
  for (const PageSection& section : study_page({"x", {document}, {}}, "").sections)
    if (!section.charts.empty()) return section.charts.front();
  return {};
}

/// Checks that two plots are the same. Standard errors are not compared, because the page does not show them.
void expect_same(const LinePlot& on_page, const LinePlot& drawn) {
  EXPECT_EQ(on_page.title, drawn.title);
  EXPECT_EQ(on_page.x_label, drawn.x_label);
  EXPECT_EQ(on_page.y_label, drawn.y_label);
  ASSERT_EQ(on_page.series.size(), drawn.series.size());
  for (std::size_t k = 0; k < drawn.series.size(); ++k) {
    EXPECT_EQ(on_page.series[k].label, drawn.series[k].label);
    EXPECT_EQ(on_page.series[k].has_line, drawn.series[k].has_line);
    EXPECT_EQ(on_page.series[k].x, drawn.series[k].x);
    EXPECT_EQ(on_page.series[k].y, drawn.series[k].y);
  }
}

design::Design prism(const std::string& title) {
  return design::parse_design(
      "title = \"" + title +
          "\"\n[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n[body]\n"
          "thickness_mm = 1\n",
      "d.toml");
}

TEST(SamePlots, Efficiency) {
  for (const std::size_t designs : {1U, 2U})
    for (const std::vector<double>& incidences : {std::vector{20.0, -5.0, 0.0}, std::vector{0.0}}) {
      studies::RreResult result;
      for (std::size_t d = 0; d < designs; ++d) {
        result.designs.push_back(prism(d == 0 ? "First" : "Second"));
        for (const double incidence_deg : incidences)
          for (const double azimuth_deg : {0.0, 30.0})
            for (const double cone_deg : {0.5, 1.0}) {
              studies::RrePoint point;
              point.design = d;
              point.incidence_deg = incidence_deg;
              point.azimuth_deg = azimuth_deg;
              point.acceptance_half_angle_deg = cone_deg;
              point.rre = 0.001 * (incidence_deg + azimuth_deg) + 0.1 * cone_deg;
              result.points.push_back(point);
            }
      }
      expect_same(plot_on_page("rre", studies::rre_json(result)), rre_plot(result));
    }
}

TEST(SamePlots, ManyCurvesAndEqualDesigns) {
  studies::RreResult result;
  for (std::size_t d = 0; d < 2; ++d) {
    result.designs.push_back(prism("Equal"));
    for (int azimuth = 0; azimuth < 12; ++azimuth)
      for (const double incidence_deg : {0.0, 10.0}) {
        studies::RrePoint point;
        point.design = d;
        point.incidence_deg = incidence_deg;
        point.azimuth_deg = 30.0 * azimuth;
        point.acceptance_half_angle_deg = 0.5;
        result.points.push_back(point);
      }
  }
  const LinePlot drawn = rre_plot(result);
  const LinePlot on_page = plot_on_page("rre", studies::rre_json(result));
  EXPECT_EQ(drawn.series.size(), 24U);
  expect_same(on_page, drawn);
  EXPECT_EQ(on_page.scale_label, drawn.scale_label);
  ASSERT_TRUE(on_page.legend.has_value() && drawn.legend.has_value());
  ASSERT_EQ(on_page.legend->size(), drawn.legend->size());
  for (std::size_t k = 0; k < drawn.legend->size(); ++k)
    EXPECT_EQ(on_page.legend->at(k).label, drawn.legend->at(k).label);
}

TEST(SamePlots, Roughness) {
  studies::RoughnessResult result;
  result.design = prism("Rough");
  studies::FacetGroup process, single;
  process.name = "die";
  process.is_process = true;
  process.facets = 21;
  process.waviness_sa_nm = 32.93;
  single.table = "some/ten_facets.csv";
  single.facets = 1;
  studies::FacetGroup process_of_one = process;
  process_of_one.name = "pin";
  process_of_one.facets = 1;
  result.measured = {process, single, process_of_one};
  for (const double length_um : {5.0, 20.0})
    for (const double sa_nm : {0.0, 10.0})
      result.points.push_back({sa_nm, 0.0, length_um, {}, 1.0 - 0.01 * sa_nm, 0.0});
  result.points.push_back({10.0, 32.93, 5.0, 0U, 0.5, 0.01});
  result.points.push_back({20.0, 0.0, 5.0, 1U, 0.4, 0.01});
  result.points.push_back({15.0, 32.93, 5.0, 2U, 0.45, 0.01});
  const LinePlot plot = roughness_plot(result);
  EXPECT_EQ(plot.series.size(), 5U);
  expect_same(plot_on_page("roughness", studies::roughness_json(result)), plot);
}

TEST(SamePlots, Forces) {
  studies::ForcesResult result;
  result.profile = {{.time_s = 0.0, .fx_n = 1.0}, {.time_s = 0.5, .fy_n = 2.0, .fz_n = -3.0}};
  expect_same(plot_on_page("forces", studies::forces_json(result)), forces_plot(result));
}

}  // namespace
}  // namespace retrace::report::same_plots_test
