#include <gtest/gtest.h>

#include "tests/app/program.h"

// Tests of the lists of angles that --incidence reads.

namespace retrace::test::number_list_test {
namespace {

std::vector<double> angles(const std::string& list) {
  const TemporaryFolder folder;
  const Json json =
      retrace_json(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=32", "--incidence=" + list});
  std::vector<double> values;
  for (const Json& point : json["points"]) values.push_back(point["incidence_deg"].get<double>());
  return values;
}

void expect_refused(const std::string& list) {
  SCOPED_TRACE(list);
  const TemporaryFolder folder;
  const Outcome outcome =
      retrace(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=32", "-o", "out", "--azimuth", list});
  EXPECT_EQ(refused_at(outcome), "--azimuth");
  EXPECT_TRUE(folder.names().empty());
}

using Values = std::vector<double>;

TEST(NumberList, DefaultIsZero) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=32"});
  ASSERT_EQ(json["points"].size(), 1U);
  EXPECT_EQ(json["points"][0]["incidence_deg"], 0);
  EXPECT_EQ(json["points"][0]["azimuth_deg"], 0);
}

TEST(NumberList, MixesValuesAndRanges) {
  EXPECT_EQ(angles("7,-40:-30:5,3:1:-1,2.5e1"), (Values{7, -40, -35, -30, 3, 2, 1, 25}));
}

TEST(NumberList, ListThatBeginsWithAMinusMayStandByItself) {
  const TemporaryFolder folder;
  const Json json =
      retrace_json(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=32", "--incidence", "-10:10:10"});
  EXPECT_EQ(json["points"].size(), 3U);
}

TEST(NumberList, StopIsIncludedAndExact) {
  EXPECT_EQ(angles("0:0.3:0.1"), (Values{0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(angles("0:1:0.3"), (Values{0, 0.3, 0.6, 3 * 0.3})) << "a stop that no step reaches is none";
  EXPECT_EQ(angles("5:5:1"), (Values{5}));
}

TEST(NumberList, ValuesAreStartPlusMultiplesOfStep) {
  const Values values = angles("-1:1:0.1");
  ASSERT_EQ(values.size(), 21U);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) EXPECT_EQ(values[i], -1.0 + static_cast<double>(i) * 0.1);
  EXPECT_EQ(values.back(), 1.0);
}

TEST(NumberList, DuplicatesAreDropped) {
  EXPECT_EQ(angles("-40:-5:5,-5,-5:0:5,0,-0,+7,7.0"), (Values{-40, -35, -30, -25, -20, -15, -10, -5, 0, 7}));
}

TEST(NumberList, ListsThatSayNothingAreRefused) {
  expect_refused("");
  expect_refused("  ");
  expect_refused(",");
  expect_refused("1,,2");
  expect_refused("1,");
}

TEST(NumberList, RangesThatGoNowhereAreRefused) {
  expect_refused("5:1:1");
  expect_refused("1:5:-1");
  expect_refused("1:5:0");
  expect_refused("1:5");
  expect_refused("1:2:3:4");
  expect_refused("::");
}

TEST(NumberList, TextThatIsNoFiniteNumberIsRefused) {
  for (const char* list : {"nan", "inf", "-inf", "1e999", "a", "1a", "0x10", "1;2", "1 2", "0:nan:1", "0:1:inf"})
    expect_refused(list);
}

TEST(NumberList, HugeListsAreRefusedAtOnce) {
  expect_refused("0:1:1e-9");
  expect_refused("0:1e308:1e-308");
  expect_refused("0:60:0.001,0.0005:60:0.001");
}

}  // namespace
}  // namespace retrace::test::number_list_test
