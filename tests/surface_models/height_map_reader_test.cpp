#include "surface_models/io/height_map_reader.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/support/refusals.h"

namespace retrace::surface_models::height_map_reader_test {
namespace {

constexpr double kNaN = kMissing;

void expect_heights(const HeightMap& map, const std::vector<double>& expected) {
  ASSERT_EQ(map.heights_nm.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::isnan(map.heights_nm[i]), std::isnan(expected[i])) << i;
    if (std::isnan(expected[i])) continue;
    EXPECT_DOUBLE_EQ(map.heights_nm[i], expected[i]) << i;
  }
}

std::string message_of(const std::string& content, const std::string& name = "m.txt",
                       const HeightMapOptions& options = {}) {
  return refusal_of([&] { parse_height_map(content, name, options); }, "no error");
}

const std::vector<double> kTwoRows = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, kNaN, 13, 14, 15, 16};

std::string little_endian(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

std::string gsf(const std::string& keys, std::size_t count) {
  std::string content = "Gwyddion Simple Field 1.0\n" + keys;
  content += std::string(4 - content.size() % 4, '\0');
  for (std::size_t i = 0; i < count; ++i)
    content += little_endian(std::bit_cast<std::uint32_t>(i == 11 ? std::nanf("") : 1e-9F * static_cast<float>(i + 1)));
  return content;
}

TEST(TextGrid, TakesEverySeparatorAndMissingWord) {
  for (const std::string text :
       {"# pixel_um = 0.5\n# height_unit = nm\n1 2 3 4 5 6 7 8\n9 10 11 nan 13 14 15 16\n",
        "pixel_um 0.5\nheight_unit nm\n1,2,3,4,5,6,7,8\n9,10,11,,13,14,15,16",
        "# a comment\r\npixel_um: 0.5\r\nheight_unit: nm\r\n1;2;3;4;5;6;7;8;\r\n9;10;11;BAD;13;14;15;16;\r\n",
        "\xef\xbb\xbf#pixel_um=0.5\n#height_unit=um\n0.001\t2e-3\t0.003\t0.004 +0.005 6E-3 0.007 0.008\n\n"
        "0.009 0.01 0.011 *** 0.013 0.014 0.015 0.016\n",
        "ncols 8\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\nlateral_unit um\nheight_unit nm\nNODATA_value "
        "-9999\n"
        "9 10 11 -9999 13 14 15 16\n1 2 3 4 5 6 7 8\n",
        "# Channel: Height\n# Width: 4.0 \xc2\xb5m\n# Height: 1.0 \xc2\xb5m\n# Value units: m\n"
        "1e-9 2e-9 3e-9 4e-9 5e-9 6e-9 7e-9 8e-9\n9e-9 10e-9 11e-9 NaN 13e-9 14e-9 15e-9 16e-9\n"}) {
    SCOPED_TRACE(text);
    const HeightMapFile file = parse_height_map(text, "m.txt", {});
    EXPECT_EQ(file.map.columns, 8U);
    EXPECT_EQ(file.map.rows, 2U);
    EXPECT_DOUBLE_EQ(file.map.x_pixel_um, 0.5);
    EXPECT_DOUBLE_EQ(file.map.y_pixel_um, 0.5);
    EXPECT_TRUE(file.warnings.empty());
    expect_heights(file.map, kTwoRows);
  }
}

TEST(TextGrid, OptionsGoBeforeTheFile) {
  HeightMapOptions options;
  options.x_pixel_um = 2.0;
  options.y_pixel_um = 3.0;
  options.height_unit = "um";
  const HeightMapFile bare = parse_height_map("1 2 3 4 5 6 7 8\n1 2 3 4 5 6 7 8\n", "m.csv", options);
  EXPECT_EQ(bare.map.x_pixel_um, 2.0);
  EXPECT_EQ(bare.map.y_pixel_um, 3.0);
  EXPECT_EQ(bare.map.at(7, 1), 8000.0);
  EXPECT_TRUE(bare.warnings.empty());
  const HeightMapFile said =
      parse_height_map("pixel_um 1\nheight_unit nm\n1 2 3 4 5 6 7 8\n1 2 3 4 5 6 7 8\n", "m.csv", options);
  EXPECT_EQ(said.map.x_pixel_um, 2.0);
  EXPECT_EQ(said.warnings.size(), 3U);
}

TEST(TextGrid, OneRowOrColumnIsAProfile) {
  for (const std::string text : {"pixel_um 0.25\nheight_unit nm\n1 2 3 4 5 6 7 8\n",
                                 "y_pixel_um 0.25\nheight_unit nm\n1\n2\n3\n4\n5\n6\n7\n8\n"}) {
    const HeightMap map = parse_height_map(text, "p.txt", {}).map;
    EXPECT_TRUE(map.is_profile());
    EXPECT_EQ(map.x_pixel_um, 0.25);
    expect_heights(map, {1, 2, 3, 4, 5, 6, 7, 8});
  }
}

TEST(PointList, FindsTheGrid) {
  std::string text = "# lateral_unit = mm\n# height_unit = nm\n";
  for (int i = 15; i >= 0; --i)
    if (i != 11)
      text += std::to_string(0.5 + 0.002 * (i % 8)) + " " + std::to_string(-0.003 * (i / 8)) + " " +
              std::to_string(i + 1) + "\n";
  const HeightMap map = parse_height_map(text, "cloud.XYZ", {}).map;
  EXPECT_EQ(map.columns, 8U);
  EXPECT_NEAR(map.x_pixel_um, 2.0, 1e-9);
  EXPECT_NEAR(map.y_pixel_um, 3.0, 1e-9);
  // In the file, y decreases from row to row, so that the rows of the map are in reversed order.
  expect_heights(map, {9, 10, 11, kNaN, 13, 14, 15, 16, 1, 2, 3, 4, 5, 6, 7, 8});
  const HeightMap profile =
      parse_height_map(
          "columns = xz\nlateral_unit = um\nheight_unit = um\n3 1\n1 1\n2 1\n5 1\n4 1\n6 1\n9 2\n7 NaN\n8 1\n", "p.txt",
          {})
          .map;
  EXPECT_TRUE(profile.is_profile());
  expect_heights(profile, {1000, 1000, 1000, 1000, 1000, 1000, kNaN, 1000, 2000});
}

TEST(Sdf, IsRead) {
  for (const std::string version : {"aISO-1.0", "aBCR-1.0"}) {
    const HeightMapFile file = parse_height_map(
        version +
            "\nManufacID = lab\nCreateDate = 010120200000\nModDate = 010120200000\nNumPoints = 8\nNumProfiles = 2\n"
            "Xscale = 1.5E-6\nYscale = 2.5E-6\nZscale = 1.0E-9\nZresolution = -1\nCompression = 0\nDataType = 7\n"
            "CheckType = 0\n*\n1 2 3 4 5 6 7 8\n9 10 11 BAD\n13 14 15 16\n*\ntrailer\n",
        "m.sdf", {});
    EXPECT_NEAR(file.map.x_pixel_um, 1.5, 1e-12);
    EXPECT_NEAR(file.map.y_pixel_um, 2.5, 1e-12);
    expect_heights(file.map, kTwoRows);
  }
}

TEST(Gsf, IsRead) {
  const HeightMapFile file = parse_height_map(
      gsf("XRes = 8\nYRes = 2\nXReal = 4e-6\nYReal = 2e-6\nXYUnits = m\nZUnits = m\nTitle = t\n", 16), "m.gsf", {});
  EXPECT_NEAR(file.map.x_pixel_um, 0.5, 1e-12);
  EXPECT_NEAR(file.map.y_pixel_um, 1.0, 1e-12);
  for (std::size_t i = 0; i < 16; ++i) {
    if (i == 11) {
      EXPECT_TRUE(std::isnan(file.map.heights_nm[i]));
    } else {
      EXPECT_NEAR(file.map.heights_nm[i], static_cast<double>(i + 1), 1e-5);
    }
  }
}

/// A height in nm at a position in um.
struct Point {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

constexpr int kColumns = 9;
constexpr int kRows = 5;
constexpr double kStepX = 2.0;
constexpr double kStepY = 2.0;

/// Returns heights without any symmetry: no two heights are equal, and mirroring or transposing the map changes it.
double height_at(int column, int row) {
  return 100.0 * row + 3.0 * column + 0.5 * column * row * row;
}

std::string words(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += std::to_string(value) + " ";
  return text + "\n";
}

/// Returns a matrix of heights as text, with one row per line.
/// \param first_row row that is written first: 0 for ascending rows, the last row for descending rows
std::string matrix(int first_row, double unit) {
  std::string text;
  for (int k = 0; k < kRows; ++k) {
    std::vector<double> row;
    for (int i = 0; i < kColumns; ++i) row.push_back(unit * height_at(i, std::abs(first_row - k)));
    text += words(row);
  }
  return text;
}

/// Returns the numbers of each line that contains only numbers. Other lines are skipped.
std::vector<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream stream(line);
    std::vector<double> row;
    for (double value = 0.0; stream >> value;) row.push_back(value);
    if (stream.eof() && !row.empty()) rows.push_back(row);
  }
  return rows;
}

/// The content of a file, and the points that it contains. The test computes the points without the reader that it
/// tests.
struct FileAndPoints {
  std::string name;
  std::string content;
  std::vector<Point> points;
};

std::vector<Point> points_of(const std::string& text, bool first_row_has_largest_y) {
  const std::vector<std::vector<double>> rows = numbers_of(text);
  std::vector<Point> points;
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < rows[k].size(); ++i)
      points.push_back({kStepX * static_cast<double>(i),
                        kStepY * static_cast<double>(first_row_has_largest_y ? rows.size() - 1 - k : k), rows[k][i]});
  return points;
}

/// Returns files in every format that contain the same heights.
std::vector<FileAndPoints> every_format() {
  std::vector<FileAndPoints> files;
  const std::string grid = matrix(0, 1.0);
  files.push_back({"m.txt", "pixel_um 2\nheight_unit nm\n" + grid, points_of(grid, false)});
  // ESRI: "the first row of the data is at the top of the raster" (ArcGIS, Esri ASCII raster format).
  const std::string esri = matrix(kRows - 1, 1.0);
  for (const std::string head :
       {"ncols 9\nnrows 5\nxllcorner 7\nyllcorner 3\ncellsize 2\nNODATA_value -9999\n",
        "NCOLS 9\nNROWS 5\nXLLCENTER 0\nYLLCENTER 0\nCELLSIZE 2\n", "cellsize 2\n", "ncols 9\nnrows 5\npixel_um 2\n"})
    files.push_back({"m.asc", head + "lateral_unit um\nheight_unit nm\n" + esri, points_of(esri, true)});
  std::string list;
  std::vector<Point> points;
  for (int row = kRows - 1; row >= 0; --row)
    for (int column = 0; column < kColumns; ++column) {
      points.push_back({kStepX * column, kStepY * row, height_at(column, row)});
      list += words({points.back().x, points.back().y, points.back().z});
    }
  files.push_back({"m.xyz", "lateral_unit um\nheight_unit nm\n" + list, points});
  // ISO 25178-71: profiles follow each other along y.
  files.push_back(
      {"m.sdf",
       "aISO-1.0\nNumPoints = 9\nNumProfiles = 5\nXscale = 2e-6\nYscale = 2e-6\nZscale = 1e-9\n*\n" + grid + "*\n",
       points_of(grid, false)});
  // Gwyddion: rows follow each other along y.
  std::string simple =
      "Gwyddion Simple Field 1.0\nXRes = 9\nYRes = 5\nXReal = 18e-6\nYReal = 10e-6\nXYUnits = m\n"
      "ZUnits = m\n";
  simple += std::string(4 - simple.size() % 4, '\0');
  for (const Point& point : points_of(grid, false))
    simple += little_endian(std::bit_cast<std::uint32_t>(static_cast<float>(1e-9 * point.z)));
  files.push_back({"m.gsf", simple, points_of(grid, false)});
  return files;
}

TEST(HeightMapFormats, PlaceAnAsymmetricMapAlike) {
  for (const FileAndPoints& file : every_format()) {
    SCOPED_TRACE(file.name + "\n" + file.content.substr(0, 60));
    const HeightMap map = parse_height_map(file.content, file.name, {}).map;
    ASSERT_EQ(map.columns, static_cast<std::size_t>(kColumns));
    ASSERT_EQ(map.rows, static_cast<std::size_t>(kRows));
    ASSERT_EQ(file.points.size(), map.heights_nm.size());
    for (const Point& point : file.points) {
      const auto column = static_cast<std::size_t>(std::lround(point.x / map.x_pixel_um));
      const auto row = static_cast<std::size_t>(std::lround(point.y / map.y_pixel_um));
      EXPECT_NEAR(map.at(column, row), point.z, 1e-4);
      EXPECT_NEAR(map.at(column, row), height_at(static_cast<int>(column), static_cast<int>(row)), 1e-4);
    }
  }
}

TEST(BadHeightMap, SaysWhereAndWhatIsAllowed) {
  const std::string head = "pixel_um 1\nheight_unit nm\n";
  const std::string row = "1 2 3 4 5 6 7 8\n";
  const std::string sdf_head = "aISO-1.0\nNumPoints = 8\nNumProfiles = 1\nXscale = 1e-6\nZscale = 1e-9\n";
  const std::string gsf_head = "XRes = 8\nYRes = 2\nXReal = 4e-6\nYReal = 2e-6\nXYUnits = m\nZUnits = m\n";
  struct Case {
    std::string content;
    std::string begin;
    std::string name = "m.txt";
  };
  const std::vector<Case> cases = {
      {"", "m.txt"},
      {"# nothing\n", "m.txt"},
      {row + row, "m.txt"},
      {"x_pixel_um 1\n" + row + row, "m.txt"},
      {"pixel_um 1\n" + row, "m.txt"},
      {head + "nan nan nan nan nan nan nan nan\n", "m.txt"},
      {head + row + "1 2 3\n", "m.txt:4"},
      {head + "1 2 3 4\n", "m.txt"},
      {head + "1 2 3 4 five 6 7 8\n", "m.txt:3"},
      {head + "1;2,5;3;4;5;6;7;8\n", "m.txt:3"},
      {head + "1 2 3 4 5 6 7 inf\n", "m.txt:3"},
      {head + "1 2 3 4 5 6 7 1e300\n", "m.txt"},
      {"pixel_um 0\n", "m.txt:1"},
      {"pixel_um -1\n", "m.txt:1"},
      {"pixel_um wide\n", "m.txt:1"},
      {"pixel_um 1e9\nheight_unit nm\n" + row, "m.txt"},
      {"height_unit inch\n", "m.txt:1"},
      {"spacing 1\n", "m.txt:1"},
      {"ncols 8\nnrows 3\n" + head + row, "m.txt:5"},
      {"Hello, world\n", "m.txt:1"},
      {std::string("\x89PNG\r\n\x1a\n\0\0", 10), "m.txt"},
      {"PK\x03\x04...", "m.txt"},
      {"bISO-1.0", "m.txt"},
      {"columns = xyz\n" + row, "m.txt:2"},
      {"1 2 3\n4 5 6\n", "m.xyz", "m.xyz"},
      {"lateral_unit um\nheight_unit um\n0 0 1\n1 0 1\n3 0 1\n", "m.xyz", "m.xyz"},
      {"lateral_unit um\nheight_unit um\n0 0 1\n1 0 1\n1 0 1\n", "m.xyz", "m.xyz"},
      {sdf_head, "m.txt:6"},
      {sdf_head + "*\n1 2 3\n", "m.txt:8"},
      {sdf_head + "*\n1 2 3 4 5 6 7 8 9\n", "m.txt:7"},
      {sdf_head + "*\n1 2 x\n", "m.txt:7"},
      {sdf_head + "Compression = 1\n*\n", "m.txt:6"},
      {"aISO-1.0\nNumPoints = 1e9\nNumProfiles = 1e9\nXscale = 1e-6\nYscale = 1\nZscale = 1e-9\n*\n", "m.txt:2"},
      {"aISO-1.0\nNumPoints = 8\n*\n", "m.txt"},
      {gsf(gsf_head, 15), "m.txt"},
      {gsf(gsf_head, 17), "m.txt"},
      {gsf("XRes = 100000\nYRes = 100000\n", 0), "m.txt:2"},
      {gsf("YRes = 2\n", 0), "m.txt"},
      {gsf("XRes = 8\nYRes = 2\nZUnits = m\n", 16), "m.txt"},
      {gsf("XRes = 8\nYRes = 2\nZUnits = V\n", 16), "m.txt:4"},
      {"Gwyddion Simple Field 1.0\nXRes = 8\n", "m.txt"},
      {"GWYP", "m.txt"},
      {"GWYO....", "m.txt"},
      {"GWYPGwyContainer" + std::string(5, '\0'), "m.txt"},
      {"GWYPGwyContainer" + std::string(1, '\0') + little_endian(4) + "a" + std::string(1, '\0') + "zz", "m.txt"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.begin);
    EXPECT_EQ(message_of(c.content, c.name), c.begin);
  }
}

TEST(BadHeightMap, OptionsAreCheckedToo) {
  HeightMapOptions options;
  options.height_unit = "inch";
  EXPECT_EQ(message_of("pixel_um 1\n1 2 3 4 5 6 7 8\n", "m.txt", options), "height_unit");
  options.height_unit = "nm";
  options.lateral_unit = "ell";
  EXPECT_EQ(message_of("pixel_um 1\n1 2 3 4 5 6 7 8\n", "m.txt", options), "lateral_unit");
}

}  // namespace
}  // namespace retrace::surface_models::height_map_reader_test
