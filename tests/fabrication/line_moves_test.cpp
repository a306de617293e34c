#include "fabrication/chisel/check/simulation/line_moves.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/atomic_file.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/machine.h"

// Tests of the selection of moves along lines. The surface of the selected moves must be equal to the surface of all
// moves, and the number of selected moves must not grow with the number of layers.

namespace retrace::fabrication::test::line_moves_test {
namespace {

using geometry::Vec3;

/// Returns a tool of 0.4 mm with a clearance face at 3 degrees and a rake face at 53 degrees.
ToolWedge wedge_of_test() {
  Tool tool;
  tool.width_mm = 0.4;
  tool.wedge_deg = 50.0;
  tool.clearance_deg = 3.0;
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/ideal.toml";
  return tool_wedge(tool, parse_machine(read_file(file), file), Angle::from_deg(90.0));
}

std::vector<SweptBody> bodies_of(const std::vector<SweptVolume>& moves, const ToolWedge& wedge) {
  std::vector<SweptBody> bodies;
  for (const SweptVolume& move : moves) bodies.push_back({&move, swept_sides(wedge, move)});
  return bodies;
}

LineSurface surface_of(const LineFamily& lines, std::size_t line, std::span<const SweptVolume* const> moves,
                       const std::vector<RigidMotion>& poses, const ToolWedge& wedge) {
  const Vec3 point = lines.origin_mm + lines.slants_mm[line] * lines.up;
  std::vector<LineSpan> spans;
  for (const SweptVolume* const move : moves)
    if (const auto span =
            swept_span(wedge, *move, poses[move->pose].point(point), poses[move->pose].direction(lines.direction)))
      spans.push_back(*span);
  return surface_along(spans, lines.exits_mm[line]);
}

/// Compares the surface of the selected moves with that of all moves, for every line. The results must be equal.
/// At least half of the lines must be cut, because the comparison has no meaning for other lines.
/// \return mean number of selected moves of a line
double compare_with_all(const LineFamily& lines, const std::vector<SweptVolume>& moves,
                        const std::vector<RigidMotion>& poses, const ToolWedge& wedge) {
  const std::vector<SweptBody> bodies = bodies_of(moves, wedge);
  std::vector<const SweptBody*> pointers;
  std::vector<const SweptVolume*> all;
  for (const SweptBody& body : bodies) {
    pointers.push_back(&body);
    all.push_back(body.move);
  }
  std::size_t selected = 0;
  std::size_t next = 0;
  std::size_t cut = 0;
  for_each_line(lines, pointers, poses, [&](std::size_t line, std::span<const SweptVolume* const> some) {
    EXPECT_EQ(line, next++);
    selected += some.size();
    const LineSurface expected = surface_of(lines, line, all, poses, wedge);
    const LineSurface surface = surface_of(lines, line, some, poses, wedge);
    EXPECT_EQ(surface.top, expected.top) << "line " << line;
    EXPECT_EQ(surface.lowest, expected.lowest) << "line " << line;
    if (expected.lowest < lines.exits_mm[line]) ++cut;
  });
  EXPECT_EQ(next, lines.slants_mm.size());
  EXPECT_GE(2 * cut, next);
  return static_cast<double>(selected) / static_cast<double>(std::max<std::size_t>(1, lines.slants_mm.size()));
}

TEST(LineMoves, SurfacesOfRandomMovesAreThoseOfAllMoves) {
  std::mt19937 bits(5);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  const ToolWedge wedge = wedge_of_test();
  std::size_t fewer = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<RigidMotion> poses(3);
    for (RigidMotion& pose : poses) {
      pose.rotation = Eigen::AngleAxisd(uniform(-0.3, 0.3), Vec3(uniform(-1, 1), uniform(-1, 1), 1.0).normalized())
                          .toRotationMatrix();
      pose.translation_mm = Vec3(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1));
    }
    std::vector<SweptVolume> moves(80);
    for (std::size_t k = 0; k < moves.size(); ++k) {
      moves[k].pose = static_cast<std::uint32_t>(k * poses.size() / moves.size());
      moves[k].location.line = static_cast<std::int32_t>(k);
      moves[k].from_mm = Vec3(uniform(-0.3, 0.3), uniform(-1, 1), uniform(-0.2, 1));
      moves[k].to_mm = k % 3 == 0 ? moves[k].from_mm : Vec3(uniform(-0.3, 0.3), uniform(-1, 1), uniform(-0.2, 1));
    }
    LineFamily lines;
    lines.origin_mm = Vec3(uniform(-0.1, 0.1), -1.0, 0.0);
    lines.up = Vec3::UnitY();
    lines.direction = Vec3::UnitZ();
    lines.reach_mm = 8.0;
    for (int k = 0; k < 150; ++k) lines.slants_mm.push_back(uniform(0.0, 2.0));
    std::sort(lines.slants_mm.begin(), lines.slants_mm.end());
    for (const double slant : lines.slants_mm) lines.exits_mm.push_back(1.5 - 0.5 * slant);
    if (compare_with_all(lines, moves, poses, wedge) < 0.3 * static_cast<double>(moves.size())) ++fewer;
  }
  EXPECT_GE(fewer, 50U);
}

/// Returns the mean number of selected moves for a staircase of `layers` plunges and ploughs, as roughing produces.
double selected_in_staircase(int layers) {
  const ToolWedge wedge = wedge_of_test();
  const double step_mm = 1.0 / layers;
  std::vector<SweptVolume> moves;
  for (int k = 0; k < layers; ++k) {
    const double y = k * step_mm;
    const Vec3 bottom(0.0, y, 0.0);
    moves.push_back({0, {}, false, Vec3(0.0, y, 1.5 + y), bottom, 0});
    moves.push_back({0, {}, false, bottom, Vec3(0.0, y - 3.0 * step_mm, 0.0), 0});
  }
  LineFamily lines;
  lines.up = Vec3::UnitY();
  lines.direction = Vec3::UnitZ();
  lines.reach_mm = 8.0;
  for (int k = 0; k < 4 * layers; ++k) {
    lines.slants_mm.push_back((k + 0.3) * 0.25 * step_mm);
    lines.exits_mm.push_back(1.2);
  }
  return compare_with_all(lines, moves, std::vector<RigidMotion>(1), wedge);
}

TEST(LineMoves, TheNumberOfSelectedMovesDoesNotGrowWithTheLayers) {
  const double few = selected_in_staircase(20);
  const double many = selected_in_staircase(320);
  EXPECT_LT(many, few + 2.0);
  EXPECT_LT(many, 12.0);
}

}  // namespace
}  // namespace retrace::fabrication::test::line_moves_test
