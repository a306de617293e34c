#include "report/axis_ticks.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace retrace::report::axis_ticks_test {
namespace {

using Texts = std::vector<std::string>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MakeTicks, MarksRoundAngles) {
  const Ticks ticks = make_ticks({-40.0, 40.0}, 9);
  EXPECT_EQ(ticks.step, 10.0);
  EXPECT_EQ(ticks.positions, (std::vector<double>{-40, -30, -20, -10, 0, 10, 20, 30, 40}));
  EXPECT_EQ(ticks.labels, (Texts{"−40", "−30", "−20", "−10", "0", "10", "20", "30", "40"}));
}

TEST(MakeTicks, StaysInsideTheRange) {
  const Ticks ticks = make_ticks({-3.0, 7.0}, 5);
  EXPECT_EQ(ticks.positions, (std::vector<double>{-2, 0, 2, 4, 6}));
}

TEST(MakeTicks, WritesDecimalsAsTheStepNeeds) {
  const Ticks ticks = make_ticks({0.0, 0.6}, 6);
  EXPECT_EQ(ticks.labels, (Texts{"0.0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"}));
  EXPECT_EQ(ticks.positions[3], 0.3) << "multiples are the nearest double, not a running sum";
}

TEST(MakeTicks, WritesVeryLargeAndVerySmallWithAnExponent) {
  EXPECT_EQ(make_ticks({0.0, 2e9}, 4).labels, (Texts{"0", "0.5e9", "1.0e9", "1.5e9", "2.0e9"}));
  EXPECT_EQ(make_ticks({0.0, 4e-8}, 4).labels, (Texts{"0", "1e-8", "2e-8", "3e-8", "4e-8"}));
}

TEST(MakeLogTicks, MarksDecadesAndTheirMultiples) {
  const LogTicks ticks = make_log_ticks({-1.0, 5.0}, 9);
  EXPECT_EQ(ticks.decades.positions, (std::vector<double>{-1, 0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(ticks.decades.labels, (Texts{"10⁻¹", "10⁰", "10¹", "10²", "10³", "10⁴", "10⁵"}));
  ASSERT_EQ(ticks.minor.size(), 6U * 8U);
  for (std::size_t k = 0; k < ticks.minor.size(); ++k)
    EXPECT_NEAR(std::pow(10.0, ticks.minor[k]),
                (2.0 + static_cast<double>(k % 8)) * std::pow(10.0, std::floor(static_cast<double>(k) / 8.0) - 1.0),
                1e-9 * std::pow(10.0, ticks.minor[k]));
}

// The labels of one axis are either all digits or all superscripts.
TEST(MakeLogTicks, LabelsHaveOneForm) {
  EXPECT_EQ(make_log_ticks({-2.0, 1.5}, 9).decades.labels, (Texts{"0.01", "0.1", "1", "10"}));
  EXPECT_EQ(decade_ticks({-2.5, 1.0}).labels, (Texts{"0.01", "0.1", "1", "10"}));
  EXPECT_EQ(decade_ticks({3.0, 5.0}).labels, (Texts{"10³", "10⁴", "10⁵"}));
  EXPECT_EQ(decade_labels({-4, 0}), (Texts{"10⁻⁴", "10⁰"}));
}

TEST(MakeLogTicks, LabelsAFractionOfManyDecades) {
  const LogTicks ticks = make_log_ticks({-12.0, 8.0}, 8);
  EXPECT_LE(ticks.decades.labels.size(), 8U);
  EXPECT_EQ(ticks.decades.labels.back(), "10⁸");
  EXPECT_TRUE(ticks.minor.empty());
}

TEST(WholeDecades, ContainTheValuesUpToALimit) {
  const std::vector<double> logarithms = {0.3, 2.7, kNan, -kInfinity};
  const auto range = whole_decades(logarithms, 8);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->low, 0.0);
  EXPECT_EQ(range->high, 3.0);
  EXPECT_EQ(whole_decades(logarithms, 2)->low, 1.0);
  EXPECT_EQ(whole_decades(std::vector<double>{2.0}, 8)->span(), 1.0);
  EXPECT_FALSE(whole_decades(std::vector<double>{kNan}, 8));
}

TEST(MakeTicks, WidensARangeOfOnePoint) {
  const Ticks ticks = make_ticks({3.0, 3.0}, 6);
  ASSERT_GE(ticks.positions.size(), 2U);
  EXPECT_LT(ticks.positions.front(), 3.0);
  EXPECT_GT(ticks.positions.back(), 3.0);
}

TEST(MakeTicks, SurvivesWhatCannotBeDrawn) {
  for (const Range range : {Range{kNan, kNan}, Range{0.0, kInfinity}, Range{-1.7e308, 1.7e308}, Range{5.0, -5.0},
                            Range{1e-310, 2e-310}, Range{1.0, std::nextafter(1.0, 2.0)}}) {
    const Ticks ticks = make_ticks(range, 7);
    EXPECT_FALSE(ticks.positions.empty());
    EXPECT_LE(ticks.positions.size(), 9U);
    EXPECT_EQ(ticks.positions.size(), ticks.labels.size());
  }
}

TEST(MakeTicks, NarrowRangeBetweenCoarseTicksHasOne) {
  EXPECT_FALSE(make_ticks({-949.0, -908.0}, 2).positions.empty());
  EXPECT_FALSE(make_ticks({-949e-9, -908e-9}, 2).positions.empty());
}

TEST(MakeTicks, AreFewRisingNiceAndInsideForAnyRange) {
  const bool holds = rc::check([] {
    const double magnitude = std::pow(10.0, *rc::gen::inRange(-9, 10));
    const double low = magnitude * *rc::gen::inRange(-1000, 1000);
    const double span = magnitude * *rc::gen::inRange(1, 2000);
    const int most = *rc::gen::inRange(2, 12);
    const Ticks ticks = make_ticks({low, low + span}, most);
    RC_ASSERT(!ticks.positions.empty());
    RC_ASSERT(ticks.positions.size() <= static_cast<std::size_t>(most) + 1);
    RC_ASSERT(ticks.positions.size() == ticks.labels.size());
    const double mantissa = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
    RC_ASSERT(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 || std::abs(mantissa - 5) < 1e-9);
    for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
      RC_ASSERT(ticks.positions[i] >= low - 1e-5 * ticks.step);
      RC_ASSERT(ticks.positions[i] <= low + span + 1e-5 * ticks.step);
      if (i > 0) RC_ASSERT(ticks.positions[i] > ticks.positions[i - 1]);
      if (i > 0) RC_ASSERT(ticks.labels[i] != ticks.labels[i - 1]);
    }
  });
  EXPECT_TRUE(holds);
}

void expect_range(Range range, double low, double high) {
  EXPECT_DOUBLE_EQ(range.low, low);
  EXPECT_DOUBLE_EQ(range.high, high);
}

TEST(RoundedRange, StartsAtZeroWhenValuesSpreadWidely) {
  expect_range(rounded_range({7.3, 97.7}, {7, 98}, 6), 0, 100);
}

TEST(RoundedRange, IsSnugWhenValuesAreClose) {
  expect_range(rounded_range({90.4, 94.9}, {90.4, 94.9}, 7), 90, 95);
}

TEST(RoundedRange, KeepsValuesThatLieOnTicks) {
  expect_range(rounded_range({0, 100}, {0, 100}, 7), 0, 100);
}

TEST(RoundedRange, MakesRoomForErrorBarsThatWouldLeaveIt) {
  expect_range(rounded_range({0.0, 100}, {-0.01, 100.01}, 7), 0, 100);
  expect_range(rounded_range({0.0, 100}, {0.0, 112.0}, 7), 0, 120);
}

TEST(RoundedRange, HoldsNegativeValues) {
  expect_range(rounded_range({-3.2, 8.1}, {-3.2, 8.1}, 7), -4, 10);
}

TEST(RoundedRange, OfZerosStartsAtZero) {
  expect_range(rounded_range({0, 0}, {0, 0}, 7), 0, 1);
}

TEST(RoundedRange, IgnoresErrorsThatAreNoNumbers) {
  expect_range(rounded_range({0, 100}, {kNan, kInfinity}, 7), 0, 100);
}

TEST(ExtentOf, SkipsWhatIsNotFinite) {
  const std::vector<double> values = {kNan, 2.0, -kInfinity, -1.0, kInfinity};
  const auto extent = extent_of(values);
  ASSERT_TRUE(extent);
  expect_range(*extent, -1.0, 2.0);
  EXPECT_FALSE(extent_of(std::vector<double>{kNan}));
  EXPECT_FALSE(extent_of({}));
}

TEST(AxisScale, MapsEndsToEnds) {
  const AxisScale scale{{-40.0, 40.0}, 100.0, 20.0};
  EXPECT_DOUBLE_EQ(scale.at(-40.0), 100.0);
  EXPECT_DOUBLE_EQ(scale.at(40.0), 20.0);
  EXPECT_DOUBLE_EQ(scale.at(0.0), 60.0);
}

}  // namespace
}  // namespace retrace::report::axis_ticks_test
