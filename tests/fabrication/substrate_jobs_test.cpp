#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/simulation/dexel.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/part/part.h"
#include "tests/fabrication/substrate_programs.h"
#include "tests/fabrication/swept_volume_sink.h"
#include "tests/support/refusals.h"

// Tests of jobs with elements on inclined, curved and freeform substrates. The positions of the elements are compared
// with their positions in the part for ray tracing. Programs are read back and simulated.

namespace retrace::fabrication::test::substrate_jobs_test {
namespace {

using geometry::Arrangement;
using geometry::Vec2;
using geometry::Vec3;

struct Named {
  std::string what;
  Job job;
};

/// Returns jobs with prisms and with cube corners on substrates of every kind.
std::vector<Named> jobs() {
  const ElementAxes normal = ElementAxes::normal;
  const ElementAxes parallel = ElementAxes::parallel;
  std::vector<Named> all = {
      {"prisms along an incline", prisms_on(plane_substrate(12.0, 0.0, normal))},
      {"prisms along an incline the other way", prisms_on(plane_substrate(7.0, 180.0, normal))},
      {"prisms along a bulging cylinder", prisms_on(cylinder_substrate(6.0, false, normal))},
      {"prisms along a hollow cylinder", prisms_on(cylinder_substrate(-6.0, false, normal))},
      {"prisms along a formula across the roofs", prisms_on(formula_substrate("0.05*x^2 - 0.01*x^3", normal))},
      {"prisms in parallel on an incline", prisms_on(plane_substrate(8.0, 30.0, parallel))},
      {"prisms in parallel on a cylinder along the roofs", prisms_on(cylinder_substrate(9.0, true, parallel))},
      {"bricks in parallel on a sphere", prisms_on(sphere_substrate(12.0, parallel), 3, Arrangement::offset)},
      {"checker in parallel in a bowl", prisms_on(sphere_substrate(-12.0, parallel), 3, Arrangement::checker)},
      {"prisms in parallel on a formula", prisms_on(formula_substrate("0.03*sin(3*x)*cos(2*y)", parallel))},
  };
  for (const bool is_hexagonal : {false, true}) {
    const std::string kind = is_hexagonal ? "hexagons " : "triangles ";
    all.push_back({kind + "along an incline", cubes_on(plane_substrate(6.0, 40.0, normal), is_hexagonal)});
    all.push_back({kind + "along a cylinder", cubes_on(cylinder_substrate(3.0, false, normal), is_hexagonal)});
    all.push_back(
        {kind + "in parallel on a cylinder", cubes_on(cylinder_substrate(-3.0, true, parallel), is_hexagonal)});
    all.push_back({kind + "along a sphere", cubes_on(sphere_substrate(-4.0, normal), is_hexagonal)});
    all.push_back(
        {kind + "in parallel on a formula", cubes_on(formula_substrate("0.1*x + 0.1*x*y", parallel), is_hexagonal)});
  }
  return all;
}

/// The positions and the facet planes of the elements of a job equal the positions and facet planes in the part for ray
/// tracing.
TEST(OnSubstrate, ElementsStandWhereThePartHasThem) {
  for (const Named& named : jobs()) {
    SCOPED_TRACE(named.what);
    geometry::PartSpec spec = part_on_substrate(named.job);
    spec.thickness_mm = 2.0;
    const geometry::Part part = geometry::build_part(spec);
    const std::vector<CutElement> elements = cut_elements(named.job);
    EXPECT_EQ(static_cast<std::int64_t>(elements.size()), part.elements_full);
    const auto* const prism = std::get_if<geometry::RtpElement>(&named.job.element);
    std::vector<Cavity> grooves;
    for (const CutElement& element : elements)
      grooves.push_back(prism != nullptr ? Cavity(groove_of(element, *prism)) : cavity_of(element, named.job.element));
    const geometry::BoundaryMesh mesh = geometry::closed_boundary(part);
    std::set<std::pair<std::size_t, std::size_t>> seen;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.roles[t] != geometry::FacetRole::retro_facet) continue;
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh.vertices[mesh.triangles[t][k]];
        corners[k] = {p.y() - 0.5 * spec.array.y_length_mm, 0.5 * spec.array.x_length_mm - p.x(), p.z()};
      }
      const Vec3 across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (across.norm() < 1e-9) continue;
      const Vec3 into_cavity = -across.normalized();
      double nearest = 1.0;
      for (std::size_t i = 0; i < grooves.size(); ++i)
        for (std::size_t f = 0; f < common(grooves[i]).facets.size(); ++f) {
          const DesignFacet& facet = common(grooves[i]).facets[f];
          if (facet.normal.dot(into_cavity) < 1.0 - 1e-9) continue;
          double off = 0.0;
          for (const Vec3& corner : corners) off = std::max(off, std::abs(facet.height_mm(corner)));
          if (off < 1e-9) seen.insert({i, f});
          nearest = std::min(nearest, off);
        }
      EXPECT_LT(nearest, 1e-9);
    }
    EXPECT_EQ(seen.size(), grooves.size() * (prism != nullptr ? 2U : 3U)) << "every facet is one of the part's";
  }
}

TEST(OnSubstrate, ProgramsVerifyBelowANanometre) {
  for (const Named& named : jobs()) {
    SCOPED_TRACE(named.what);
    const Verification v = verified(named.job, text_of(named.job));
    EXPECT_TRUE(v.passes()) << listed(v);
    EXPECT_EQ(v.elements_cut, static_cast<std::int64_t>(cut_elements(named.job).size()));
    EXPECT_GE(v.elements_cut, 8);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
    EXPECT_LT(v.facet_angle_arcmin_max, 0.02);
    EXPECT_LT(v.root_residual_nm_max, 5.0);
    EXPECT_LT(v.wall_overcut_nm_max, 1.0);
    if (named.job.strategy == Strategy::dmc) continue;
    EXPECT_NEAR(v.removed_volume_mm3, static_cast<double>(v.elements_cut) * std::pow(0.451, 3) / 4.0, 1e-5);
  }
}

TEST(OnSubstrate, AllStrategiesCutPrismsAlongACylinder) {
  for (const Strategy strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step})
    for (const double radius_mm : {5.0, -5.0}) {
      Job job = prisms_on(cylinder_substrate(radius_mm, false, ElementAxes::normal));
      job.strategy = strategy;
      job.tool.width_mm = 0.3;
      const Verification v = verified(job, text_of(job));
      EXPECT_TRUE(v.passes()) << static_cast<int>(strategy) << " " << radius_mm << "\n" << listed(v);
      EXPECT_LT(v.facet_distance_nm_max, 1.0);
    }
}

/// Jobs with rarely used keys pass the verification on substrates, as they do on a plane.
TEST(OnSubstrate, VariantsVerifyAsOnAPlane) {
  const std::vector<std::pair<std::string, std::function<void(Job&)>>> variants = {
      {"shrinkage", [](Job& job) { job.workpiece.shrinkage_percent = 2.0; }},
      {"gaps", [](Job& job) { job.array.x_gap_mm = job.array.y_gap_mm = 0.03; }},
      {"narrow apex", [](Job& job) { prism_of(job).apex_angle_deg = 80.0; }},
      {"wide apex", [](Job& job) { prism_of(job).apex_angle_deg = 95.0; }},
      {"blunt edge", [](Job& job) { job.tool.edge_radius_um = 0.5; }},
      {"short ploughs", [](Job& job) { job.process.shortest_plough = true; }},
      {"slow retract", [](Job& job) { job.process.slow_retract_um = 4.0; }},
      {"two passes", [](Job& job) { job.tool.width_mm = 0.25; }}};
  for (const auto& [what, change] : variants)
    for (const Substrate& substrate :
         {cylinder_substrate(-6.0, false, ElementAxes::normal), sphere_substrate(10.0, ElementAxes::parallel)}) {
      Job job = prisms_on(substrate);
      job.array.x_length_mm = job.array.y_length_mm = 1.5;
      change(job);
      const Verification v = verified(job, text_of(job));
      EXPECT_TRUE(v.passes()) << what << "\n" << listed(v);
      EXPECT_GE(v.elements_cut, 9) << what;
      // The positions of tips are rounded to 1 nm. If the apex angle is greater than 90 degrees, this leaves a burr of
      // a few nanometres at the root.
      EXPECT_LT(v.facet_distance_nm_max, what == "wide apex" ? 4.0 : 1.0) << what;
    }
  Job large = cubes_on(sphere_substrate(4.0, ElementAxes::normal), true);
  large.workpiece.shrinkage_percent = 5.0;
  EXPECT_TRUE(verified(large, text_of(large)).passes());
}

/// A job on an inclined plane is either refused or cut correctly, for every direction of the slope.
TEST(OnSubstrate, EveryInclineIsRefusedOrCutRight) {
  int refused = 0;
  int cut = 0;
  for (const double incline_deg : {3.0, 9.0, 14.0, 19.0, 24.0, 29.0, 33.0})
    for (double azimuth_deg = 0.0; azimuth_deg < 360.0; azimuth_deg += 24.0) {
      Job job = cubes_on(plane_substrate(incline_deg, azimuth_deg, ElementAxes::normal), false);
      job.process.roughing_depth_um = 40.0;
      std::string text;
      try {
        text = text_of(job);
      } catch (const InputError&) {
        ++refused;
        continue;
      }
      const Verification v = verified(job, text);
      EXPECT_TRUE(v.passes()) << incline_deg << " towards " << azimuth_deg << "\n" << listed(v);
      EXPECT_LT(v.facet_distance_nm_max, 1.0) << incline_deg << " towards " << azimuth_deg;
      ++cut;
    }
  EXPECT_GT(refused, 20);
  EXPECT_GT(cut, 40);
  for (const double incline_deg : {10.0, 20.0, 30.0, 42.0}) {
    const Job job = prisms_on(plane_substrate(incline_deg, 180.0, ElementAxes::normal));
    const Verification v = verified(job, text_of(job));
    EXPECT_TRUE(v.passes()) << incline_deg << "\n" << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0) << incline_deg;
  }
}

TEST(OnSubstrate, SplitProgramsVerifyTogether) {
  const Job job = cubes_on(sphere_substrate(4.0, ElementAxes::normal), false);
  PlanOptions options;
  options.split_hours = 0.05;
  options.stop_every = 5;
  const Plan plan = make_plan(job, for_dialect(machine("ideal-dmc"), "fanuc"), options);
  ASSERT_GT(plan.programs.size(), 2U);
  std::vector<NcProgram> programs;
  for (const Program& program : plan.programs) {
    EXPECT_LT(program.subroutines.size(), plan.subroutines.size());
    programs.push_back(parse_nc(nc_text(program, "fanuc"), program.name, NcDialect::fanuc));
  }
  const Verification v = verify_programs(job, machine("ideal-dmc"), programs, {}, {});
  EXPECT_TRUE(v.passes()) << listed(v);
}

/// On a machine with measured axis errors, deviations on a substrate are as small as on a plane.
TEST(OnSubstrate, MeasuredAxesAreAllowedFor) {
  for (const char* const name : {"paper", "thesis"}) {
    const Machine m = machine(name);
    for (const Substrate& substrate :
         {plane_substrate(9.0, 0.0, ElementAxes::normal), cylinder_substrate(8.0, true, ElementAxes::parallel)}) {
      const Job job = prisms_on(substrate);
      const Plan plan = make_plan(job, m);
      const Verification v = verify_programs(
          job, m, {parse_nc(nc_text(plan.programs.front(), "rs274ngc"), "p", NcDialect::rs274ngc)}, {}, {});
      EXPECT_TRUE(v.passes()) << name << "\n" << listed(v);
      EXPECT_LT(v.facet_distance_nm_max, 5.0) << name;
    }
  }
}

/// On a machine with a tilting head (axis B), axis errors are compensated on a substrate as well as on a flat blank.
/// The remaining errors only rotate the tool slightly in the plane of the facets.
TEST(OnSubstrate, MeasuredAxesOfAHeadAreAllowedFor) {
  Machine m = machine("ideal-dmc");
  m.name = "crooked";
  m.a.direction.value = Vec3(0.0013, 1.0, -0.0021).normalized();
  m.a.point_mm.value = {0.2, -0.1, 90.0};
  m.c.direction.value = Vec3(-0.0008, 0.0011, 1.0).normalized();
  m.c.point_mm.value = {0.3, 0.15, -2.0};
  for (const bool is_hexagonal : {false, true}) {
    const Job job = cubes_on(sphere_substrate(5.0, ElementAxes::normal), is_hexagonal);
    const std::string text = nc_text(make_plan(job, m).programs.front(), "rs274ngc");
    const Verification v = verify_programs(job, m, {parse_nc(text, "p", NcDialect::rs274ngc)}, {}, {});
    EXPECT_TRUE(v.passes()) << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
    // The program must fail on a machine without these errors.
    EXPECT_FALSE(verified(job, text).passes());
  }
}

TEST(OnSubstrate, EveryDialectCutsTheSame) {
  for (const Job& job : {prisms_on(cylinder_substrate(6.0, false, ElementAxes::normal)),
                         cubes_on(sphere_substrate(4.0, ElementAxes::normal), false)}) {
    const Verification first = verified(job, text_of(job));
    for (const auto& [name, dialect] :
         {std::pair{"sinumerik", NcDialect::sinumerik}, std::pair{"fanuc", NcDialect::fanuc},
          std::pair{"pmac", NcDialect::pmac}, std::pair{"a3200", NcDialect::a3200},
          std::pair{"automation1", NcDialect::automation1}}) {
      const Verification v = verified(job, text_of(job, name), dialect);
      EXPECT_TRUE(v.passes()) << name << "\n" << listed(v);
      // A Fanuc program has one digit less in the positions of rotary axes. A modulo axis rotates in the shorter
      // direction, and its position is a sum of words. Results therefore differ slightly.
      const bool is_fanuc = dialect == NcDialect::fanuc;
      EXPECT_NEAR(v.facet_distance_nm_max, first.facet_distance_nm_max, is_fanuc ? 0.5 : 1e-6) << name;
      EXPECT_NEAR(v.removed_volume_mm3, first.removed_volume_mm3, is_fanuc ? 1e-6 : 1e-12) << name;
      EXPECT_NEAR(v.time.total_s(), first.time.total_s(), 1e-3 * first.time.total_s()) << name;
    }
  }
}

/// Returns all moves of the plan of a job.
std::vector<PlannedMove> moves_of(const Job& job) {
  std::vector<PlannedMove> moves;
  const Plan plan = make_plan(job, machine_of(job));
  for (const Program& program : plan.programs)
    for_each_move(program, [&](const PlannedMove& move) { moves.push_back(move); });
  return moves;
}

std::vector<Job> flat_jobs() {
  Job cubes = cube_job(true, 0.15);
  cubes.array.pattern.clear();
  return {square_job(3), square_job(3, Arrangement::checker), cubes, cube_job(false, 0.15)};
}

/// If the substrate is a plane at z = 0, all words equal those of the flat array exactly.
TEST(OnSubstrate, APlaneGivenAsAFormulaMovesAsTheFlatArray) {
  for (Job job : flat_jobs()) {
    const std::vector<PlannedMove> flat = moves_of(job);
    for (const ElementAxes element_axes : {ElementAxes::normal, ElementAxes::parallel})
      for (const Substrate& substrate :
           {formula_substrate("0*x", element_axes), plane_substrate(0.0, 0.0, element_axes)}) {
        job.substrate = substrate;
        const std::vector<PlannedMove> moves = moves_of(job);
        ASSERT_EQ(moves.size(), flat.size());
        for (std::size_t k = 0; k < flat.size(); ++k) {
          ASSERT_EQ(moves[k].at, flat[k].at) << k;
          ASSERT_EQ(moves[k].move.feed_mm_per_min, flat[k].move.feed_mm_per_min) << k;
          ASSERT_EQ(moves[k].dwell_s, flat[k].dwell_s) << k;
        }
      }
  }
}

/// Position of the tool at the end of a feed move: the tool reference point in the workpiece frame, and the positions
/// of the rotary axes.
struct Cut {
  Vec3 reference_mm;
  RotaryUnits a = 0;
  RotaryUnits c = 0;
};

/// Returns the end positions of the feed moves of each element.
std::vector<std::vector<Cut>> cuts_by_element(const Job& job) {
  const Machine m = machine_of(job);
  std::vector<std::vector<Cut>> cuts(cut_elements(job).size());
  for (const PlannedMove& move : moves_of(job)) {
    if (move.is_rapid() || move.element < 0) continue;
    const auto& [x, y, z, tilt, c] = move.at;
    AxisPositions axes{millimetres(*x), millimetres(*y), millimetres(*z), 0.0, degrees(*c)};
    (m.tilt == Tilt::table ? axes.a_deg : axes.b_deg) = degrees(*tilt);
    cuts[static_cast<std::size_t>(move.element)].push_back({forward(m, axes).reference_mm, *tilt, *c});
  }
  return cuts;
}

TEST(OnSubstrate, AHugeCylinderMovesAsTheFlatArrayToAMillionth) {
  constexpr double kRounding = 1.74e-6;  // rounding of three words to 1 nm, in two programs
  for (Job job : flat_jobs()) {
    if (job.array.arrangement == Arrangement::checker) continue;  // covered by the aligned array
    const auto flat = cuts_by_element(job);
    for (const ElementAxes element_axes : {ElementAxes::normal, ElementAxes::parallel})
      for (const bool axis_is_x : {false, true})
        for (const double radius_mm : {1e7, -1e7}) {
          job.substrate = cylinder_substrate(radius_mm, axis_is_x, element_axes);
          const auto cuts = cuts_by_element(job);
          ASSERT_EQ(cuts.size(), flat.size());
          for (std::size_t i = 0; i < flat.size(); ++i) {
            ASSERT_EQ(cuts[i].size(), flat[i].size());
            for (std::size_t k = 0; k < flat[i].size(); ++k) {
              ASSERT_LT((cuts[i][k].reference_mm - flat[i][k].reference_mm).norm(), 1e-6 + kRounding);
              ASSERT_NEAR(static_cast<double>(cuts[i][k].a), static_cast<double>(flat[i][k].a), 100.0);
              const double turn = static_cast<double>(cuts[i][k].c - flat[i][k].c) / (360.0 * kRotaryUnitsPerDeg);
              ASSERT_NEAR(turn, std::round(turn), 100.0 / (360.0 * kRotaryUnitsPerDeg));
            }
          }
        }
  }
}

/// If the plane is inclined across the roof edges, each prism is cut as on a horizontal plane. A is increased or
/// decreased by the inclination.
TEST(OnSubstrate, AnInclineAcrossTheRoofsTurnsA) {
  const Plan plan = make_plan(prisms_on(plane_substrate(12.0, 0.0, ElementAxes::normal)), machine("ideal"));
  ASSERT_EQ(plan.poses.size(), 2U);
  // The part rises towards +x, which is -Y of the blank. Facet 1 faces -Y and is therefore tilted by the inclination.
  EXPECT_NEAR(plan.poses[0].rounded.a_deg, 57.0, 1e-7);
  EXPECT_NEAR(plan.poses[1].rounded.a_deg, 33.0, 1e-7);
  EXPECT_EQ(plan.poses[0].rounded.c_deg, 0.0);
  EXPECT_EQ(plan.stock_mm, 0.0);
}

/// If prisms with vertical axes are placed on an inclined plane, the blank extends above their rims by h = s (b / 2 +
/// h), with the slope s and the base b. The term s h is due to the cut, which becomes wider towards the face of the
/// blank.
TEST(OnSubstrate, TheBlankStandsOverTheRimsOfParallelElements) {
  const Job job = prisms_on(plane_substrate(10.0, 0.0, ElementAxes::parallel));
  const double slope = std::tan(Angle::from_deg(10.0).rad());
  EXPECT_NEAR(stock_mm(job, cut_elements(job)), slope * 0.2255 / (1.0 - slope), 1e-7);
  const Job bulging = prisms_on(sphere_substrate(20.0, ElementAxes::normal));
  EXPECT_EQ(stock_mm(bulging, cut_elements(bulging)), 0.0);
}

/// If a neighbour is lower by d, its cut removes material below the rim of the higher prism. The depth of this cut,
/// normal to the facet of the higher prism, is d / sqrt(2).
TEST(OnSubstrate, RimsAreCutAsDeepAsNeighboursStandLower) {
  const auto overcut_um = [](const Job& job) { return verified(job, text_of(job)).rim_overcut_um_max; };
  const double d_mm = 0.451 * std::tan(Angle::from_deg(8.0).rad());
  EXPECT_NEAR(overcut_um(prisms_on(plane_substrate(8.0, 0.0, ElementAxes::parallel))), 1e3 * d_mm / std::sqrt(2.0),
              1e-6);
  // Neighbours along the roof edge have no common rim. The ends of the tool are at the walls between them.
  EXPECT_EQ(overcut_um(prisms_on(plane_substrate(8.0, 90.0, ElementAxes::parallel))), 0.0);
  EXPECT_EQ(overcut_um(prisms_on(plane_substrate(8.0, 0.0, ElementAxes::normal))), 0.0);
  EXPECT_EQ(overcut_um(cubes_on(plane_substrate(6.0, 40.0, ElementAxes::normal), true)), 0.0);
  EXPECT_EQ(overcut_um(cubes_on(plane_substrate(6.0, 40.0, ElementAxes::normal), false)), 0.0);
}

/// Returns the height of the lowest cut of all elements at a point, and 0 where no element is cut. Each cut is extended
/// upwards without limit.
/// \param is_beside_an_end set to true if the point is at the end of a groove, and to false otherwise
double lowest_cut_mm(const std::vector<Cavity>& grooves, double x_mm, double y_mm, bool& is_beside_an_end) {
  double lowest_mm = 0.0;
  is_beside_an_end = false;
  for (const Cavity& groove : grooves) {
    double height_mm = -1e9;
    for (const DesignFacet& facet : common(groove).facets)
      height_mm =
          std::max(height_mm, (facet.offset_mm - facet.normal.head<2>().dot(Vec2(x_mm, y_mm))) / facet.normal.z());
    const auto* const prism = std::get_if<PrismGroove>(&groove);
    const double over_mm =
        prism != nullptr ? std::abs(prism->along_mm({x_mm, y_mm, height_mm})) - prism->half_width_mm : -1.0;
    if (std::abs(over_mm) < 1e-6) is_beside_an_end = true;
    if (over_mm < 0.0) lowest_mm = std::min(lowest_mm, height_mm);
  }
  return lowest_mm;
}

/// A dexel simulation of all programs gives the machined surface. At every point, it must be the lowest of the cavities
/// of all elements. The cut of an element may therefore enter a neighbour only where the cavity of the element does.
TEST(OnSubstrate, WhatIsLeftIsTheLowestOfAllCavities) {
  for (const Named& named : jobs()) {
    SCOPED_TRACE(named.what);
    const Machine m = machine_of(named.job);
    SweptVolumeSink sink(m);
    run_nc(parse_nc(text_of(named.job), "p", NcDialect::rs274ngc), sink);
    const VerificationModel workpiece = verification_model_of(named.job, m);
    const Vec2 half = 0.45 * blank_extent_mm(named.job);
    double lowest_mm = 0.0;
    for (const Cavity& groove : workpiece.cavities) lowest_mm = std::min(lowest_mm, common(groove).root_mm.z());
    const DexelBox box{{-half.x(), -half.y(), lowest_mm - 0.1}, {half.x(), half.y(), 0.0}};
    const DexelField field = cut_dexels(sink.sweeps, sink.poses, wedge_of(named.job, m), box, 2, 41);
    double worst_mm = 0.0;
    std::size_t compared = 0;
    for (std::size_t row = 0; row < field.rows; ++row)
      for (std::size_t column = 0; column < field.columns; ++column) {
        const double x =
            box.low_mm.x() + (static_cast<double>(column) + 0.5) / static_cast<double>(field.columns) * 2.0 * half.x();
        const double y =
            box.low_mm.y() + (static_cast<double>(row) + 0.5) / static_cast<double>(field.rows) * 2.0 * half.y();
        bool is_beside_an_end = false;
        const double expected_mm = lowest_cut_mm(workpiece.cavities, x, y, is_beside_an_end);
        if (is_beside_an_end) continue;
        ++compared;
        worst_mm = std::max(worst_mm, std::abs(field.lowest_mm[row * field.columns + column] - expected_mm));
      }
    EXPECT_GT(compared, 1000U);
    EXPECT_LT(worst_mm, 5e-6);
  }
}

std::string complaint(const std::function<void()>& action) {
  return refusal_of(action, "no complaint");
}

TEST(OnSubstrate, TiltsThatTheMachineCannotReachAreNamed) {
  const auto planned = [](const Job& job, const Machine& m) { return complaint([&] { make_plan(job, m); }); };
  // Angles of the expected message, derived by hand: sin(turn) = sin(tilt) / cos(A), with sin(A) = cos(tilt) / sqrt(2).
  const std::string along_roofs =
      planned(prisms_on(cylinder_substrate(20.0, true, ElementAxes::normal)), machine("ideal"));
  EXPECT_EQ(along_roofs, "machine");
  Machine stiff = machine("ideal");
  stiff.a.limits_deg.value = {0.0, 50.0};
  EXPECT_EQ(planned(prisms_on(plane_substrate(12.0, 0.0, ElementAxes::normal)), stiff), "machine");
  const std::string steep =
      planned(cubes_on(plane_substrate(30.0, 90.0, ElementAxes::normal), false), machine("ideal-dmc"));
  EXPECT_EQ(steep, "machine");
}

/// A tool holder that does not touch a flat blank collides with a concave blank.
TEST(OnSubstrate, HoldersAreSeenToReachIntoHollowBlanks) {
  Machine m = machine("ideal");
  MachineBody holder;
  holder.name = "shank";
  holder.link = KinematicLink::tool;
  for (const double x : {-0.1, 0.1})
    for (const double y : {-0.2, 0.75})
      for (const double z : {1.2, 3.0}) holder.points_mm.value.emplace_back(x, y, z);
  m.bodies = {holder};
  const auto kinds = [&](const Substrate& substrate) {
    const Job job = prisms_on(substrate, 6);
    const std::string text = nc_text(make_plan(job, m).programs.front(), "rs274ngc");
    return kinds_of(verify_programs(job, m, {parse_nc(text, "p", NcDialect::rs274ngc)}, {}, {}));
  };
  EXPECT_EQ(kinds(plane_substrate(0.0, 0.0, ElementAxes::normal)), "");
  EXPECT_EQ(kinds(cylinder_substrate(3.0, false, ElementAxes::normal)), "");
  EXPECT_EQ(kinds(cylinder_substrate(-3.0, false, ElementAxes::normal)), "holder_collision");
}

}  // namespace
}  // namespace retrace::fabrication::test::substrate_jobs_test
