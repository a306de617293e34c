#include "report/path_plot.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/atomic_file.h"
#include "fabrication/machine/io/machine_files.h"
#include "report/results/result_plots.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::report::path_plot_test {
namespace {

using geometry::Vec2;

PathPlot plot_of_a_cut() {
  PathPlot plot;
  plot.title = "Title";
  plot.remarks = {"remark"};
  plot.x_label = "across (mm)";
  plot.y_label = "up (mm)";
  plot.material = {{-1.0, 0.0}, {0.0, -0.5}, {1.0, 0.0}, {1.0, -1.0}, {-1.0, -1.0}, {-1.0, 0.0}};
  plot.kinds = {{"plunge", false, {{Vec2(0.0, 1.0), Vec2(0.0, -0.5)}}},
                {"retract", true, {{Vec2(0.0, -0.5), Vec2(0.5, 1.0)}}}};
  return plot;
}

TEST(PathPlot, SamePathGivesTheSameBytes) {
  EXPECT_EQ(render_svg(plot_of_a_cut()), render_svg(plot_of_a_cut()));
  EXPECT_EQ(render_png(plot_of_a_cut()), render_png(plot_of_a_cut()));
}

TEST(PathPlot, EveryMoveShows) {
  const std::string whole = render_svg(plot_of_a_cut());
  EXPECT_TRUE(whole.starts_with("<?xml"));
  PathPlot less = plot_of_a_cut();
  less.kinds[1].moves.clear();
  EXPECT_NE(render_svg(less), whole);
  less = plot_of_a_cut();
  less.kinds[0].moves[0].second.x() = 0.1;
  EXPECT_NE(render_svg(less), whole);
  less = plot_of_a_cut();
  less.material.clear();
  EXPECT_NE(render_svg(less), whole);
}

TEST(PathPlot, NothingAtAllIsDrawn) {
  EXPECT_FALSE(render_svg(PathPlot{}).empty());
  EXPECT_THROW(render_png(PathPlot{}, 0.0), std::invalid_argument);
}

studies::FabricationResult result_of(fabrication::Strategy strategy, geometry::Arrangement arrangement) {
  studies::FabricationResult result;
  result.job.source = "j.toml";
  prism_of(result.job).base_mm = prism_of(result.job).width_mm = 0.5;
  result.job.array.arrangement = arrangement;
  result.job.array.x_length_mm = result.job.array.y_length_mm = 1.5;
  result.job.tool.width_mm = 0.5;
  result.job.strategy = strategy;
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml";
  result.machine = fabrication::parse_machine(read_file(file), file);
  result.plan = fabrication::make_plan(result.job, result.machine);
  return result;
}

TEST(FabricationPlot, DrawsTheWayThroughOneElement) {
  using fabrication::Strategy;
  const auto result = result_of(Strategy::two_step, geometry::Arrangement::checker);
  const PathPlot roughing = tool_path_plot(result, true);
  const auto cuts = static_cast<std::size_t>(result.plan.cuts_per_facet);
  EXPECT_EQ(roughing.kinds[0].moves.size(), cuts) << "plunges";
  EXPECT_EQ(roughing.kinds[1].moves.size(), cuts) << "ploughs";
  EXPECT_EQ(roughing.kinds[3].moves.size(), cuts - 1) << "to the next cut";
  const PathPlot finishing = tool_path_plot(result, false);
  EXPECT_EQ(finishing.kinds[0].moves.size(), 4U) << "two on either facet";
  EXPECT_TRUE(finishing.kinds[1].moves.empty());
  // The last plunges of both facets end at the root, which is the origin.
  EXPECT_LT(finishing.kinds[0].moves[2].second.norm(), 1e-3);
  EXPECT_LT(finishing.kinds[0].moves[3].second.norm(), 1e-3);
  // Facet 1 is on the left, facet 2 on the right.
  EXPECT_LT(finishing.kinds[0].moves[2].first.x(), -0.25);
  EXPECT_GT(finishing.kinds[0].moves[3].first.x(), 0.25);
}

TEST(FabricationPlot, DrawsEveryElementOnce) {
  const auto result = result_of(fabrication::Strategy::unidirectional, geometry::Arrangement::offset);
  const MapPlot plot = arrangement_plot(result);
  ASSERT_EQ(plot.panels.size(), 1U);
  ASSERT_EQ(plot.panels[0].regions.size(), 8U);
  double area = 0.0;
  double last = 0.0;
  for (const MapRegion& region : plot.panels[0].regions) {
    area += geometry::area(region.outline);
    last = std::max(last, region.value);
  }
  EXPECT_NEAR(area, 8 * 0.25, 1e-12);
  EXPECT_DOUBLE_EQ(last, 100.0);
  // Element 0 is in the lower left corner of the part.
  EXPECT_NEAR(geometry::bounding_box(plot.panels[0].regions[0].outline).lower.norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace retrace::report::path_plot_test
