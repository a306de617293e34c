#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

// Tests of commands on parts that are given as STL files.

namespace retrace::test::mesh_command_test {
namespace {

const std::string kArray =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\nx_length_mm = 2\n"
    "y_length_mm = 2\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";
const std::string kMesh = "[part]\nmesh = \"part.stl\"\n[body]\nrefractive_index = 1.4917\n";

void export_part(const TemporaryFolder& folder, const std::string& design) {
  folder.write("direct.toml", design);
  folder.write("mesh.toml", kMesh);
  ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.stl", "--quiet"}).code, 0);
}

std::vector<double> rre(const TemporaryFolder& folder, Arguments arguments) {
  std::vector<double> values;
  const Json result = retrace_json(folder, std::move(arguments));
  for (const Json& p : result.at("points")) {
    values.push_back(p.at("rre"));
    EXPECT_LT(p.at("ledger").at("lost"), 1e-9);
  }
  return values;
}

/// A part and its mesh return the same light with the exact engine, except for the effect of the single precision of
/// STL.
TEST(MeshPart, SendsBackWhatTheDesignItWasMadeOfDoes) {
  const TemporaryFolder folder;
  export_part(folder, kArray);
  const Arguments how = {"--engine",
                         "exact",
                         "--cutoff",
                         "1e-6",
                         "--incidence=0,12",
                         "--set",
                         "detector.acceptance_half_angle_deg=[0.5, 3]"};
  Arguments direct = {"rre", "direct.toml"};
  Arguments mesh = {"rre", "mesh.toml"};
  direct.insert(direct.end(), how.begin(), how.end());
  mesh.insert(mesh.end(), how.begin(), how.end());
  const auto expected = rre(folder, direct);
  const auto found = rre(folder, mesh);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.size(), 4U);  // two directions with two cones each
  // A beam that hits a single triangle is weaker than a beam that hits a whole facet. The mesh and the design therefore
  // have different beams below the cut-off.
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 2e-4);
}

TEST(MeshPart, MonteCarloAgreesOnCubeCornersWithinItsError) {
  const TemporaryFolder folder;
  export_part(
      folder,
      "[element]\nkind = \"triangular_icc\"\naperture_mm = 1\n[array]\nx_length_mm = 4\ny_length_mm = 4\n[body]\n"
      "thickness_mm = 1\nrefractive_index = 1.4917\n");
  const auto result = [&](const char* design) {
    return retrace_json(folder, {"rre", design, "--engine", "embree", "--samples", "131072", "--incidence=10"})
        .at("points")
        .at(0);
  };
  const Json direct = result("direct.toml");
  const Json mesh = result("mesh.toml");
  const double error = std::hypot(direct.at("std_error").get<double>(), mesh.at("std_error").get<double>());
  EXPECT_NEAR(mesh.at("rre").get<double>(), direct.at("rre").get<double>(), 5.0 * error);
}

/// Returns a binary STL file in which each triangle of `stl` is divided into four.
std::string in_quarters(const std::string& stl) {
  using Corner = std::array<float, 3>;
  constexpr std::size_t kHeader = 84, kNormal = 12, kTriangle = 50;
  std::string out = stl.substr(0, kHeader);
  const auto count = static_cast<std::uint32_t>(4 * ((stl.size() - kHeader) / kTriangle));
  std::memcpy(out.data() + 80, &count, sizeof count);
  for (std::size_t at = kHeader; at < stl.size(); at += kTriangle) {
    std::array<Corner, 3> corners;
    std::memcpy(corners.data(), stl.data() + at + kNormal, sizeof corners);
    std::array<Corner, 3> middles;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        middles[k][axis] = 0.5F * (corners[k][axis] + corners[(k + 1) % 3][axis]);
    std::array<std::array<Corner, 3>, 4> quarters = {middles};
    for (std::size_t k = 0; k < 3; ++k) quarters[k + 1] = {corners[k], middles[k], middles[(k + 2) % 3]};
    for (const auto& quarter : quarters) {
      std::string triangle = stl.substr(at, kTriangle);
      std::memcpy(triangle.data() + kNormal, quarter.data(), sizeof quarter);
      out += triangle;
    }
  }
  return out;
}

/// Returns the luminance of a part in a camera picture, followed by the luminances of two such parts that are mounted
/// on a car ahead.
std::vector<double> seen_of(const TemporaryFolder& folder, const std::string& design) {
  std::vector<double> values = {
      retrace_json(folder, {"image", design, "--camera", "--passes", "8", "--pixels", "60x60", "-o", "camera"})
          .at("part_luminance_cd_per_m2")};
  const Json road = retrace_json(folder, {"image", design, "--road", "--road-distance-m", "100", "-o", "road"});
  for (const Json& reflector : road.at("views").at(0).at("reflectors"))
    values.push_back(reflector.at("luminance_cd_per_m2"));
  return values;
}

TEST(MeshPart, CamerasAndRoadsSeeTheDesignItWasMadeOf) {
  const TemporaryFolder folder;
  export_part(folder,
              "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2\n[array]\narrangement = \"single\"\n[body]\n"
              "thickness_mm = 1\nrefractive_index = 1.4917\n[surface]\ndihedral_error_arcmin = 1\n");
  const std::vector<double> expected = seen_of(folder, "direct.toml");
  for (const bool is_divided : {false, true}) {
    if (is_divided) folder.write("part.stl", in_quarters(folder.read("part.stl")));
    const std::vector<double> found = seen_of(folder, "mesh.toml");
    ASSERT_EQ(found.size(), expected.size());
    // Weak beams are resampled at random, which changes luminances on a road by up to 1 %. Rounding the file to
    // single precision has a smaller effect. Without the division of meshes into plane regions, luminances are 33 %
    // too high.
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k] / expected[k], 1.0, 0.03) << k << is_divided;
  }
}

TEST(MeshPart, IsInspectedAndExportedAgain) {
  const TemporaryFolder folder;
  export_part(folder, kArray);
  const Json json = retrace_json(folder, {"inspect", "mesh.toml"});
  EXPECT_EQ(json.at("boundary"), "closed, free of self-intersections");
  EXPECT_NEAR(json.at("thickness_mm").get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(json.at("entrance_area_mm2").get<double>(), 4.0, 1e-6);
  EXPECT_EQ(json.at("design").at("part").at("mesh"), "part.stl");
  EXPECT_FALSE(json.contains("elements_full"));
  EXPECT_EQ(retrace(folder, {"export", "mesh.toml", "again.step", "--quiet"}).code, 0);
  EXPECT_EQ(retrace(folder, {"inspect", "mesh.toml"}).code, 0);
}

/// Writes the part without one of its triangles.
void write_open(const TemporaryFolder& folder) {
  std::string stl = folder.read("part.stl");
  stl.resize(stl.size() - 50);
  --stl[80];
  folder.write("part.stl", stl);
}

TEST(MeshPart, AnOpenOneIsRefusedUnlessOneInsists) {
  const TemporaryFolder folder;
  export_part(folder, kArray);
  write_open(folder);
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "mesh.toml", "-o", "out"})), "mesh.toml:2: part.mesh");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"direct.toml", "mesh.toml", "part.stl"}));
  const Outcome insisted =
      retrace(folder, {"rre", "mesh.toml", "--set", "part.allow_open=true", "--samples", "4096", "--json", "r.json"});
  EXPECT_EQ(insisted.code, 0) << insisted.err;
  EXPECT_EQ(warnings_of(insisted).size(), 1U) << insisted.err;
  const Json json = folder.json("r.json");
  EXPECT_EQ(json.at("warnings"), Json(warnings_of(insisted)));
}

/// Returns the triangles of a box as ASCII STL. The corners 0 to 3 are the bottom face: (low x, low y), (high x, low
/// y), (high x, high y) and (low x, high y), all at low z. The corners 4 to 7 are above them in the same order, at high
/// z.
/// \param order permutation of the corners: corner k of a triangle is written at the position of corner order[k]
std::string box_facets(const std::array<double, 3>& low, const std::array<double, 3>& high,
                       const std::array<int, 8>& order = {0, 1, 2, 3, 4, 5, 6, 7}) {
  constexpr int kTriangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                     {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  std::string text;
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0 outer loop";
    for (const int corner : triangle) {
      const int k = order[static_cast<std::size_t>(corner)];
      const bool is_far[3] = {k % 4 == 1 || k % 4 == 2, k % 4 >= 2, k >= 4};
      text += " vertex";
      for (std::size_t axis = 0; axis < 3; ++axis) text += " " + std::to_string(is_far[axis] ? high[axis] : low[axis]);
    }
    text += " endloop endfacet\n";
  }
  return text;
}

TEST(MeshPart, BodiesThatCrossAreUnitedWithAWarning) {
  const TemporaryFolder folder;
  folder.write("mesh.toml", kMesh);
  const std::string plate = box_facets({0, 0, 0}, {4, 4, 2});
  folder.write("part.stl", "solid\n" + plate + box_facets({1, 1, -0.5}, {2, 3, 0.5}) + "endsolid\n");
  const Arguments how = {"rre",  "mesh.toml",        "--engine", "embree", "--samples",
                         "8192", "--incidence=0,20", "--json",   "r.json"};
  const Outcome united = retrace(folder, how);
  EXPECT_EQ(united.code, 0) << united.err;
  EXPECT_EQ(warnings_of(united).size(), 1U) << united.err;
  for (const Json& point : folder.json("r.json").at("points")) EXPECT_EQ(point.at("ledger").at("lost"), 0.0);
  // A box whose top face is rotated by 180 degrees crosses itself. The box is refused because it encloses no volume
  // that can be united with the plate.
  folder.write("part.stl",
               "solid\n" + plate + box_facets({1, 1, -0.5}, {2, 3, 0.5}, {0, 1, 2, 3, 6, 7, 4, 5}) + "endsolid\n");
  const Outcome refused = retrace(folder, how);
  EXPECT_EQ(refused_at(refused), "mesh.toml:2: part.mesh");
}

/// If some triangles are reversed, the message reports the orientation of the triangles and no opening. `allow_open`
/// has no effect.
TEST(MeshPart, MixedWindingIsNamed) {
  const TemporaryFolder folder;
  folder.write("mesh.toml", kMesh);
  const std::string box = box_facets({0, 0, 0}, {4, 4, 2});
  for (const std::size_t turned : {0U, 3U, 7U, 11U}) {
    // The first two vertices of the triangle `turned` are swapped.
    std::vector<std::string> lines;
    std::stringstream stream(box);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    std::string& line = lines[turned];
    const std::size_t first = line.find("vertex");
    const std::size_t second = line.find("vertex", first + 1);
    const std::size_t third = line.find("vertex", second + 1);
    line = line.substr(0, first) + line.substr(second, third - second) + line.substr(first, second - first) +
           line.substr(third);
    std::string text = "solid\n";
    for (const std::string& one : lines) text += one + "\n";
    folder.write("part.stl", text + "endsolid\n");
    for (const char* const open : {"part.allow_open=false", "part.allow_open=true"})
      EXPECT_EQ(refused_at(retrace(folder, {"rre", "mesh.toml", "--samples", "64", "--set", open})),
                "mesh.toml:2: part.mesh");
  }
}

/// A part in metres or micrometres is read as if it were in mm, and a warning suggests a scale. With this scale, the
/// result is that of the same part in mm.
TEST(MeshPart, ImplausibleSizesGiveAWarningThatNamesTheScale) {
  const TemporaryFolder folder;
  folder.write("mesh.toml", kMesh);
  const auto write_box = [&](double unit) {
    folder.write("part.stl", "solid\n" + box_facets({0, 0, 0}, {40 * unit, 20 * unit, 2 * unit}) + "endsolid\n");
  };
  const auto volume_mm3 = [&](const Arguments& more, std::size_t warnings) {
    const Outcome outcome = retrace(folder, with({"export", "mesh.toml", "out.stl", "--json", "e.json"}, more));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(warnings_of(outcome).size(), warnings) << outcome.err;
    return folder.json("e.json").at("volume_mm3").get<double>();
  };
  write_box(1.0);
  EXPECT_NEAR(volume_mm3({}, 0), 1600.0, 1e-3);
  write_box(1000.0);
  volume_mm3({}, 1);
  EXPECT_NEAR(volume_mm3({"--set", "part.scale=0.001"}, 0), 1600.0, 1e-2);
  write_box(0.001);
  volume_mm3({}, 1);
}

TEST(MeshPart, WrongFilesAndKeysAreRefused) {
  const TemporaryFolder folder;
  export_part(folder, kArray);
  const auto refused = [&](const std::string& design, const std::string& begin) {
    folder.write("d.toml", design);
    EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "--samples", "64"})), begin);
  };
  refused("[part]\nmesh = \"none.stl\"\n[body]\n", "d.toml:2: part.mesh");
  folder.write("text.stl", "hello");
  refused("[part]\nmesh = \"text.stl\"\n[body]\n", "d.toml:2: part.mesh");
  refused("[part]\n[body]\n", "d.toml: element.kind");
  refused("[part]\nmesh = 3\n", "d.toml:2: part.mesh");
  refused("[part]\nmesh = \"part.stl\"\nallow_open = 1\n", "d.toml:3: part.allow_open");
  refused("[part]\nmesh = \"part.stl\"\nscale = 0\n", "d.toml:3: part.scale");
  refused("[part]\nmesh = \"part.stl\"\n[array]\nx_length_mm = 1\n", "d.toml:3: array");
  refused("[part]\nmesh = \"part.stl\"\n[surface]\nroot_radius_um = 1\n", "d.toml:4: surface.root_radius_um");
  refused("[part]\nmesh = \"part.stl\"\n[body]\nthickness_mm = 2\n", "d.toml:2: part.mesh");
}

TEST(MeshPart, CommandsThatNeedElementsSaySo) {
  const TemporaryFolder folder;
  export_part(folder, kArray);
  EXPECT_EQ(refused_at(retrace(folder, {"job", "mesh.toml", "--tool-width-mm", "0.5"})), "mesh.toml:2: part.mesh");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "mesh.toml", "--engine", "exact", "--derivatives"})),
            "mesh.toml:2: part.mesh");
  EXPECT_EQ(refused_at(retrace(folder, {"export", "mesh.toml", "--what", "mould"})), "mesh.toml:2: part.mesh");
}

}  // namespace
}  // namespace retrace::test::mesh_command_test
