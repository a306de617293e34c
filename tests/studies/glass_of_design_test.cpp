// Tests of designs whose material is a glass of a manufacturer's catalogue.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "design/io/design_document.h"
#include "design/io/design_json.h"
#include "design/io/design_reader.h"
#include "studies/inspect/inspect.h"
#include "studies/rre/rre.h"
#include "tests/support/refusals.h"

namespace retrace::studies::glass_of_design_test {
namespace {

namespace fs = std::filesystem;
using Overrides = std::vector<std::string>;

const fs::path kCatalogue = fs::path(RETRACE_SOURCE_DIR) / "tests/data/glasses.agf";
const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nextent = \"infinite\"\n[body]\n"
    "thickness_mm = 2\n";

design::Design design(const Overrides& overrides) {
  return design::parse_design(kPrisms, "d.toml", overrides);
}

Overrides with_glass(const std::string& name, Overrides more = {}) {
  more.push_back("body.catalogue=" + kCatalogue.string());
  more.push_back("body.material=" + name);
  return more;
}

Inspection inspected(const Overrides& overrides) {
  return inspect(design(overrides), materials::MaterialLibrary::shipped());
}

TEST(GlassOfDesign, IsTheShippedGlassOfThatName) {
  for (const Overrides& more : {Overrides{}, {"body.temperature_c=70"}, {"light.spectrum=A"}}) {
    Overrides shipped = more;
    shipped.push_back("body.material=N-BK7");
    EXPECT_EQ(inspected(with_glass("n-bk7", more)).refractive_index, inspected(shipped).refractive_index);
  }
  // The expected value is the index n_d, which the record NM of the catalogue contains.
  EXPECT_NEAR(inspected(with_glass("BASF5")).refractive_index, 1.603233, 2e-6);
  EXPECT_EQ(facts_of(inspected(with_glass("BASF5", {"light.wavelength_nm=300"})).warnings.at(0)),
            "index_extrapolated at d.toml");
}

TEST(GlassOfDesign, IsTraced) {
  RreSettings request;
  request.incidence_deg = {5.0};
  request.engine = raytrace::Engine::exact;
  const std::string index = shortest(inspected(with_glass("CAF2")).refractive_index);
  const RreStudy study({design(with_glass("CAF2")), design({"body.refractive_index=" + index})}, request);
  const std::vector<RrePoint> points = study.run().points;
  EXPECT_EQ(points.at(0).rre, points.at(1).rre);
}

TEST(GlassOfDesign, ItsFileIsTheDesigns) {
  const design::Design given = design(with_glass("CAF2"));
  ASSERT_EQ(given.files().size(), 1U);
  EXPECT_TRUE(fs::equivalent(given.files().front(), kCatalogue));
  EXPECT_EQ(design::to_json(given)["body"]["catalogue"], kCatalogue.string());
  const design::Design again = design::parse_design(design::design_text(given), "again.toml", {});
  EXPECT_EQ(again.substance.catalogue->file, given.substance.catalogue->file);
  EXPECT_FALSE(design({}).substance.catalogue);
}

TEST(GlassOfDesign, MayBeOfARecord) {
  const std::string record = std::string(RETRACE_SOURCE_DIR) + "/tests/data/refractiveindex/N-BK7.yml";
  const Overrides from_record = {"body.catalogue=" + record};
  EXPECT_EQ(design(from_record).substance.material, "N-BK7");
  EXPECT_NEAR(inspected(from_record).refractive_index, inspected({"body.material=N-BK7"}).refractive_index, 1e-9);
  EXPECT_EQ(inspected({"body.catalogue=" + record, "body.material=N-BK7"}).refractive_index,
            inspected(from_record).refractive_index);
  EXPECT_EQ(refusal_of([&] {
              design({"body.catalogue=" + record, "body.material=BASF5"});
            }),
            "--set body.material=BASF5: body.material");
  const design::Design again = design::parse_design(design::design_text(design(from_record)), "again.toml", {});
  EXPECT_EQ(again.substance.material, "N-BK7");
}

// If a glass catalogue or an index record contains doubtful data, the user gets warnings. The refractive index is still
// computed from these data.
TEST(GlassOfDesign, DoubtsAreWarnings) {
  const fs::path folder = fs::temp_directory_path() / "retrace_doubtful_glass";
  fs::create_directories(folder);
  const auto read = [&](const std::string& name, const std::string& text, const Overrides& more) {
    std::ofstream(folder / name) << text;
    Overrides overrides = {"body.catalogue=" + (folder / name).string()};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return inspected(overrides);
  };
  const std::string record =
      "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n    coefficients: 0 1.03961212 0.00600069867 "
      "0.231792344 0.0200179144 1.01046945 103.560653\n  - type: tabulated k\n    data: |\n        0.40 1e-8\n        "
      "0.50 -8e-10\n        0.70 1e-8\n";
  for (const Overrides& more : {Overrides{}, Overrides{"body.absorption_per_mm=0"}}) {
    const Inspection noisy = read("noisy.yml", record, more);
    EXPECT_NEAR(noisy.refractive_index, 1.5168, 1e-5);
    ASSERT_EQ(noisy.warnings.size(), 1U);
    EXPECT_EQ(facts_of(noisy.warnings.front()), "absorption_sample_ignored at TMP/noisy.yml:8: data");
  }
  const Inspection joined = read("joined.agf",
                                 "NM TESTK7 2 517642 1.516800 64.17 0 1\nCD 1.03961212E+00 6.00069867E-03 "
                                 "2.31792344E-01\n2.00179144E-02 1.01046945E+00 1.03560653E+02 0 0 0 0\nLD 0.3 2.5\n",
                                 {"body.material=TESTK7"});
  EXPECT_NEAR(joined.refractive_index, 1.5168, 1e-5);
  EXPECT_TRUE(joined.warnings.empty());
  const Inspection swapped = read("swapped.agf", "NM x 5 0 1.6 60\nCD 1.5\nLD 0.3 2.5\n", {"body.material=x"});
  ASSERT_EQ(swapped.warnings.size(), 1U);
  EXPECT_EQ(facts_of(swapped.warnings.front()), "index_disagrees at TMP/swapped.agf:1: NM");
  fs::remove_all(folder);
}

// The path of a catalogue is relative to the folder of the design.
TEST(GlassOfDesign, LiesBesideTheDesign) {
  const fs::path folder = fs::temp_directory_path() / "retrace_glass_of_design";
  fs::create_directories(folder);
  fs::copy_file(kCatalogue, folder / "g.agf", fs::copy_options::overwrite_existing);
  std::ofstream(folder / "d.toml") << kPrisms << "material = \"CAF2\"\ncatalogue = \"g.agf\"\n";
  const design::Design read = design::read_design(folder / "d.toml");
  EXPECT_EQ(read.substance.catalogue->file, folder / "g.agf");
  EXPECT_NEAR(inspect(read, materials::MaterialLibrary::shipped()).refractive_index, 1.433849, 2e-6);
  EXPECT_TRUE(design::with_absolute_path(read.substance.catalogue)->file.is_absolute());
  fs::remove_all(folder);
}

TEST(GlassOfDesign, BadInputIsRefused) {
  const auto complaint = [](const std::string& lines) {
    return refusal_of(
        [&] { inspect(design::parse_design(kPrisms + lines, "d.toml", {}), materials::MaterialLibrary::shipped()); });
  };
  const std::string here = "catalogue = \"" + kCatalogue.string() + "\"\n";
  EXPECT_EQ(complaint("catalogue = \"no.agf\"\n"), "d.toml:9: body.catalogue");
  EXPECT_EQ(complaint("catalogue = 3\n"), "d.toml:9: body.catalogue");
  EXPECT_EQ(complaint(here + "material = \"BASF6\"\n"), "d.toml:10: body.material");
  EXPECT_EQ(complaint(here), "d.toml:7: body.material");
  EXPECT_EQ(complaint(here + "material = \"BASF5\"\ntemperature_c = 30\n"), "d.toml:11: body.temperature_c");
  const fs::path bad = fs::temp_directory_path() / "retrace_bad.agf";
  std::ofstream(bad) << "NM x 2 0\nCD one\nLD 0.4 0.7\n";
  EXPECT_EQ(complaint("material = \"x\"\ncatalogue = \"" + bad.string() + "\"\n"), "d.toml:10: body.catalogue");
  fs::remove(bad);
}

}  // namespace
}  // namespace retrace::studies::glass_of_design_test
