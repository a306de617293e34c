#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/simulation/dexel.h"
#include "fabrication/chisel/check/simulation/error_field.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "geometry/elements/element_cells.h"
#include "geometry/part/part.h"
#include "tests/fabrication/chiseling_programs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/swept_volume_sink.h"
#include "tests/support/refusals.h"

// Tests of diamond micro chiseling. Poses and tool paths are compared with the geometry of cube corners. Programs are
// read back from their text and simulated. The verifier must find faults that the tests insert into programs.

namespace retrace::fabrication::test::chiseling_test {
namespace {

using geometry::Vec3;

using namespace chiseling;

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::acos(a.normalized().dot(b.normalized())) * 180.0 / std::numbers::pi;
}

TEST(Chiseling, FacetsAndEdgesOfACubeOnItsCorner) {
  for (const bool rotated : {false, true})
    for (int k = 1; k <= 3; ++k) {
      const CubeCorner corner = cube_corner(geometry::HexagonalCube{0.3, {}}, {}, rotated);
      const Vec3& normal = corner.normals[static_cast<std::size_t>(k - 1)];
      const Vec3& first = corner.edges[static_cast<std::size_t>(k - 1)];
      const Vec3& second = corner.edges[static_cast<std::size_t>(k % 3)];
      EXPECT_NEAR(degrees_between(normal, Vec3::UnitZ()), 54.7356103172, 1e-9);
      for (const Vec3& edge : {first, second}) {
        EXPECT_NEAR(90.0 - degrees_between(edge, Vec3::UnitZ()), 35.2643896828, 1e-9);
        EXPECT_NEAR(edge.dot(normal), 0.0, 1e-15);
      }
      EXPECT_NEAR(first.dot(second), 0.0, 1e-15);
    }
}

TEST(Chiseling, ThePoseLaysTheToolOnTheFacetAndTheTipOnItsEdges) {
  for (const Machine& m : {machine(), crooked_machine()})
    for (const bool rotated : {false, true})
      for (int k = 1; k <= 3; ++k) {
        const Job job = cube_job(false);
        const CuttingPose pose = chiseling_pose(job, m, {rotated, k}, 0.0);
        const RigidMotion motion = machine_from_workpiece(m, pose.rounded);
        EXPECT_LT((motion.direction(blank_corner(job, 0, rotated).normals[static_cast<std::size_t>(k - 1)]) -
                   plunged_normal(m))
                      .norm(),
                  4e-9);
        EXPECT_NEAR(pose.rounded.a_deg, 35.2643897, m.name == "ideal-dmc" ? 1e-7 : 0.5);
      }
}

/// Compares the kinematics of the head with explicit rotations: the tool rotates about the pivot of B, and the
/// workpiece rotates about C.
TEST(Chiseling, TheHeadSwingsTheToolAboutItsPivot) {
  const Machine m = crooked_machine();
  const AxisPositions axes{1.5, -2.0, 3.0, 0.0, 77.0, 35.0};
  const Eigen::Matrix3d b = rotation_about(m.a.direction.value, Angle::from_deg(35.0));
  const Eigen::Matrix3d c = rotation_about(m.c.direction.value, Angle::from_deg(77.0));
  const Vec3 tip = Vec3(1.5, -2.0, 3.0);
  // The axis words are the position of the tip at B = 0. The vector from the tip to the pivot of B is `a.point_mm`.
  const Vec3 pivot = tip + m.a.point_mm.value;
  const Vec3 carried = pivot + b * (tip - pivot);
  const Vec3 in_workpiece = c.transpose() * (carried - m.c.point_mm.value) + m.c.point_mm.value;
  const ToolPose tool = forward(m, axes);
  EXPECT_NEAR((tool.workpiece_from_machine - c.transpose() * b).norm(), 0.0, 1e-14);
  const AxisPositions back = inverse(m, tool.reference_mm, {35.0, 77.0});
  EXPECT_NEAR((Vec3(back.x_mm, back.y_mm, back.z_mm) - tip).norm(), 0.0, 1e-12);
  EXPECT_NEAR((tool.reference_mm - in_workpiece).norm(), 0.0, 1e-12);
  EXPECT_EQ(back.b_deg, 35.0);
  EXPECT_EQ(back.a_deg, 0.0);
}

TEST(Chiseling, ProgramsOfThreeByThreeCubesVerifyBelowANanometre) {
  for (const bool is_hexagonal : {false, true})
    for (const double aperture_mm : {0.15, 0.3}) {
      const Job job = cube_job(is_hexagonal, aperture_mm);
      const Verification v = verified(job, machine(), text_of(job, machine()));
      const std::string what = fmt::format("hexagonal {} aperture {}", is_hexagonal, aperture_mm);
      EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
      EXPECT_EQ(v.elements_cut, 9) << what;
      EXPECT_LT(v.facet_distance_nm_max, 1.0) << what;
      EXPECT_LT(v.facet_angle_arcmin_max, 0.02) << what;
      EXPECT_LT(std::abs(v.apex_error_arcmin_max), 0.02) << what;
      EXPECT_LT(v.root_residual_nm_max, 3.0) << what;
      EXPECT_EQ(v.wall_overcut_nm_max, 0.0) << what;
    }
}

TEST(Chiseling, MeasuredAxesLeaveTheSameFacets) {
  for (const bool is_hexagonal : {false, true}) {
    const Job job = cube_job(is_hexagonal, 0.15);
    const Verification v = verified(job, crooked_machine(), text_of(job, crooked_machine()));
    EXPECT_TRUE(v.passes()) << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
  }
}

/// A program that is planned for ideal axes is run on a machine with a tilted axis B. The tip still follows the
/// dihedral edges, but the leading edge of the tool is not in the facet. The facet is therefore cut as two planes that
/// meet along the leading edge. The deviation is compared with a closed form.
TEST(Chiseling, PlannedForIdealAxesShowsTheErrorsOfTheMachine) {
  Machine leaning = machine();
  leaning.a.direction.value = Vec3(std::sin(0.005), std::cos(0.005), 0.0);
  leaning.a.point_mm.value = Vec3::Zero();
  Machine square = machine();
  square.a.point_mm.value = Vec3::Zero();
  const Job job = cube_job(false, 0.15);
  const Verification v = verified(job, leaning, text_of(job, square));
  EXPECT_FALSE(v.passes());
  const Angle b = Angle::from_rad(std::asin(1.0 / std::numbers::sqrt3));
  const Vec3 normal = rotation_about(Vec3::UnitY(), b) * plunged_normal(square);
  const double half_nose = Angle::from_deg(25.0).rad();
  const Vec3 leading =
      rotation_about(leaning.a.direction.value, b) * Vec3(0.0, std::sin(half_nose), std::cos(half_nose));
  const double length_mm = cavity_edge_mm(job.element) / (std::numbers::sqrt2 * std::cos(half_nose));
  const double expected_nm = 1e6 * length_mm * std::abs(normal.dot(leading));
  EXPECT_GT(expected_nm, 10.0);
  EXPECT_NEAR(v.facet_distance_nm_max, expected_nm, 1.0 + 0.01 * expected_nm);
}

/// Closed forms for a V-shaped tool with a rounded nose. Coordinates are along the first dihedral edge of a facet,
/// along the second dihedral edge, and along the facet normal. The point of the tool that is closest to a plane is
/// always on the circle of the nose.
struct RoundV {
  explicit RoundV(const Tool& tool) : edges(v_tool_edges(tool)), radius_mm(1e-3 * tool.edge_radius_um) {
    const double half_nose = Angle::from_deg(0.5 * tool.nose_angle_deg).rad();
    centre_mm = radius_mm / std::sin(half_nose) * (edges.leading + edges.trailing).normalized();
  }
  /// Returns the distance of the rounded tool from the plane through the sharp tip with the given normal, along this
  /// normal.
  double off_mm(const Vec3& normal) const {
    const Vec3 face = edges.leading.cross(edges.trailing).normalized();
    return normal.dot(centre_mm) - radius_mm * (normal - face * face.dot(normal)).norm();
  }
  /// Returns the distance from a dihedral edge to the flank of the cut along one of its two facets. The distance is
  /// measured along the bisector of both facets.
  /// \param in_facet direction in the facet, perpendicular to the edge
  double ridge_mm(const Vec3& edge, const Vec3& in_facet) const {
    Vec3 normal = edge.cross(edges.spine).normalized();
    if (normal.dot(in_facet) < 0.0) normal = -normal;
    return off_mm(normal) / normal.dot((in_facet + Vec3::UnitZ()).normalized());
  }
  VToolEdges edges;
  double radius_mm;
  Vec3 centre_mm;
};

/// A rounded nose leaves material as the formulas predict. Strips remain next to the dihedral edges. Between the
/// strips, a ridge remains that reaches up to the flanks of the two cuts.
TEST(Chiseling, ANoseLeavesTheStripsOfTheFormulaAndARidge) {
  constexpr double kWordUm = 1e-3;  // resolution of positions in programs
  for (const double radius_um : {0.5, 2.0})
    for (const double wedge_deg : {62.0, 65.0, 68.0}) {
      Job job = cube_job(radius_um > 1.0, 0.3);
      job.tool.wedge_deg = wedge_deg;
      const std::string text = text_of(job, machine());
      const Verification sharp = verified(job, machine(), text);
      EXPECT_EQ(sharp.root_chamfer_um, 0.0);
      EXPECT_EQ(sharp.root_ridge_um, 0.0);
      job.tool.edge_radius_um = radius_um;
      const Verification v = verified(job, machine(), text);
      EXPECT_TRUE(v.passes()) << listed(v);
      EXPECT_EQ(v.facet_distance_nm_max, sharp.facet_distance_nm_max);
      // The formula assumes that the arc of the nose is in the plane of the facet. The arc is tilted by the clearance
      // angle. The relative error of the strip width is of the order of this angle squared.
      const double clearance = Angle::from_deg(job.tool.clearance_deg).rad();
      EXPECT_NEAR(v.root_chamfer_um, 1e3 * std::sqrt(2.0) * nose_strip_mm(job.tool), clearance * clearance * radius_um);
      const RoundV tool(job.tool);
      const double strip_mm = std::max(tool.off_mm(Vec3::UnitX()), tool.off_mm(Vec3::UnitY()));
      EXPECT_NEAR(v.root_chamfer_um, 1e3 * std::sqrt(2.0) * strip_mm, 4e-4 * radius_um + kWordUm);
      const double ridge_mm =
          std::min(tool.ridge_mm(Vec3::UnitX(), Vec3::UnitY()), tool.ridge_mm(Vec3::UnitY(), Vec3::UnitX()));
      EXPECT_NEAR(v.root_ridge_um, 1e3 * ridge_mm, 2e-3 * 1e3 * ridge_mm) << wedge_deg;
    }
}

/// An element without its last layer has additional material next to its dihedral edges. This material is as thick as
/// the layer.
TEST(Chiseling, StripsBesideEdgesShowAMissingLayer) {
  Job job = cube_job(false, 0.15);
  job.tool.edge_radius_um = 1.0;
  Job rough = job;
  PlanOptions options;
  options.phase = "roughing";
  const std::string text = nc_text(make_plan(rough, machine(), options).programs.front(), "rs274ngc");
  const Verification v = verified(job, machine(), text);
  EXPECT_FALSE(v.passes());
  EXPECT_GT(v.root_chamfer_um, 1e3 * std::sqrt(2.0) * nose_strip_mm(job.tool) + job.process.finishing_depth_um);
}

/// The union of overlapping triangular cavities is the full-cube array (docs/theory/micro_chiseling.md). The surface
/// and the volume of a dexel simulation are compared with a staircase of unit cubes, each identified by three integer
/// coordinates.
TEST(Chiseling, OverlappingTriangularCavitiesAreTheFullCubeArray) {
  const Job job = cube_job(true, 0.3);
  const Machine m = machine();
  const Verification v = verified(job, m, text_of(job, m));
  ASSERT_TRUE(v.passes()) << listed(v);
  const double edge_mm = 0.5 * cavity_edge_mm(job.element);
  EXPECT_NEAR(edge_mm, 0.3 * std::sqrt(3.0 / 8.0), 1e-15);
  // A cube is identified by the coordinates i, j, k of its lowest corner, in units of the edge length. For the cubes of
  // the cells, i + j + k = 0.
  const auto elements = cut_elements(job);
  std::set<std::array<int, 3>> cells;
  const auto& [e1, e2, third] = blank_corner(job).edges;
  const Vec3 e3 = e1.cross(e2);
  for (const CutElement& element : elements) {
    const Vec3 apex = Vec3(element.centre_mm.x(), element.centre_mm.y(), 0.0) -
                      Vec3(elements[0].centre_mm.x(), elements[0].centre_mm.y(), 0.0);
    const auto index = [&](const Vec3& e) { return static_cast<int>(std::lround(apex.dot(e) / edge_mm)); };
    cells.insert({index(e1), index(e2), index(e3)});
    EXPECT_EQ(index(e1) + index(e2) + index(e3), 0);
  }
  ASSERT_EQ(cells.size(), 9U);
  std::set<std::array<int, 3>> above;
  for (const auto& c : cells)
    for (std::size_t k = 0; k < 3; ++k) {
      auto cube = c;
      ++cube[k];
      above.insert(cube);
    }
  const double volume_mm3 = std::pow(edge_mm, 3) * (5.0 * 9.0 + static_cast<double>(above.size())) / 6.0;
  EXPECT_NEAR(v.removed_volume_mm3, volume_mm3, 1e-6 * volume_mm3);
  EXPECT_NEAR(v.border_overcut_mm3, volume_mm3 - 9.0 * std::pow(edge_mm, 3), 1e-12);

  // Simulate the program text with dexels and compare the removed volume and the surface.
  SweptVolumeSink sink(m);
  run_nc(parse_nc(text_of(job, m), "p", NcDialect::rs274ngc), sink);
  const double reach = 5.0 * edge_mm;
  const DexelField field = cut_dexels(sink.sweeps, sink.poses, v_tool_wedge(job.tool, m),
                                      {{-reach, -reach, -2.0 * edge_mm}, {reach, reach, 0.0}}, 2, 150);
  EXPECT_NEAR(field.volume_mm3(), volume_mm3, 3e-3 * volume_mm3);
  const double low_mm = -geometry::element_depth_mm(job.element);
  int below = 0;
  for (std::size_t row = 0; row < field.rows; ++row)
    for (std::size_t column = 0; column < field.columns; ++column) {
      const double x = (2.0 * (static_cast<double>(column) + 0.5) / static_cast<double>(field.columns) - 1.0) * reach;
      const double y = (2.0 * (static_cast<double>(row) + 0.5) / static_cast<double>(field.rows) - 1.0) * reach;
      // Height of the staircase of cubes at (x, y). Each element removes the octant above its apex. The height is the
      // minimum of the lower boundaries of all octants.
      double stair_mm = 0.0;
      for (const CutElement& element : elements) {
        const Vec3 from(x - element.centre_mm.x(), y - element.centre_mm.y(), 0.0);
        double height_mm = 0.0;
        for (const Vec3& e : {e1, e2, e3}) height_mm = std::max(height_mm, -from.dot(e) / e.z());
        stair_mm = std::min(stair_mm, low_mm + height_mm);
      }
      const double left_mm = -field.removed_mm[row * field.columns + column];
      EXPECT_NEAR(left_mm, stair_mm, 5e-6) << x << " " << y;
      if (stair_mm < -1e-9) ++below;
    }
  EXPECT_GT(below, 3000);
}

/// The cavities at the border extend beyond their hexagons. The error map must show these flares as correct cuts, and
/// it must show no value where the blank is not cut.
TEST(Chiseling, TheMapOfErrorsHoldsFlares) {
  const Job job = cube_job(true, 0.3);
  const Machine m = machine();
  const ErrorField field = error_field(job, m, {parse_nc(text_of(job, m), "p", NcDialect::rs274ngc)}, 120);
  const double pixel_mm2 = field.size_mm.prod() / static_cast<double>(field.columns * field.rows);
  double cut_mm2 = 0.0;
  double worst_nm = 0.0;
  for (const double nm : field.height_nm) {
    if (std::isnan(nm)) continue;
    cut_mm2 += pixel_mm2;
    worst_nm = std::max(worst_nm, std::abs(nm));
  }
  // Each dexel is evaluated at the centre of its own cell, not at the centre of the pixel. On a plane facet, this
  // offset does not change the error of height.
  EXPECT_LT(worst_nm, 20.0);
  const double hexagons_mm2 = 9.0 * geometry::area(geometry::aperture_outline(job.element));
  EXPECT_GT(cut_mm2, 1.05 * hexagons_mm2);
  EXPECT_LT(cut_mm2, 0.98 * field.size_mm.prod());
}

TEST(Chiseling, EveryDialectCutsTheSame) {
  const Job job = cube_job(false, 0.15);
  for (const auto dialect : {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                             NcDialect::a3200, NcDialect::automation1}) {
    const std::string_view word = kNcDialectWords[static_cast<std::size_t>(dialect)];
    const Verification v = verified(job, machine(), text_of(job, machine(), word), dialect);
    EXPECT_TRUE(v.passes()) << word << "\n" << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
  }
}

/// Fixture with the program of a triangular array. Tests insert faults into this program.
class ChiselingFaults : public ::testing::Test {
 protected:
  ChiselingFaults() {
    job_.process.roughing_depth_um = 20.0;
    text_ = text_of(job_, machine());
  }

  static std::string replaced(std::string text, const std::string& from, const std::string& to, std::size_t after = 0) {
    const std::size_t at = text.find(from, after);
    EXPECT_NE(at, std::string::npos) << "the program has no " << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }
  /// Returns the text without the first line after the position `after` that contains `what`.
  static std::string without_line(std::string text, const std::string& what, std::size_t after = 0) {
    const std::size_t at = text.find(what, after);
    EXPECT_NE(at, std::string::npos) << "the program has no " << what;
    const std::size_t begin = text.rfind('\n', at) + 1;
    return text.erase(begin, text.find('\n', at) + 1 - begin);
  }
  /// Returns the text with changed words in the lines that begin with `start`. The function `change` is applied to the
  /// number that follows `letter`.
  static std::string changed(const std::string& text, const std::string& start, char letter,
                             const std::function<double(double)>& change) {
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line); result += line + "\n") {
      const std::size_t at = line.find(std::string(" ") + letter);
      if (!line.starts_with(start) || at == std::string::npos) continue;
      const std::size_t end = std::min(line.find(' ', at + 1), line.size());
      line.replace(at + 2, end - at - 2, fmt::format("{:.7f}", change(std::stod(line.substr(at + 2)))));
    }
    return result;
  }
  std::string kinds(const std::string& text) const {
    std::set<std::string> kinds;
    for (const Finding& finding : verified(job_, machine(), text).findings) kinds.insert(finding.kind);
    return fmt::format("{}", fmt::join(kinds, " "));
  }

  Job job_ = cube_job(false, 0.15);
  std::string text_;
};

TEST_F(ChiselingFaults, NoneWithoutAFault) {
  EXPECT_EQ(kinds(text_), "");
}

/// A program fails verification if any of its subroutine calls is missing. The calls cover all layers, elements and
/// facets.
TEST_F(ChiselingFaults, EveryCallIsNeeded) {
  int tried = 0;
  for (std::size_t at = text_.find(" call"); at != std::string::npos; at = text_.find(" call", at + 1), ++tried)
    EXPECT_NE(kinds(without_line(text_, " call", at)), "") << text_.substr(at - 5, 10);
  EXPECT_GE(tried, 30);
}

/// A program fails verification if the angle of C is wrong in any pose (a pair of angles B and C at which a facet is
/// cut). This holds even for the poses of small layers above the apex.
TEST_F(ChiselingFaults, EveryPoseIsNeeded) {
  int tried = 0;
  for (std::size_t at = text_.find("\nG0 B"); at != std::string::npos; at = text_.find("\nG0 B", at + 1)) {
    const std::size_t c = text_.find(" C", at) + 2;
    const std::size_t end = text_.find('\n', c);
    const double c_deg = std::stod(text_.substr(c, end - c));
    if (c_deg == 0.0) continue;  // move to the home position at the end
    for (const double by_deg : {-60.0, 30.0, 60.0, 180.0}) {
      const std::string spoilt = text_.substr(0, c) + fmt::format("{:.7f}", c_deg + by_deg) + text_.substr(end);
      EXPECT_NE(kinds(spoilt), "") << text_.substr(at + 1, end - at - 1) << " + " << by_deg;
      ++tried;
    }
  }
  EXPECT_GE(tried, 12);
}

TEST_F(ChiselingFaults, WrongSignOfC) {
  EXPECT_NE(kinds(changed(text_, "G0 B", 'C', [](double c) { return -c; })).find("gouge"), std::string::npos);
}

TEST_F(ChiselingFaults, WrongSignOfB) {
  EXPECT_NE(kinds(changed(text_, "G0 B", 'B', [](double b) { return -b; })), "");
}

TEST_F(ChiselingFaults, DwellLost) {
  EXPECT_EQ(kinds(without_line(text_, "G4 P0.1")), "missing_dwell");
}

TEST_F(ChiselingFaults, ElementDroppedFromALayer) {
  EXPECT_EQ(kinds(without_line(text_, "o104 call")), "chip_not_separated chip_too_thick") << "by the next layer";
  const std::size_t last = text_.rfind(" call");
  const std::string found = kinds(without_line(text_, " call", last));
  EXPECT_NE(found.find("layer_unfinished"), std::string::npos) << found;
}

TEST_F(ChiselingFaults, ElementDroppedAltogether) {
  std::string text;
  std::istringstream lines(text_);
  bool skips = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("(element ")) skips = line == "(element 4)";
    if (!(skips && line.find("call") != std::string::npos)) text += line + "\n";
  }
  const Verification v = verified(job_, machine(), text);
  ASSERT_FALSE(v.passes());
  for (const Finding& finding : v.findings) {
    EXPECT_EQ(finding.kind, "element_missing") << listed(v);
    EXPECT_EQ(finding.element, 4);
  }
}

TEST_F(ChiselingFaults, AxisScaled) {
  // The factor 1.001 shifts positions by half a micrometre over a length of half a millimetre.
  EXPECT_NE(kinds(changed(text_, "G0 X", 'X', [](double x) { return 1.001 * x; })).find("gouge"), std::string::npos);
}

TEST_F(ChiselingFaults, ReturnToAbsoluteLost) {
  EXPECT_NE(kinds(without_line(text_, "G90", text_.find("o101 sub"))), "");
}

TEST_F(ChiselingFaults, OriginShifted) {
  const Verification v = verified(job_, machine(), changed(text_, "G0 X", 'X', [](double x) { return x + 0.001; }));
  EXPECT_FALSE(v.passes());
  // A shift of 1 um along X of the machine moves the cut into every facet by cos(35.26 degrees) um.
  for (const ElementResult& element : v.elements)
    for (const FacetFigures& facet : element.figures.facets)
      EXPECT_NEAR(facet.mean_nm, -1000.0 * std::sqrt(2.0 / 3.0), 2.0);
}

TEST_F(ChiselingFaults, FileTruncated) {
  EXPECT_NE(kinds(text_.substr(0, text_.size() / 2)).find("truncated"), std::string::npos);
}

TEST_F(ChiselingFaults, SignFlippedInASubroutine) {
  const std::size_t sub = text_.find("o105 sub");
  const std::size_t word = text_.find(" X-", sub);
  ASSERT_LT(word, text_.find("endsub", sub));
  const std::string found = kinds(replaced(text_, " X-", " X", sub));
  EXPECT_NE(found, "");
}

TEST_F(ChiselingFaults, ClearanceOfAQuarter) {
  Job flat = job_;
  flat.process.clearance_mm = 0.05;
  EXPECT_NE(kinds(text_of(flat, machine())).find("clearance"), std::string::npos);
}

TEST_F(ChiselingFaults, FeedOfZero) {
  EXPECT_EQ(kinds(replaced(text_, "F50.000", "F0.000", text_.find("o103 sub"))), "zero_feed");
}

TEST_F(ChiselingFaults, StopsShortOfTheApex) {
  // Shorten one plunge by a tenth, so that the tool stops before the apex.
  const std::size_t sub = text_.find("o110 sub");
  const std::size_t line = text_.find("G1 X", sub);
  const std::string move = text_.substr(line, text_.find('\n', line) - line);
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  ASSERT_EQ(std::sscanf(move.c_str(), "G1 X%lf Y%lf Z%lf", &x, &y, &z), 3) << move;
  const std::string shorter = fmt::format("G1 X{:.6f} Y{:.6f} Z{:.6f} F50.000", 0.9 * x, 0.9 * y, 0.9 * z);
  const std::string found = kinds(replaced(text_, move, shorter, sub));
  EXPECT_NE(found.find("chip_not_separated"), std::string::npos) << found;
}

TEST_F(ChiselingFaults, AWordForAnAxisThatTheMachineHasNot) {
  EXPECT_NE(kinds(replaced(text_, "G0 B", "G0 A")).find("axis_unknown"), std::string::npos);
}

TEST_F(ChiselingFaults, TheTableTurnsWithTheToolInTheBlank) {
  const std::size_t turn = text_.find("G0 B", text_.find("o101 call"));
  const std::size_t lift = text_.rfind("G0 Z", turn);
  // The rotation about B raises the tip by 100 (1 - cos B) = 18.35 mm above its programmed Z position.
  EXPECT_NE(kinds(replaced(text_, text_.substr(lift, text_.find('\n', lift) - lift), "G1 Z-18.4 F50.", lift - 1))
                .find("rotation_too_low"),
            std::string::npos);
}

TEST(ChiselingJobs, AreReadAndWrittenWithoutLoss) {
  for (const bool is_hexagonal : {false, true}) {
    const Job job = cube_job(is_hexagonal);
    const Job again = parse_job(job_text(job), "j.toml");
    EXPECT_EQ(job_text(again), job_text(job));
    EXPECT_EQ(cut_elements(again).size(), 9U);
  }
}

TEST(ChiselingJobs, HaveAsManyElementsAsThePartHasWholeOnes) {
  for (const bool is_hexagonal : {false, true})
    for (const double x_mm : {1.0, 1.37, 2.6})
      for (const double y_mm : {0.9, 1.7}) {
        Job job = cube_job(is_hexagonal);
        job.array.pattern.clear();
        job.array.x_length_mm = x_mm;
        job.array.y_length_mm = y_mm;
        job.array.x_offset_mm = 0.07;
        geometry::PartSpec spec;
        spec.element = job.element;
        spec.array.arrangement = job.array.arrangement;
        spec.array.partial_elements = geometry::PartialElements::omit;
        spec.array.x_length_mm = x_mm;
        spec.array.y_length_mm = y_mm;
        spec.array.x_offset_mm = 0.07;
        spec.thickness_mm = 1.0;
        EXPECT_EQ(static_cast<std::int64_t>(cut_elements(job).size()), geometry::build_part(spec).elements_full);
      }
}

struct WrongJob {
  std::string from;
  std::string to;
  std::string place;
};

TEST(ChiselingJobs, WhatIsWrongIsRefusedWithFileLineAndKey) {
  const std::string good = job_text(cube_job(true));
  const WrongJob cases[] = {
      {"strategy = \"dmc\"", "strategy = \"two-step\"", "j.toml:11: element.kind"},
      {"kind = \"mould\"", "kind = \"direct\"", "j.toml:7: workpiece.kind"},
      {"nose_angle_deg = 50", "nose_angle_deg = 95", "j.toml:35: tool.nose_angle_deg"},
      {"wedge_deg = 65", "wedge_deg = 40", "j.toml:32: tool.wedge_deg"},
      {"width_mm = 0.42", "width_mm = 0.2", "j.toml:31: tool.width_mm"},
      {"edge_radius_um = 0", "edge_radius_um = 31", "j.toml:34: tool.edge_radius_um"},
      {"aperture_mm = 0.3", "aperture_mm = -1", "j.toml:12: element.aperture_mm"},
      {"aperture_mm = 0.3", "aperture_mm = 9", "j.toml:16: array.x_length_mm"},
      {"arrangement = \"honeycomb\"", "arrangement = \"offset\"", "j.toml:15: array.arrangement"},
      {"x_offset_mm = 0", "x_offset_mm = 0\nx_gap_mm = 0.1", "j.toml:19: array.x_gap_mm"},
      {"\"--\",", "\"-\",", "j.toml:20: array.pattern"},
  };
  for (const WrongJob& wrong : cases) {
    SCOPED_TRACE(wrong.to);
    std::string text = good;
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << good;
    text.replace(at, wrong.from.size(), wrong.to);
    EXPECT_EQ(refusal_of([&] { parse_job(text, "j.toml"); }), wrong.place);
  }
}

/// A V-shaped tool that is too thick behind its edges would collide with the next facet.
TEST(ChiselingJobs, AToolThatRunsIntoTheNextFacetIsRefused) {
  Job job = cube_job(true);
  job.tool.nose_angle_deg = 80.0;
  job.tool.wedge_deg = 80.0;
  job.tool.clearance_deg = 15.0;
  job.tool.width_mm = 1.0;
  EXPECT_EQ(refusal_of([&] { parse_job(job_text(job), "j.toml"); }), "j.toml:32: tool.wedge_deg");
}

TEST(ChiselingJobs, NeedAHeadThatTilts) {
  EXPECT_THROW(make_plan(cube_job(true), machine("ideal")), InputError);
  EXPECT_THROW(make_plan(square_job(2), machine()), InputError);
  EXPECT_THROW(verified(cube_job(true), machine("ideal"), text_of(cube_job(true), machine())), InputError);
}

}  // namespace
}  // namespace retrace::fabrication::test::chiseling_test
