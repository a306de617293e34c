// Tests of the reader of files of cubes: rings, grids, single cubes, CSV tables and error messages.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "studies/ranging/io/cubes_reader.h"
#include "tests/support/documents.h"
#include "tests/support/key_table.h"
#include "tests/support/refusals.h"

namespace retrace::testing::cubes_reader_test {
namespace {

using geometry::Vec3, studies::ArrayCube, studies::parse_cube_table, studies::parse_cubes;

const std::string kSchema = "schema = \"retrace.cubes/1\"\n";

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR((a - b).norm(), 0.0, 1e-12) << a.transpose() << " and " << b.transpose();
}

TEST(CubesFile, RingsGridsAndCubesAreRead) {
  const std::vector<ArrayCube> cubes = parse_cubes(
      kSchema +
          "[[cube]]\nposition_mm = [1, 2, 3]\naxis = [0, 3, 4]\nclocking_deg = 7\ndihedral_error_arcsec = [1, 2, 3]\n"
          "[[ring]]\nradius_mm = 100\nlatitude_deg = 30\ncount = 4\nazimuth_deg = 10\nclocking_deg = 5\n"
          "clocking_step_deg = 2\n[[grid]]\ncolumns = 3\nrows = 2\npitch_mm = 10\nheight_mm = 1\n",
      "c.toml");
  ASSERT_EQ(cubes.size(), 11u);
  const double third = std::sqrt(0.75);
  const double azimuth = 100.0 * std::acos(-1.0) / 180.0;
  expect_near(cubes[1].axis, Vec3(third * std::cos(azimuth), third * std::sin(azimuth), 0.5));
  expect_near(cubes[1].position_mm, 100.0 * cubes[1].axis);
  EXPECT_EQ(cubes[2].clocking_deg, 9.0);
  expect_near(cubes[4].position_mm, Vec3(-10, -5, 1));
  expect_near(cubes[9].position_mm, Vec3(10, 5, 1));
  expect_near(cubes[9].axis, Vec3::UnitZ());
  expect_near(cubes[10].axis, Vec3(0, 0.6, 0.8));
  EXPECT_EQ(cubes[10].clocking_deg, 7.0);
  EXPECT_EQ((*cubes[10].dihedral_error_arcsec)[2], 3.0);
}

TEST(CubesFile, TablesAreRead) {
  const std::vector<ArrayCube> cubes =
      parse_cube_table("x_mm,y_mm,z_mm,axis_x,axis_y,axis_z,clocking_deg\n1,2,3,0,0,2,15\n4,5,6,1,0,0,0\n", "c.csv");
  ASSERT_EQ(cubes.size(), 2u);
  expect_near(cubes[0].axis, Vec3::UnitZ());
  EXPECT_EQ(cubes[0].clocking_deg, 15.0);
  expect_near(cubes[1].position_mm, Vec3(4, 5, 6));
  EXPECT_FALSE(cubes[1].dihedral_error_arcsec);
}

TEST(CubesFile, RotationsHaveTheDocumentedAxes) {
  ArrayCube cube;
  cube.axis = Vec3::UnitX();
  expect_near(studies::array_from_cube(cube) * Vec3::UnitZ(), Vec3::UnitX());
  expect_near(studies::array_from_cube(cube) * Vec3::UnitX(), -Vec3::UnitZ());
  cube.clocking_deg = 90.0;
  expect_near(studies::array_from_cube(cube) * Vec3::UnitX(), Vec3::UnitY());
  cube.axis = Vec3::UnitZ();
  expect_near(studies::array_from_cube(cube) * Vec3::UnitX(), Vec3::UnitY());
}

TEST(CubesFile, WrongFilesAreRefusedWithLineAndKey) {
  const auto refused = [](const std::string& text) {
    return refusal_of([&] { parse_cubes(kSchema + text, "c.toml"); });
  };
  EXPECT_EQ(refused(""), "c.toml");
  EXPECT_EQ(refused("[[ring]]\ncount = 3\n"), "c.toml:2: ring[1].radius_mm");
  EXPECT_EQ(refused("[[ring]]\nradius_mm = -1\ncount = 3\n"), "c.toml:3: ring[1].radius_mm");
  EXPECT_EQ(refused("[[ring]]\nradius_mm = 1\ncount = 0\n"), "c.toml:4: ring[1].count");
  EXPECT_EQ(refused("[[ring]]\nradius_mm = 1\ncount = 2\nlatitude_deg = 91\n"), "c.toml:5: ring[1].latitude_deg");
  EXPECT_EQ(refused("[[grid]]\ncolumns = 1\nrows = 1.5\npitch_mm = 1\n"), "c.toml:4: grid[1].rows");
  EXPECT_EQ(refused("[[grid]]\ncolumns = 1\nrows = 1\npitch_mm = 0\n"), "c.toml:5: grid[1].pitch_mm");
  EXPECT_EQ(refused("[[grid]]\ncolumns = 1000\nrows = 1000\npitch_mm = 1\n"), "c.toml");
  EXPECT_EQ(refused("[[cube]]\naxis = [0, 0, 1]\n"), "c.toml:2: cube[1].position_mm");
  EXPECT_EQ(refused("[[cube]]\nposition_mm = [0, 0]\n"), "c.toml:3: cube[1].position_mm");
  EXPECT_EQ(refused("[[cube]]\nposition_mm = [0, 0, 0]\naxis = [0, 0, 0]\n"), "c.toml:4: cube[1].axis");
  EXPECT_EQ(refused("[[cube]]\nposition_mm = [0, 0, 0]\nclocking_deg = 361\n"), "c.toml:4: cube[1].clocking_deg");
  EXPECT_EQ(refused("[[cube]]\nposition_mm = [0, 0, 0]\ndihedral_error_arcsec = [1, 2]\n"),
            "c.toml:4: cube[1].dihedral_error_arcsec");
  EXPECT_EQ(refused("[[cubes]]\nposition_mm = [0, 0, 0]\n"), "c.toml:2: cubes");
  EXPECT_EQ(refusal_of([] { parse_cubes("schema = \"retrace.design/1\"\n", "c.toml"); }), "c.toml:1: schema");
}

TEST(CubesFile, WrongTablesAreRefusedWithLineAndColumn) {
  const std::string header = "x_mm,y_mm,z_mm,axis_x,axis_y,axis_z";
  const auto refused = [](const std::string& text) { return refusal_of([&] { parse_cube_table(text, "c.csv"); }); };
  EXPECT_EQ(refused(header + "\n"), "c.csv");
  EXPECT_EQ(refused("x_mm,y_mm,z_mm\n1,2,3\n"), "c.csv:1");
  EXPECT_EQ(refused(header + "\n1,2,3,0,0,0\n"), "c.csv:2: axis_x");
  EXPECT_EQ(refused(header + "\n1,2,3,0,0,1\n1,2,x,0,0,1\n"), "c.csv:3: z_mm");
  EXPECT_EQ(refused(header + ",clocking\n1,2,3,0,0,1,1\n"), "c.csv:1");
  EXPECT_EQ(refused(header + ",dihedral_error_1_arcsec\n1,2,3,0,0,1,1\n"), "c.csv:1");
}

TEST(CubesFile, KeysAreDocumented) {
  EXPECT_EQ(documents_test::documented("commands/ranging.md", "cubes"), schema::key_tables(studies::cubes_format()));
}

}  // namespace
}  // namespace retrace::testing::cubes_reader_test
