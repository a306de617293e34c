#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/bodies.h"
#include "fabrication/chisel/check/simulation/dexel.h"
#include "fabrication/chisel/check/simulation/error_field.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/jobs.h"

// Tests of cutting by planes. The results are compared with analytic shapes and with dexels that clip polyhedra. Random
// faults must be found.

namespace retrace::fabrication::test::cutting_test {
namespace {

using geometry::Arrangement;
using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

SweptVolume sweep_of(const Vec3& from, const Vec3& to, std::uint32_t pose = 0) {
  return {pose, {1, 0}, false, from, to};
}

/// Returns the volume that is removed from the blank z < 0 below a rectangle. The volume is integrated from lines along
/// z, each of which is computed exactly. Across x and y, the depth is piecewise linear. Cells must therefore end where
/// the slope of the depth changes.
double volume_by_lines(const std::vector<SweptVolume>& sweeps, const std::vector<RigidMotion>& poses,
                       const ToolWedge& wedge, double x_end, double y_low, double y_high, int cells) {
  double volume = 0.0;
  std::vector<LineSpan> spans;
  const double dy = (y_high - y_low) / cells;
  for (int i = 0; i < cells; ++i) {
    const Vec3 p(0.3 * x_end, y_low + (i + 0.5) * dy, 0.0);
    spans.clear();
    for (const SweptVolume& s : sweeps)
      if (const auto span = swept_span(wedge, s, poses[s.pose].point(p), poses[s.pose].direction(Vec3(0, 0, 1))))
        spans.push_back(*span);
    volume += -std::min(0.0, surface_along(spans, 0.0).top) * dy * 2.0 * x_end;
  }
  return volume;
}

Tool tool_of_width(double width_mm) {
  Tool tool;
  tool.width_mm = width_mm;
  return tool;
}

/// At A = 0, the tool plunges to a depth and then ploughs. This makes a slot with the shape of the clearance face at
/// one end and of the rake face at the other end.
TEST(Cutting, VolumeOfASlot) {
  const Machine ideal = machine("ideal");
  const ToolWedge wedge = tool_wedge(tool_of_width(1.0), ideal, Angle::from_deg(90));
  const double depth = 0.1;
  const std::vector<SweptVolume> sweeps = {sweep_of({0, 0, 0.2}, {0, 0, -depth}),
                                           sweep_of({0, 0, -depth}, {0, -0.6, -depth})};
  const std::vector<RigidMotion> poses = {machine_from_workpiece(ideal, {0, 0})};
  // The plunge leaves a vertical wall at y = 0. The plough ends with the rake face, at 53 degrees to the vertical.
  const double analytic = depth * 0.6 + 0.5 * depth * depth * std::tan(Angle::from_deg(53).rad());
  const double end = -0.6 - depth * std::tan(Angle::from_deg(53).rad());
  const double whole = volume_by_lines(sweeps, poses, wedge, 0.5, -0.6, 0.0, 1);
  const double ramp = volume_by_lines(sweeps, poses, wedge, 0.5, end, -0.6, 1);
  EXPECT_NEAR(whole + ramp, analytic, 1e-9 * analytic);
}

/// Two plunges on an ideal machine cut a right prism with the volume base^2 / 4 times the width.
TEST(Cutting, VolumeOfAPrism) {
  const Machine ideal = machine("ideal");
  const ToolWedge wedge = tool_wedge(tool_of_width(0.5), ideal, Angle::from_deg(90));
  const std::vector<RigidMotion> poses = {machine_from_workpiece(ideal, {45, 0}),
                                          machine_from_workpiece(ideal, {45, 180})};
  const double base = 0.5;
  const Vec3 root(0, 0, -0.25);
  const std::vector<SweptVolume> sweeps = {sweep_of(poses[0].point(root) + Vec3(0, 0, 0.6), poses[0].point(root), 0),
                                           sweep_of(poses[1].point(root) + Vec3(0, 0, 0.6), poses[1].point(root), 1)};
  const double left = volume_by_lines(sweeps, poses, wedge, 0.25, -0.25, 0.0, 1);
  const double right = volume_by_lines(sweeps, poses, wedge, 0.25, 0.0, 0.25, 1);
  EXPECT_NEAR(left + right, 0.25 * base * base * 0.5, 1e-9 * 0.03125);
}

/// Prisms whose apertures overlap by a quarter of the base have a smaller prism in common.
TEST(Cutting, VolumeOfOverlappingPrisms) {
  const Machine ideal = machine("ideal");
  const ToolWedge wedge = tool_wedge(tool_of_width(0.5), ideal, Angle::from_deg(90));
  const std::vector<RigidMotion> poses = {machine_from_workpiece(ideal, {45, 0}),
                                          machine_from_workpiece(ideal, {45, 180})};
  const double base = 0.5;
  const double shift = 0.75 * base;
  std::vector<SweptVolume> sweeps;
  for (const double y : {0.0, shift})
    for (std::uint32_t pose : {0U, 1U}) {
      const Vec3 tip = poses[pose].point(Vec3(0, y, -0.25));
      sweeps.push_back(sweep_of(tip + Vec3(0, 0, 0.6), tip, pose));
    }
  const double shared = base - shift;
  const double analytic = (2.0 * 0.25 * base * base - 0.25 * shared * shared) * 0.5;
  double volume = 0.0;
  for (const auto& [from, to] : {std::pair{-0.25, 0.0}, {0.0, 0.1875}, {0.1875, 0.375}, {0.375, 0.625}})
    volume += volume_by_lines(sweeps, poses, wedge, 0.25, from, to, 1);
  EXPECT_NEAR(volume, analytic, 1e-9 * analytic);
}

/// The part of a line in a swept body must agree with a test of single points: a point is swept if the tool contains it
/// at some position along its path.
RC_GTEST_PROP(Cutting, SpansAgreeWithMembership, ()) {
  const ToolWedge wedge = tool_wedge(tool_of_width(0.5), machine("ideal"), Angle::from_deg(90));
  const auto coordinate = [] { return 1e-4 * *rc::gen::inRange(-10000, 10001); };
  const auto vector = [&] {
    const double x = coordinate();
    const double y = coordinate();
    return Vec3(x, y, coordinate());
  };
  const SweptVolume sweep = sweep_of(vector(), vector());
  const Vec3 point = vector();
  const Vec3 direction = (vector() + Vec3(0, 0, 2)).normalized();
  const auto span = swept_span(wedge, sweep, point, direction);
  const auto is_swept = [&](const Vec3& p) {
    // Each side of the wedge bounds the path parameter t, which is 0 at the start of the move and 1 at its end. The
    // point is swept if a value of t satisfies all bounds.
    double low = 0.0;
    double high = 1.0;
    for (const auto& side : wedge.sides) {
      const double room = side.bound_mm - side.outward.dot(p - sweep.from_mm);
      const double rate = side.outward.dot(sweep.to_mm - sweep.from_mm);
      if (rate > 0.0)
        low = std::max(low, -room / rate);
      else if (rate < 0.0)
        high = std::min(high, room / -rate);
      else if (room < 0.0)
        return false;
    }
    return low <= high;
  };
  for (int i = -20; i <= 20; ++i) {
    const double s = 0.15 * i + 0.0123;
    const bool in_span = span && s >= span->low && s <= span->high;
    const bool near_end = span && (std::abs(s - span->low) < 1e-9 || std::abs(s - span->high) < 1e-9);
    RC_ASSERT(near_end || in_span == is_swept(point + s * direction));
  }
}

/// Tests whether convex hulls intersect: a tetrahedron, and a box that approaches one of its faces.
TEST(Bodies, HullsMeetWhereTheyDo) {
  const std::vector<Vec3> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto cube_at = [](double corner) {
    std::vector<Vec3> cube;
    for (int i = 0; i < 8; ++i)
      cube.emplace_back(corner + ((i & 1) != 0 ? 0.5 : 0.0), corner + ((i & 2) != 0 ? 0.5 : 0.0),
                        corner + ((i & 4) != 0 ? 0.5 : 0.0));
    return cube;
  };
  // The box intersects the tetrahedron until `corner` exceeds 1 / 3, where the box passes the face x + y + z = 1. The
  // bounding boxes overlap until `corner` exceeds 1.
  for (const double corner : {0.0, 0.2, 0.333}) EXPECT_TRUE(hulls_meet(tetrahedron, cube_at(corner))) << corner;
  for (const double corner : {0.334, 0.4, 0.9, 1.5}) EXPECT_FALSE(hulls_meet(tetrahedron, cube_at(corner))) << corner;
  EXPECT_FALSE(hulls_meet(cube_at(-0.501), tetrahedron));
  EXPECT_TRUE(hulls_meet(cube_at(-0.499), tetrahedron));
}

/// Tests random pairs of convex hulls. Hulls on opposite sides of a plane do not intersect, and hulls with a common
/// point do.
RC_GTEST_PROP(Bodies, HullsAgreeWithPlanesBetweenThem, ()) {
  const auto coordinate = [] { return 1e-3 * *rc::gen::resize(100, rc::gen::inRange(-1000, 1001)); };
  const auto vector = [&] {
    const double x = coordinate();
    const double y = coordinate();
    return Vec3(x, y, coordinate());
  };
  const Vec3 normal = (vector() + Vec3(0, 0, 2)).normalized();
  const double gap = 1e-3 * *rc::gen::inRange(1, 500);
  std::vector<Vec3> below;
  std::vector<Vec3> above;
  for (int i = 0; i < 6; ++i) {
    const Vec3 a = vector();
    const Vec3 b = vector();
    below.push_back(a - normal * (std::max(normal.dot(a), 0.0) + 0.5 * gap));
    above.push_back(b + normal * (std::max(-normal.dot(b), 0.0) + 0.5 * gap));
  }
  RC_ASSERT(!hulls_meet(below, above));
  // Move the hulls such that both contain a common point.
  const Vec3 to = above[0] - (below[0] + below[1] + below[2] + below[3]) * 0.25;
  for (Vec3& p : below) p += to;
  above.push_back(above[0] + Vec3(0.1, 0, 0));
  above.push_back(above[0] - Vec3(0.1, 0, 0));
  RC_ASSERT(hulls_meet(below, above));
}

/// Collects the swept volumes of programs, for dexels.
struct Cut {
  std::vector<SweptVolume> sweeps;
  std::vector<RigidMotion> poses;
  ToolWedge wedge;
};

struct SweptVolumeSink : NcSink {
  explicit SweptVolumeSink(const Machine& m) : machine_of(m) {}
  void motion(const NcMotion& m, const NcSettings&) override {
    if ((m.known | m.moved) != 31 || (m.moved & 24) != 0) return;
    cut.poses.push_back(machine_from_workpiece(machine_of, {m.to.a_deg, m.to.c_deg}));
    cut.sweeps.push_back(sweep_of(machine_point(machine_of, m.from), machine_point(machine_of, m.to),
                                  static_cast<std::uint32_t>(cut.poses.size() - 1)));
  }
  void dwell(double, const NcLocation&, const AxisPositions&) override {}
  const Machine& machine_of;
  Cut cut;
};

Cut cut_of(const std::string& text, const Job& job, const Machine& m, NcDialect dialect = NcDialect::rs274ngc) {
  SweptVolumeSink sink(m);
  sink.cut.wedge = tool_wedge(job.tool, m, Angle::from_deg(prism_of(job).apex_angle_deg));
  run_nc(parse_nc(text, "p", dialect, control_texts()), sink);
  return sink.cut;
}

DexelBox box_around(double half_x, double half_y, double depth) {
  return {{-half_x, -half_y, -depth}, {half_x, half_y, 0.0}};
}

/// Dexels along all three axes must agree, within their resolution, with the volume from cutting by planes.
TEST(Cutting, DexelsAgreeInVolume) {
  Job job = square_job(2, Arrangement::checker);
  job.process.roughing_depth_um = 50;
  const Machine paper = machine("paper");
  std::string text;
  for (const Program& program : make_plan(job, paper).programs) text += nc_text(program, "rs274ngc");
  const Verification v = verify_programs(job, paper, {parse_nc(text, "p", NcDialect::rs274ngc)}, {}, {});
  ASSERT_TRUE(v.passes());
  const Cut cut = cut_of(text, job, paper);
  for (const int axis : {0, 1, 2}) {
    const DexelField field = cut_dexels(cut.sweeps, cut.poses, cut.wedge, box_around(0.451, 0.451, 0.23), axis, 127);
    // The tolerance is half of a cell of 7 um. No row of cells is parallel to a slope, so the errors have both signs.
    EXPECT_NEAR(field.volume_mm3(), v.removed_volume_mm3, 0.005 * v.removed_volume_mm3) << "axis " << axis;
  }
}

/// The error field must agree with the exact values. For correct programs, it shows only unavoidable errors. If an
/// element is too high, the field shows the height error at the position of that element.
TEST(Cutting, TheErrorFieldShowsFaultsWhereTheyAre) {
  Job job = square_job(2, Arrangement::aligned);
  job.process.roughing_depth_um = 50;
  const Machine ideal = machine("ideal");
  std::vector<Program> programs = make_plan(job, ideal).programs;
  const auto field_of = [&] {
    std::vector<NcProgram> parsed;
    for (const Program& program : programs)
      parsed.push_back(parse_nc(nc_text(program, "rs274ngc"), "p", NcDialect::rs274ngc));
    return error_field(job, ideal, parsed, 40);
  };
  const ErrorField right = field_of();
  EXPECT_EQ(right.columns, 40U);
  EXPECT_EQ(right.rows, 40U);
  for (const double nm : right.height_nm) EXPECT_NEAR(nm, 0.0, 1.5);
  // Element 1 is at larger x of the part, which is -y of the workpiece. In the picture, it is in the lower half, x_w <
  // 0.
  for (Program& program : programs)
    for (Item& item : program.items)
      if (auto* visit = std::get_if<CycleCall>(&item))
        if (visit->element == 1) visit->start.y() += 200;
  const ErrorField wrong = field_of();
  double inside_nm = 0.0;
  double outside_nm = 0.0;
  for (std::size_t row = 0; row < wrong.rows; ++row)
    for (std::size_t column = 0; column < wrong.columns; ++column) {
      const double nm = std::abs(wrong.height_nm[row * wrong.columns + column]);
      double& worst = row >= 20 && column < 20 ? inside_nm : outside_nm;
      worst = std::max(worst, nm);
    }
  EXPECT_NEAR(inside_nm, 200.0, 2.0);
  EXPECT_LT(outside_nm, 1.5);
}

/// Parameters of a test that changes single tokens of a program at random.
struct Mutated {
  Arrangement arrangement;
  Strategy strategy;
  std::string machine;
  NcDialect dialect;
  std::uint64_t seed;
};

class Mutations : public ::testing::TestWithParam<Mutated> {};

/// Every change that moves the surface by more than 10 nm is refused or reported.
TEST_P(Mutations, NoneThatMovesTheSurfaceGoesUnreported) {
  const Mutated& p = GetParam();
  Job job = square_job(p.arrangement == Arrangement::single ? 1 : 2, p.arrangement);
  job.strategy = p.strategy;
  job.process.roughing_depth_um = 50;
  job.process.finishing_cuts = 1;
  const std::string word(kNcDialectWords[static_cast<std::size_t>(p.dialect)]);
  const Machine m = for_dialect(machine(p.machine), word);
  std::string text;
  for (const Program& program : make_plan(job, m).programs) text += nc_text(program, word);
  const auto field_of = [&](const std::string& program) {
    const Cut cut = cut_of(program, job, m, p.dialect);
    return cut_dexels(cut.sweeps, cut.poses, cut.wedge, box_around(0.6, 0.6, 1.0), 2, 120);
  };
  const DexelField before = field_of(text);
  std::uint64_t state = p.seed;
  const auto draw = [&](std::size_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state >> 33) % below);
  };
  // Comments and messages are not tokens of the program.
  std::vector<std::size_t> places;
  bool is_comment = false;
  for (std::size_t i = 0, depth = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ';' || text[i] == '\'' || text.compare(i, 2, "//") == 0) is_comment = true;
    if (text[i] == '\n') is_comment = false;
    if (depth == 0 && !is_comment && text[i] != '\n' && text[i] != ' ' && text[i] != '%') places.push_back(i);
    if (text[i] == ')') --depth;
  }
  int refused = 0;
  int found = 0;
  int moved = 0;
  int harmless = 0;
  for (int trial = 0; trial < 100; ++trial) {
    std::string mutant = text;
    const std::size_t at = places[draw(places.size())];
    const char old = mutant[at];
    if (old >= '0' && old <= '9')
      mutant[at] = static_cast<char>('0' + (static_cast<std::size_t>(old - '0') + 1 + draw(9)) % 10);
    else if (old == '-')
      mutant.erase(at, 1);
    else if (old == '.')
      mutant.erase(at, 1);
    else
      mutant[at] = "GXYZACFMPo"[draw(10)];
    if (mutant == text) continue;
    bool is_reported = false;
    try {
      const Verification v = verify_programs(job, m, {parse_nc(mutant, "p", p.dialect, control_texts())}, {}, {});
      is_reported = !v.passes();
      is_reported ? ++found : ++harmless;
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    const DexelField after = field_of(mutant);
    double worst_mm = 0.0;
    for (std::size_t i = 0; i < before.lowest_mm.size(); ++i) {
      worst_mm = std::max(worst_mm, std::abs(before.lowest_mm[i] - after.lowest_mm[i]));
      worst_mm = std::max(worst_mm, std::abs(before.removed_mm[i] - after.removed_mm[i]));
    }
    // Maximum change that may go unreported: 10 nm normal to a facet, which are sqrt(2) times as much along z, plus
    // rounding.
    const double kMostMm = (1e-5 + 1e-12) * std::sqrt(2.0);
    if (worst_mm > kMostMm) ++moved;
    EXPECT_TRUE(is_reported || worst_mm <= kMostMm)
        << "trial " << trial << ": " << text.substr(at > 20 ? at - 20 : 0, 40) << " became "
        << mutant.substr(at > 20 ? at - 20 : 0, 40) << ", which moves the surface by " << worst_mm * 1e6 << " nm";
  }
  EXPECT_GT(moved, 10) << "the mutations do something";
  EXPECT_GT(found, 10);
  EXPECT_GT(refused, 5);
}

INSTANTIATE_TEST_SUITE_P(
    Programs, Mutations,
    ::testing::Values(Mutated{Arrangement::checker, Strategy::two_step, "paper", NcDialect::rs274ngc, 12345},
                      Mutated{Arrangement::offset, Strategy::unidirectional, "thesis", NcDialect::sinumerik, 2},
                      Mutated{Arrangement::single, Strategy::bidirectional, "paper", NcDialect::fanuc, 3},
                      Mutated{Arrangement::aligned, Strategy::two_step, "ideal", NcDialect::pmac, 4},
                      Mutated{Arrangement::checker, Strategy::unidirectional, "paper", NcDialect::a3200, 5},
                      Mutated{Arrangement::single, Strategy::two_step, "thesis", NcDialect::automation1, 6}));

}  // namespace
}  // namespace retrace::fabrication::test::cutting_test
