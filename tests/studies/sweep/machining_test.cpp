#include "studies/quantity/machining.h"

#include <gtest/gtest.h>

#include <cmath>

namespace retrace::studies::machining_test {
namespace {

TEST(Machining, SumOfCutsOneByOne) {
  const geometry::RtpElement element{0.3, 0.3, 90.0};
  const MachiningProcess process;
  const double facet_mm = 0.3 * std::sqrt(0.5);
  const double approach_mm = 0.2 * std::sqrt(2.0);
  double minutes = 0.0;
  int cuts = 0;
  for (double depth_mm = facet_mm - 0.010; depth_mm > 1e-9; depth_mm -= 0.015, ++cuts)
    minutes += (approach_mm + depth_mm + 0.1) / 50.0 + (approach_mm + depth_mm + 0.115) / 200.0 + 0.1 / 60.0;
  for (int cut = 0; cut < 4; ++cut)
    minutes += (approach_mm + facet_mm) / 20.0 + (approach_mm + facet_mm + 0.005) / 200.0 + 0.1 / 60.0;
  EXPECT_EQ(roughing_cuts(element, process), cuts);
  EXPECT_NEAR(seconds_per_element(element, process), 60.0 * minutes, 1e-9);
}

TEST(Machining, AWiderToolSavesPassesAndWidthAloneCostsNothing) {
  MachiningProcess process;
  const double one_pass_s = seconds_per_element({0.451, 0.451, 90.0}, process);
  EXPECT_EQ(seconds_per_element({0.451, 0.902, 90.0}, process), one_pass_s);  // the tool is as wide as the element
  process.tool_width_mm = 0.451;
  EXPECT_EQ(seconds_per_element({0.451, 0.902, 90.0}, process), 2.0 * one_pass_s);
  process.tool_width_mm = 0.9019995;  // narrower than the element by less than a nanometre
  EXPECT_EQ(seconds_per_element({0.451, 0.902, 90.0}, process), one_pass_s);
}

}  // namespace
}  // namespace retrace::studies::machining_test
