// Searches the source files for positions that are computed as the average of the corners of a polygon. Such an average
// moves if a corner is added on an edge. The result of geometry::centroid() does not move.

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "tests/layering/layer_rules.h"

namespace retrace::layering::corner_means_test {
namespace fs = std::filesystem;
namespace {

/// Files that are allowed to average points, and the reason for each file. In these files, the points are not the
/// corners of a polygon.
const std::map<std::string, std::string>& exempt() {
  static const std::map<std::string, std::string> files = {
      {"fabrication/chisel/check/bodies.cpp", "any point inside a hull is sufficient"},
      {"fabrication/chisel/check/simulation/plane_fit.cpp", "points that a plane is fitted to"},
      {"geometry/surface/boundary.cpp", "points whose order is not known yet"}};
  return files;
}

/// Searches C++ code for an expression that averages points. Such an expression is a sum of vectors divided by their
/// number, or a constant times a sum of named points.
/// \return the first such expression, or an empty string
std::string mean_of_points(const std::string& text) {
  static const std::regex sum(R"((Vec[23]) (\w+) = Vec[23]::Zero\(\);)");
  for (std::sregex_iterator at(text.begin(), text.end(), sum), end; at != end; ++at) {
    const std::string name = (*at)[2];
    // Search the code after the declaration of the sum. A sum of products is a weighted mean, which is allowed.
    const std::string near = text.substr(static_cast<std::size_t>(at->position()), 600);
    const std::regex plain("\\b" + name + R"( \+= [\w.\->+\[\]()<> ]+( / [\w.\->():<> ]+)?;)");
    const std::regex count("(\\b" + name + R"( \+= [^;*]* / |\b)" + name +
                           R"( /=? (static_cast<double>\(|n\b|count\b)))");
    std::smatch found;
    if (std::regex_search(near, plain) && std::regex_search(near, found, count)) return found.str();
  }
  static const std::array<std::regex, 2> others = {
      std::regex(R"(accumulate\([^;]*Vec[23][^;]*\)\s*/)"),
      std::regex(R"(Vec[23] \w+\s*=\s*0\.25 \*\s*\([^;]*\+[^;]*\+[^;]*\+)")};
  std::smatch found;
  for (const std::regex& other : others)
    if (std::regex_search(text, found, other)) return found.str();
  return {};
}

TEST(CornerMeans, NoneIsAPosition) {
  const fs::path root = RETRACE_SOURCE_DIR;
  const Rules rules = read_rules(root / "tests/layering/layers.json");
  std::set<std::string> met;
  std::size_t files = 0;
  for (const auto& [folder, lower] : rules.folders)
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".h") continue;
      ++files;
      std::ifstream file(entry.path());
      const std::string mean = mean_of_points({std::istreambuf_iterator<char>(file), {}});
      if (mean.empty()) continue;
      const std::string name = fs::relative(entry.path(), root).generic_string();
      if (exempt().contains(name))
        met.insert(name);
      else
        ADD_FAILURE() << name << ": " << mean << ": use geometry::centroid()";
    }
  EXPECT_GT(files, 300U);
  for (const auto& [name, reason] : exempt())
    EXPECT_TRUE(met.contains(name)) << name << " no longer averages points: remove it from exempt()";
}

// Typical expressions that average the corners of a polygon. The search must find each of them.
TEST(CornerMeans, AreFound) {
  for (const char* text :
       {"  Vec2 sum = Vec2::Zero();\n  for (const Vec2& p : polygon) sum += p;\n"
        "  return sum / static_cast<double>(polygon.size());\n",
        "  Vec3 middle = Vec3::Zero();\n  for (const std::uint32_t v : ring) middle += mesh.vertices[v];\n"
        "  mesh.vertices.push_back(middle / static_cast<double>(ring.size()));\n",
        "  Vec2 at = Vec2::Zero();\n  for (const Vec3& p : beam.corners) at += p.head<2>();\n"
        "  return at / static_cast<double>(beam.corners.size());\n",
        "  Vec2 sum = Vec2::Zero();\n    sum += patch.vertices[patch.corners[wall.first_corner + k]].head<2>();\n"
        "  return sum / static_cast<double>(wall.corner_count);\n",
        "  Vec3 middle = Vec3::Zero();\n    middle += corners.back() / facet.corner_count;\n",
        "  Vec3 sum = Vec3::Zero();\n  for (const Vec3& p : points) sum += p;\n"
        "  sum /= static_cast<double>(points.size());\n",
        "  return std::accumulate(corners.begin(), corners.end(), Vec3(Vec3::Zero())) / 3.0;\n",
        "  Vec3 middle = 0.25 * (v[a] + v[b] +\n     v[c] + v[d]);\n"})
    EXPECT_NE(mean_of_points(text), "") << text;
  EXPECT_EQ(mean_of_points("  Vec2 sum = Vec2::Zero();\n  sum += of_facet_mm2 * centroid(plan);\n"
                           "  return Vec2(sum / area_mm2);\n"),
            "");
}

}  // namespace
}  // namespace retrace::layering::corner_means_test
