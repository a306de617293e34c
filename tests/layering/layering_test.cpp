// Tests that the source tree obeys the order of folders and rooms (subfolders), and that the check finds violations.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/layering/layer_rules.h"

namespace retrace::layering::layering_test {
namespace fs = std::filesystem;
namespace {

const Rules& rules() {
  static const Rules read = read_rules(RETRACE_SOURCE_DIR "/tests/layering/layers.json");
  return read;
}

/// Fixture with a temporary source tree. It begins with a valid folder core/.
class SyntheticTree : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() / ("layering_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
    fs::remove_all(root_);
    add("core/error.h", "#pragma once\n#include <string>\n");
  }
  void TearDown() override { fs::remove_all(root_); }

  void add(const std::string& path, const std::string& content) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << content;
  }
  std::vector<std::string> found() const {
    std::vector<std::string> lines;
    for (const Violation& violation : check_tree(root_, rules())) lines.push_back(to_string(violation));
    return lines;
  }

  fs::path root_;
};

using Lines = std::vector<std::string>;

TEST(Layering, HoldsInTheSourceTree) {
  for (const Violation& violation : check_tree(RETRACE_SOURCE_DIR, rules())) ADD_FAILURE() << to_string(violation);
}

TEST(Layering, RulesHaveAnOrder) {
  const fs::path file = fs::temp_directory_path() / ("layering_rules_" + std::to_string(::getpid()) + ".json");
  std::ofstream(file)
      << R"({"folders": {"core": ["app"], "app": []}, "rooms": {}, "studies_that_see_fabrication": []})";
  EXPECT_THROW(read_rules(file), std::runtime_error);
  fs::remove(file);
}

TEST(Layering, RefusesAMissingTree) {
  EXPECT_THROW(check_tree("/no/such/tree", rules()), std::runtime_error);
}

TEST_F(SyntheticTree, WithoutCoreIsRefused) {
  fs::remove_all(root_ / "core");
  EXPECT_THROW(check_tree(root_, rules()), std::runtime_error);
  fs::create_directories(root_ / "core");
  EXPECT_THROW(check_tree(root_, rules()), std::runtime_error) << "a tree without a single source file";
}

TEST_F(SyntheticTree, ReadersOfPrograms) {
  add("fabrication/chisel/plan/plan.h", "#pragma once\n#include \"fabrication/job/job.h\"\n");
  add("fabrication/job/job.h", "#pragma once\n");
  add("fabrication/read/reader.cpp", "#include \"fabrication/chisel/plan/plan.h\"\n");
  add("fabrication/milling/mill.cpp", "#include \"fabrication/job/job.h\"\n");
  EXPECT_EQ(found(),
            (Lines{"fabrication/milling/mill.cpp:1: room fabrication/milling/ has no place in the order of rooms",
                   "fabrication/read/reader.cpp:1: fabrication/read/ may not include fabrication/chisel/plan/plan.h",
                   "fabrication/read/reader.cpp:1: what judges may not see fabrication/chisel/plan/plan.h"}));
}

TEST_F(SyntheticTree, PlannersAndJudgesDoNotSeeEachOther) {
  add("fabrication/program/program.h", "#pragma once\n");
  add("fabrication/check/findings.h", "#pragma once\n");
  add("fabrication/planing/part.h", "#pragma once\n");
  add("fabrication/planing/plan/zone_profile.h", "#pragma once\n#include \"fabrication/planing/part.h\"\n");
  add("fabrication/planing/check/check.h", "#pragma once\n#include \"fabrication/planing/part.h\"\n");
  add("fabrication/planing/check/mill.cpp",
      "#include \"fabrication/planing/check/check.h\"\n#include \"fabrication/planing/plan/zone_profile.h\"\n");
  add("fabrication/chisel/check/verify.cpp", "#include \"fabrication/program/program.h\"\n");
  add("fabrication/chisel/plan/plan.cpp", "#include \"fabrication/check/findings.h\"\n");
  add("fabrication/turning/plan/path.h", "#pragma once\n");
  add("fabrication/turning/surface.h", "#pragma once\n#include \"fabrication/turning/plan/path.h\"\n");
  add("fabrication/turning/check/inspection.cpp", "#include \"fabrication/turning/surface.h\"\n");
  EXPECT_EQ(found(),
            (Lines{"fabrication/chisel/check/verify.cpp:1: what judges may not see fabrication/program/program.h",
                   "fabrication/chisel/plan/plan.cpp:1: what plans may not see fabrication/check/findings.h",
                   "fabrication/planing/check/mill.cpp:2: what judges may not see "
                   "fabrication/planing/plan/zone_profile.h",
                   "fabrication/turning/check/inspection.cpp:1: what judges may not see "
                   "fabrication/turning/plan/path.h"}));
}

TEST_F(SyntheticTree, DesignsAndStudiesOfLightDoNotDependOnFabrication) {
  add("fabrication/job/job.h", "#pragma once\n");
  add("studies/fabrication/job_maker.h", "#pragma once\n#include \"fabrication/job/job.h\"\n");
  add("design/mask.cpp", "#include \"fabrication/job/job.h\"\n");
  add("studies/rre/rre.cpp", "#include \"studies/fabrication/job_maker.h\"\n");
  EXPECT_EQ(found(), (Lines{"design/mask.cpp:1: design/ may not include fabrication/job/job.h",
                            "studies/rre/rre.cpp:1: studies/rre/ may not include studies/fabrication/job_maker.h",
                            "studies/rre/rre.cpp:1: studies/rre/ may not see fabrication/job/job.h"}));
}

TEST_F(SyntheticTree, InOrderPasses) {
  add("geometry/part/part.h", "#include \"core/error.h\"\n#include <Eigen/Core>\n");
  add("geometry/check/closed.cpp", "#include <CGAL/Surface_mesh.h>\n#include \"geometry/check/closed.h\"\n");
  add("core/io/toml_file.cpp", "#include <toml++/toml.h>\n");
  add("raytrace/scene.cpp", "#include <embree3/rtcore.h>\n#include \"geometry/part/part.h\"\n");
  add("design/reader.cpp", "#include \"design/design.h\"\n");
  add("studies/rre/rre.cpp", "#include \"design/design.h\"\n#include \"raytrace/scene.h\"\n");
  add("report/plot.cpp", "#include <cairo.h>\n");
  add("app/main.cpp", "#include <CLI/CLI.hpp>\n#include \"report/plot.h\"\n#include \"studies/rre/rre.h\"\n");
  add("tests/anything.cpp", "#include <CGAL/Surface_mesh.h>\n#include \"app/main.h\"\n");
  add("build/release/generated.cpp", "#include \"nowhere.h\"\n");
  EXPECT_EQ(found(), Lines{});
}

TEST_F(SyntheticTree, UpwardIncludesAreNamedWithFileAndLine) {
  add("core/number.cpp", "// text\n\n  #  include \"geometry/part/part.h\"\n");
  add("materials/fresnel.cpp", "#include \"geometry/part/part.h\"\n");
  add("report/plot.cpp", "#include \"materials/fresnel.h\"\n");
  EXPECT_EQ(found(), (Lines{"core/number.cpp:3: core/ may not include geometry/part/part.h",
                            "materials/fresnel.cpp:1: materials/ may not include geometry/part/part.h",
                            "report/plot.cpp:1: report/ may not include materials/fresnel.h"}));
}

TEST_F(SyntheticTree, RoomsSeeOnlyWhatTheyMay) {
  add("design/reader.cpp", "#include \"studies/rre/rre.h\"\n");
  add("studies/inspect/inspect.cpp", "#include \"studies/rre/rre.h\"\n");
  add("studies/novel/novel.cpp", "#include \"studies/rre/rre.h\"\n");
  EXPECT_EQ(found(), (Lines{"design/reader.cpp:1: design/ may not include studies/rre/rre.h",
                            "studies/inspect/inspect.cpp:1: studies/inspect/ may not include studies/rre/rre.h",
                            "studies/novel/novel.cpp:1: room studies/novel/ has no place in the order of rooms"}));
}

TEST_F(SyntheticTree, FilesOfAFolderAreBelowItsRooms) {
  add("geometry/polygon.h", "#pragma once\n#include \"geometry/part/part.h\"\n");
  add("geometry/part/part.h", "#pragma once\n#include \"geometry/vec.h\"\n");
  EXPECT_EQ(found(), (Lines{"geometry/polygon.h:2: geometry/ may not include geometry/part/part.h"}));
}

TEST_F(SyntheticTree, TypesCountLikeTheirHeaders) {
  add("raytrace/exact/beam.h", "#pragma once\nnamespace retrace {\nstruct Beam {\n  struct Corner {};\n};\n}\n");
  add("raytrace/exact/walk.h", "template <class Value>\nclass RETRACE_API Walk final : public Beam {};\n");
  add("raytrace/light/light.h", "class Beam;  // Walk\nstruct Light;\nenum class Colour : int { red };\n");
  add("raytrace/faces/face.cpp",
      "const char* kText = \"Beam\";\nauto c = '\"';\nvoid meet(Walk& w, Corner& c, Light& l);\n");
  add("raytrace/observers/seen.cpp", "void see(Beam& beam);\n");
  add("core/colour.h", "enum class Colour : int;\n");
  EXPECT_EQ(found(), (Lines{"core/colour.h:1: core/ may not use Colour of raytrace/light/light.h",
                            "raytrace/faces/face.cpp:3: raytrace/faces/ may not use Walk of raytrace/exact/walk.h",
                            "raytrace/light/light.h:1: raytrace/light/ may not use Beam of raytrace/exact/beam.h"}));
}

TEST_F(SyntheticTree, TypesOfSeveralRoomsAreNotChecked) {
  add("raytrace/exact/beam.h", "struct Beam {};\nstruct Scene {};\nusing Value = double;\n");
  add("raytrace/paths/path.h",
      "struct Beam {};\nclass Path {\n  struct Scene;\n};\ntemplate <class Value>\nclass Sum {};\n");
  add("raytrace/light/light.cpp", "Beam beam;\nScene scene;\nValue value;\n");
  EXPECT_EQ(found(), Lines{});
}

TEST_F(SyntheticTree, TypesOfOtherSidesAndOfFabricationAreFound) {
  add("fabrication/chisel/plan/plan.h", "struct Plan {};\n");
  add("fabrication/chisel/check/verify.cpp", "Plan plan;\n");
  add("studies/rre/rre.cpp", "Plan plan;\n");
  EXPECT_EQ(found(),
            (Lines{"fabrication/chisel/check/verify.cpp:1: what judges may not see fabrication/chisel/plan/plan.h",
                   "studies/rre/rre.cpp:1: studies/rre/ may not see fabrication/chisel/plan/plan.h"}));
}

TEST_F(SyntheticTree, NamespacesOfHigherFolders) {
  add("geometry/part.cpp", "using namespace studies;\n");
  add("materials/index.cpp", "double n = geometry::index();\n// studies::\n");
  add("studies/rre/rre.cpp", "using geometry::Vec3;\n");
  EXPECT_EQ(found(), (Lines{"geometry/part.cpp:1: geometry/ may not use namespace studies",
                            "materials/index.cpp:1: materials/ may not use namespace geometry"}));
}

TEST_F(SyntheticTree, LibrariesStayInTheirRooms) {
  add("geometry/part/part.cpp", "#include <CGAL/Kernel.h>\n");
  add("raytrace/scene.h", "#include <embree3/rtcore.h>\n");
  add("raytrace/scene.cpp", "#include <toml++/toml.h>\n");
  add("studies/rre/rre.cpp", "#include <CLI/CLI.hpp>\n");
  add("report/canvas.h", "#include <cairo.h>\n");
  EXPECT_EQ(found(), (Lines{"geometry/part/part.cpp:1: CGAL may be included only in geometry/check/ or an io/ room",
                            "raytrace/scene.cpp:1: toml++ may be included only in core/io/",
                            "raytrace/scene.h:1: Embree may be included only in a .cpp file of raytrace/",
                            "report/canvas.h:1: cairo may be included only in a .cpp file of report/",
                            "studies/rre/rre.cpp:1: CLI11 may be included only in app/"}));
}

TEST_F(SyntheticTree, LibrariesDoNotLeakThroughHeaders) {
  add("core/io/node.h", "#include <toml++/toml.h>\n");
  add("core/toml_file.h", "#include \"core/error.h\"\n#include \"core/io/node.h\"\n");
  add("studies/rre/rre.cpp", "#include \"core/error.h\"\n#include \"core/toml_file.h\"\n");
  EXPECT_EQ(found(), (Lines{"core/toml_file.h:2: core/ may not include core/io/node.h",
                            "core/toml_file.h:2: core/io/node.h brings toml++ out of its room",
                            "studies/rre/rre.cpp:2: core/toml_file.h brings toml++ out of its room"}));
}

TEST_F(SyntheticTree, EveryFolderAndEveryIncludeHasAPlace) {
  add("misc/helper.cpp", "#include \"core/error.h\"\n");
  add("core/error.cpp", "#include \"error.h\"\n");
  EXPECT_EQ(found(), (Lines{"core/error.cpp:1: \"error.h\" is no path from the root of the source tree",
                            "misc/helper.cpp:1: folder misc/ has no place in the order of layers"}));
}

}  // namespace
}  // namespace retrace::layering::layering_test
