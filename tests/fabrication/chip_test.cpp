#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/chip_check.h"
#include "fabrication/chisel/check/simulation/convex_polygons.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/substrate_jobs.h"

// Tests of the chip thickness. It is compared with closed forms for known geometry, and must be within its limit for
// correct programs of jobs of every kind.

namespace retrace::fabrication::test::chip_test {
namespace {

using geometry::Arrangement;
using geometry::Vec2;
using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

Verification verified(const Job& job, const Machine& m) {
  std::vector<NcProgram> programs;
  for (const Program& program : make_plan(job, m).programs)
    programs.push_back(parse_nc(nc_text(program, "rs274ngc"), "p.ngc", NcDialect::rs274ngc));
  return verify_programs(job, m, programs, {}, {});
}

double area(const ConvexPolygon& piece) {
  double sum = 0.0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2& a = piece[i];
    const Vec2& b = piece[(i + 1) % piece.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

bool holds(const ConvexPolygon& piece, const Vec2& p) {
  bool inside = !piece.empty();
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2 side = piece[(i + 1) % piece.size()] - piece[i];
    inside = inside && side.x() * (p - piece[i]).y() - side.y() * (p - piece[i]).x() >= 0.0;
  }
  return inside;
}

int count_of(const std::vector<ConvexPolygon>& pieces, const Vec2& p) {
  return static_cast<int>(
      std::count_if(pieces.begin(), pieces.end(), [&](const auto& piece) { return holds(piece, p); }));
}

/// Tests subtract(), which divides polygons into pieces inside a body (removed) and outside it (remaining). The areas
/// of all pieces must add up to the original area. Pieces must not overlap, and the removed pieces must be inside the
/// body.
RC_GTEST_PROP(Chips, TakingAwayKeepsTheArea, ()) {
  const auto number = [] { return 1e-4 * *rc::gen::inRange(-10000, 10001); };
  std::vector<ConvexPolygon> pieces = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  double taken_area = 0.0;
  for (int cut = 0; cut < 6; ++cut) {
    std::vector<HalfPlane> body;
    const Vec2 middle(number(), number());
    for (int side = 0; side < 4; ++side) {
      const double angle = 0.5 * M_PI * side + number();
      const Vec2 outward(std::cos(angle), std::sin(angle));
      body.push_back({outward, outward.dot(middle) + 0.3 * std::abs(number())});
    }
    const std::vector<ConvexPolygon> before = pieces;
    const std::vector<ConvexPolygon> taken = subtract(pieces, body);
    for (const ConvexPolygon& piece : taken) taken_area += area(piece);
    for (int k = 0; k < 20; ++k) {
      const Vec2 p(number(), number());
      const double nearest = std::abs(std::max_element(body.begin(), body.end(), [&](const auto& a, const auto& b) {
                                        return a.signed_distance_mm(p) < b.signed_distance_mm(p);
                                      })->signed_distance_mm(p));
      if (nearest < 1e-7 || count_of(before, p) == 0) continue;
      const bool in_body =
          std::all_of(body.begin(), body.end(), [&](const auto& side) { return side.signed_distance_mm(p) < 0.0; });
      RC_ASSERT(count_of(in_body ? taken : pieces, p) >= 1);
      RC_ASSERT(count_of(in_body ? pieces : taken, p) == 0);
    }
  }
  double left_area = 0.0;
  for (const ConvexPolygon& piece : pieces) left_area += area(piece);
  RC_ASSERT(std::abs(left_area + taken_area - 4.0) < 1e-7);
}

/// The part of a line inside a swept body must agree with the part that follows from the half-spaces of the body.
RC_GTEST_PROP(Chips, HalfSpacesOfASweepHoldItsLines, ()) {
  const auto number = [] { return 1e-4 * *rc::gen::inRange(-10000, 10001); };
  const auto vector = [&] { return Vec3(number(), number(), number()); };
  Tool tool;
  tool.width_mm = 0.5;
  const ToolWedge wedge = *rc::gen::arbitrary<bool>() ? tool_wedge(tool, machine("ideal"), Angle::from_deg(90))
                                                      : v_tool_wedge(Tool{}, machine("ideal-dmc"));
  const SweptVolume sweep{0, {1, 0}, false, vector(), vector()};
  const Vec3 point = vector();
  const Vec3 direction = (vector() + Vec3(0, 0, 2)).normalized();
  double low = -1e3;
  double high = 1e3;
  for (const ToolWedge::Side& side : swept_sides(wedge, sweep)) {
    const double rate = side.outward.dot(direction);
    const double room = side.bound_mm - side.outward.dot(point);
    if (rate > 1e-9) high = std::min(high, room / rate);
    if (rate < -1e-9) low = std::max(low, room / rate);
    if (std::abs(rate) <= 1e-9 && room < 0.0) high = low;
  }
  const auto span = swept_span(wedge, sweep, point, direction);
  if (!span) {
    RC_ASSERT(high - low < 1e-6);
    return;
  }
  RC_ASSERT(std::abs(std::max(span->low, -1e3) - low) < 1e-6);
  RC_ASSERT(std::abs(std::min(span->high, 1e3) - high) < 1e-6);
}

/// The tip moves one depth of cut beyond the facet that it is not cutting. The rake face, at 53 degrees to the wall,
/// then removes a chip whose thickness is tan 53 degrees times this depth.
TEST(Chips, ThickestOfRightProgramsIsThatOfTheRakeFace) {
  const double slope = std::tan(53.0 * M_PI / 180.0);
  Job job = square_job(1);
  job.strategy = Strategy::bidirectional;
  EXPECT_NEAR(verified(job, machine("ideal")).chip_um_max, 15.0 * slope, 2e-3);
  job.process.roughing_depth_um = 5.0;
  EXPECT_NEAR(verified(job, machine("ideal")).chip_um_max, 5.0 * slope, 2e-3);
  job.strategy = Strategy::unidirectional;
  EXPECT_NEAR(verified(job, machine("ideal")).chip_um_max, 5.0, 2e-3);
  job.strategy = Strategy::two_step;
  EXPECT_NEAR(verified(job, machine("ideal")).chip_um_max, 5.0 * slope, 2e-3);
}

/// Returns a random job of prisms that is valid.
Job any_prisms() {
  Job job = square_job(*rc::gen::inRange(1, 3), *rc::gen::element(Arrangement::offset, Arrangement::checker));
  geometry::RtpElement& prism = prism_of(job);
  prism.apex_angle_deg =
      *rc::gen::weightedElement<double>({{3, 90.0}, {1, 60.0}, {1, 120.0}, {1, 0.01 * *rc::gen::inRange(6000, 12001)}});
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.tool.clearance_deg = *rc::gen::inRange(2, 11);
  job.tool.wedge_deg = wedge_deg(job, *rc::gen::inRange(0, 25));
  job.tool.edge_radius_um = *rc::gen::element(0.0, 0.0, 0.5, 3.0);
  job.tool.width_mm = *rc::gen::element(0.451, 0.451, 0.2, 0.3);
  job.workpiece.kind = *rc::gen::element(WorkpieceKind::mould, WorkpieceKind::direct);
  if (job.workpiece.kind == WorkpieceKind::mould) job.workpiece.shrinkage_percent = *rc::gen::element(0.0, 0.6, 2.0);
  Process& process = job.process;
  process.roughing_depth_um = *rc::gen::element(12.0, 15.0, 25.0, 40.0);
  process.finishing_depth_um = *rc::gen::element(2.0, 5.0, 8.0);
  process.finishing_cuts = *rc::gen::inRange(1, 4);
  process.shortest_plough = *rc::gen::arbitrary<bool>();
  process.plough_lift_um = *rc::gen::element(0.0, 2.0);
  process.slow_retract_um = *rc::gen::element(0.0, 5.0);
  return job;
}

RC_GTEST_PROP(Chips, RightProgramsOfAnyPrismsPass, ()) {
  const Job job = any_prisms();
  const Machine m = machine(*rc::gen::element<std::string>("ideal", "paper", "thesis"));
  const Verification v = verified(job, m);
  RC_TAG(v.chip_ratio_max > 0.99 ? "at the limit" : "below it");
  if (!v.passes())
    RC_FAIL(fmt::format("apex {} clearance {} wedge {} radius {} width {} strategy {} d {} f {} x {} machine {}\n{}",
                        prism_of(job).apex_angle_deg, job.tool.clearance_deg, job.tool.wedge_deg,
                        job.tool.edge_radius_um, job.tool.width_mm, static_cast<int>(job.strategy),
                        job.process.roughing_depth_um, job.process.finishing_cuts, job.process.finishing_depth_um,
                        m.name, listed(v)));
  RC_ASSERT(v.chip_ratio_max <= 1.0 + 1e-9);
}

/// Correct programs pass on blanks with curved or inclined faces. If the axes of the elements are parallel, such a
/// blank extends above the rims (upper edges) of elements.
RC_GTEST_PROP(Chips, RightProgramsOnAnyBasePass, ()) {
  const ElementAxes axes = *rc::gen::element(ElementAxes::normal, ElementAxes::parallel);
  const double radius_mm = *rc::gen::element(12.0, -12.0, 30.0, -30.0, 200.0);
  const double incline_deg = 0.1 * *rc::gen::inRange(0, 100);
  const bool is_plane = *rc::gen::arbitrary<bool>();
  const bool is_prism = *rc::gen::arbitrary<bool>();
  const Substrate base = is_plane   ? plane_substrate(incline_deg, is_prism ? 0.0 : 40.0, axes)
                         : is_prism ? cylinder_substrate(radius_mm, false, axes)
                                    : sphere_substrate(radius_mm, axes);
  Job job = is_prism ? prisms_on(base, 2) : cubes_on(base, *rc::gen::arbitrary<bool>());
  if (is_prism) job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.process.roughing_depth_um = *rc::gen::element(10.0, 15.0, 30.0);
  job.process.finishing_depth_um = *rc::gen::element(2.0, 5.0);
  job.process.finishing_cuts = *rc::gen::inRange(1, 4);
  const std::string name = is_prism ? *rc::gen::element<std::string>("ideal", "paper") : "ideal-dmc";
  try {
    const Verification v = verified(job, machine(name));
    if (!v.passes()) RC_FAIL(listed(v));
  } catch (const InputError&) {
    RC_TAG("refused");
  }
}

RC_GTEST_PROP(Chips, RightProgramsOfAnyCubesPass, ()) {
  Job job = cube_job(*rc::gen::arbitrary<bool>(), *rc::gen::element(0.15, 0.2));
  job.array = {};
  job.array.arrangement = Arrangement::single;
  job.process.roughing_depth_um = *rc::gen::element(5.0, 10.0, 20.0);
  job.process.finishing_depth_um = *rc::gen::element(2.0, 5.0);
  job.process.finishing_cuts = *rc::gen::inRange(1, 4);
  job.tool.wedge_deg = *rc::gen::inRange(60, 67);
  const Verification v = verified(job, machine("ideal-dmc"));
  if (!v.passes()) RC_FAIL(listed(v));
  RC_ASSERT(v.chip_ratio_max <= 1.0 + 1e-9);
}

}  // namespace
}  // namespace retrace::fabrication::test::chip_test
