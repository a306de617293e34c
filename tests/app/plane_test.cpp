// Tests of `retrace plane`: its files, its exit codes, and input that is refused before anything is written.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/program.h"

namespace retrace::test::plane_test {
namespace {

const std::string kLens = example("planing/zone_lens_60ghz.toml");

TEST(Plane, WritesProgramsDrawingsAndItsDocument) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"plane", kLens, "--dialect=fanuc", "-o", "."});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = folder.json("planing.json");
  EXPECT_EQ(json["schema"], "retrace.planing/2");
  EXPECT_EQ(json["verdict"], "pass");
  const std::vector<std::string> names = folder.names();
  for (const char* name : {"profile.svg", "zones.svg", "form_error.svg", "profile.csv", "odd_zones_1.nc"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  EXPECT_NE(outcome.out.find("odd_zones_1.nc"), std::string::npos);
}

TEST(Plane, ALatheOfAPmacNeedsTheLinesOfItsSpindle) {
  const TemporaryFolder folder;
  const Outcome outcome =
      retrace(folder, {"plane", example("planing/round_zone_lens.toml"), "--dialect=pmac", "-o", "out"});
  EXPECT_EQ(refused_at(outcome), "examples/planing/round_zone_lens.toml:15: lathe.spindle_start");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Plane, BadInputIsOneLineAndNothingIsWritten) {
  const TemporaryFolder folder;
  folder.write("part.toml", "[element]\nkind = \"zone_lens\"\n");
  EXPECT_EQ(refused_at(retrace(folder, {"plane", "part.toml", "-o", "out"})), "part.toml:1: element.focal_length_mm");
  EXPECT_EQ(refused_at(retrace(folder, {"plane", kLens, "--dialect=heidenhain", "-o", "out"})), "--dialect");
  EXPECT_EQ(retrace(folder, {"plane", kLens, "--set", "element.width_mm=3", "-o", "out"}).code, 2);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"part.toml"});
}

}  // namespace
}  // namespace retrace::test::plane_test
