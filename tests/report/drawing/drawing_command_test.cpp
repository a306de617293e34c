// Tests of the drawings of `retrace inspect --out`, and of masks in all commands that trace light.
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace retrace::test::drawing_command_test {
namespace {

const std::string kDesign =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"aligned\"\nx_length_mm = 3\n"
    "y_length_mm = 2\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";

std::string with_mask(const std::string& mask) {
  std::string text = kDesign;
  return text.insert(text.find("[body]"), "mask = \"" + mask + "\"\n");
}

/// Returns a picture of 6 x 4 pixels.
std::string picture(const std::string& pixels) {
  return "P2\n6 4\n255\n" + pixels + "\n";
}

const std::string kAll = picture("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0");
// Mask that contains the upper left quarter of the part.
const std::string kQuarter =
    picture("0 0 0 255 255 255 0 0 0 255 255 255 255 255 255 255 255 255 255 255 255 255 255 255");

TEST(Drawings, InspectWritesThem) {
  const TemporaryFolder folder;
  folder.write("d.toml", kDesign);
  const Outcome outcome = retrace(folder, {"inspect", "d.toml", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"out/inspect.json", "out/plan.svg", "out/section.svg", "out/view.png"})
    EXPECT_FALSE(folder.read(name).empty()) << name;
  EXPECT_NE(folder.read("out/plan.svg").find(">base 0.5</text>"), std::string::npos);
  EXPECT_NE(folder.read("out/section.svg").find(">thickness 1</text>"), std::string::npos);
  EXPECT_TRUE(folder.read("out/view.png").starts_with("\x89PNG"));
  ASSERT_EQ(retrace(folder, {"inspect", "d.toml", "-o", "again"}).code, 0);
  for (const char* name : {"plan.svg", "section.svg", "view.png"})
    EXPECT_EQ(folder.read(std::string("out/") + name), folder.read(std::string("again/") + name));
}

TEST(Drawings, OfAMesh) {
  const TemporaryFolder folder;
  folder.write("d.toml", kDesign);
  ASSERT_EQ(retrace(folder, {"export", "d.toml", "part.stl"}).code, 0);
  folder.write("m.toml", "[part]\nmesh = \"part.stl\"\n[body]\nrefractive_index = 1.4917\n");
  const Outcome outcome = retrace(folder, {"inspect", "m.toml", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(folder.read("out/plan.svg").find(">x length 3</text>"), std::string::npos);
  EXPECT_NE(folder.read("out/section.svg").find(">depth 0.25</text>"), std::string::npos);
}

TEST(Drawings, NothingIsWrittenOverAnInput) {
  const TemporaryFolder folder;
  folder.write("plan.svg", kDesign);
  const Outcome outcome = retrace(folder, {"inspect", "plan.svg", "-o", "."});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(folder.read("plan.svg"), kDesign);
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
}

double rre_of(const TemporaryFolder& folder, const std::string& design, const std::string& engine) {
  Arguments arguments = {"rre", design, "--engine", engine, "--incidence", "3"};
  if (engine != "exact") arguments.insert(arguments.end(), {"--samples", "65536"});
  return retrace_json(folder, arguments)["points"][0]["rre"].get<double>();
}

/// A mask that contains the whole part has no effect. A mask with a quarter of the part returns about a quarter of the
/// light.
TEST(Masks, AreTraced) {
  const TemporaryFolder folder;
  folder.write("all.pgm", kAll);
  folder.write("quarter.pgm", kQuarter);
  folder.write("d.toml", kDesign);
  folder.write("all.toml", with_mask("all.pgm"));
  folder.write("quarter.toml", with_mask("quarter.pgm"));
  const double whole = rre_of(folder, "d.toml", "exact");
  EXPECT_NEAR(rre_of(folder, "all.toml", "exact"), whole, 1e-9);
  const double quarter = rre_of(folder, "quarter.toml", "exact");
  EXPECT_NEAR(quarter, 0.25 * whole, 0.02 * whole);
  EXPECT_NEAR(rre_of(folder, "quarter.toml", "embree"), quarter, 2e-3);
  const Json inspected = retrace_json(folder, {"inspect", "quarter.toml"});
  EXPECT_EQ(inspected["elements_full"], 6);
  EXPECT_EQ(inspected["design"]["array"]["mask"], "quarter.pgm");
  EXPECT_EQ(inspected["boundary"], "closed, free of self-intersections");
}

/// Row 0 of a picture has the largest y. The upper left quarter of the camera picture is therefore bright.
TEST(Masks, AreSeenByACamera) {
  const TemporaryFolder folder;
  folder.write("quarter.pgm", kQuarter);
  folder.write("d.toml", with_mask("quarter.pgm"));
  const Outcome outcome =
      retrace(folder, {"image", "d.toml", "--detector", "--pixels", "6", "--samples", "4096", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Outcome camera = retrace(folder, {"image", "d.toml", "--camera", "--pixels", "12x8", "--field-mm", "3",
                                          "--passes", "8", "--observation-deg", "0", "--json", "-"});
  ASSERT_EQ(camera.code, 0) << camera.err;
  const double mean = Json::parse(camera.out)["part_luminance_cd_per_m2"].get<double>();
  const Outcome whole = retrace(folder,
                                {"image", "-", "--camera", "--pixels", "12x8", "--field-mm", "3", "--passes", "8",
                                 "--observation-deg", "0", "--json", "-"},
                                kDesign);
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_GT(mean, 0.0);
  EXPECT_LT(mean, 0.5 * Json::parse(whole.out)["part_luminance_cd_per_m2"].get<double>());
}

TEST(Masks, AreExported) {
  const TemporaryFolder folder;
  folder.write("quarter.pgm", kQuarter);
  folder.write("d.toml", with_mask("quarter.pgm"));
  const Json json = retrace_json(folder, {"export", "d.toml", "part.stl"});
  // Expected volume: the plate, and six prisms of 0.5 x 0.25 / 2 x 0.5.
  EXPECT_NEAR(json["volume_mm3"].get<double>(), 3.0 * 2.0 * 1.0 + 6.0 * 0.5 * 0.25 / 2.0 * 0.5, 1e-9);
  EXPECT_EQ(json["elements_full"], 6);
}

TEST(Masks, WrongOnesAreRefused) {
  const TemporaryFolder folder;
  folder.write("small.pgm", "P2\n3 2\n255\n0 0 0 0 0 0\n");
  folder.write("d.toml", with_mask("small.pgm"));
  folder.write("all.pgm", kAll);
  folder.write("e.toml", with_mask("all.pgm"));
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"rre", "d.toml"}, "d.toml:9: array.mask"},
      {{"image", "d.toml", "--camera", "-o", "out"}, "d.toml:9: array.mask"},
      {{"inspect", "e.toml", "--set", "surface.angle_error_sigma_arcmin=1", "-o", "out"}, "e.toml:9: array.mask"},
      {{"rre", "e.toml", "--engine", "exact", "--derivatives"}, "e.toml:9: array.mask"},
      {{"inspect", "e.toml", "--json", "all.pgm"}, "--json"}};
  for (const auto& [arguments, place] : cases) EXPECT_EQ(refused_at(retrace(folder, arguments)), place);
  EXPECT_EQ(folder.read("all.pgm"), kAll);
  for (const std::string& name : folder.names()) EXPECT_FALSE(name.starts_with("out")) << name;
}

}  // namespace
}  // namespace retrace::test::drawing_command_test
