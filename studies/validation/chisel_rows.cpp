// Validation rows for machines with misaligned axes, for cuts of prisms and cube corners, and for machining times.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "fabrication/chisel/check/chisel_reach.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/chisel/plan/routines.h"
#include "fabrication/machine/io/machine_files.h"
#include "studies/quantity/machining.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

using fabrication::Job, fabrication::Machine, fabrication::Strategy;
using geometry::Vec3;

constexpr std::string_view kLinearAxes = "XYZ";
constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

Machine machine_of(const char* name) {
  return fabrication::load_machine(name, {});
}

/// Returns the outward normal of facet 1 or 2 of a right-angled prism on the blank.
Vec3 normal_of(int facet) {
  return Vec3(0.0, facet == 1 ? -1.0 : 1.0, 1.0).normalized();
}

fabrication::PlungePose pose_of(const char* machine, int facet) {
  const double side = facet == 1 ? 1.0 : -1.0;
  return fabrication::solve_plunge_pose(machine_of(machine), normal_of(facet), {side, 0.0, 0.0},
                                        {45.0, facet == 1 ? 0.0 : 180.0});
}

double word_of(const fabrication::AxisPositions& axes, char axis) {
  return axis == 'X' ? axes.x_mm : axis == 'Y' ? axes.y_mm : axes.z_mm;
}

void add_words(std::vector<ValidationRow>& rows) {
  struct Position {
    double a_deg, c_deg;
    std::array<double, 3> words_mm;
  };
  const auto add = [&](ValidationRow row) {
    row.topic = "Kinematics of a tilting table";
    rows.push_back(std::move(row));
  };
  for (const Position& position :
       {Position{45, 0, {10, 15.050252532, -6.263455967}}, Position{45, 180, {-10, 7.979184720, -13.334523779}},
        Position{45, 90, {-5, 18.585786438, -2.727922061}}, Position{0, 90, {-5, 10, 2}}})
    for (std::size_t k = 0; k < 3; ++k)
      add({.quantity =
               fmt::format("axis word {} of the point (10, 5, 2) mm at A {} C {}, axis A through (0, 20, 10) mm",
                           kLinearAxes[k], position.a_deg, position.c_deg),
           .unit = "mm",
           .reference = Reference::independent,
           .expected = position.words_mm[k],
           .source = "LinuxCNC, xyzac-trt with y-offset 20 and z-offset 10",
           .allowed = 5e-10,
           .why = "nine decimals",
           .compute = [=](auto) {
             Machine machine = machine_of("ideal");
             machine.a.point_mm.value = Vec3(0.0, 20.0, 10.0);
             return word_of(fabrication::inverse(machine, {10.0, 5.0, 2.0}, {position.a_deg, position.c_deg}),
                            kLinearAxes[k]);
           }});
  constexpr std::array<double, 3> kMisalignmentUm = {13.95, -11.58, -8.10};
  for (std::size_t k = 0; k < 3; ++k)
    add({.quantity = fmt::format("axis word {} of the point (6, 6, 0) mm at A 45 C 180: measured minus ideal axes",
                                 kLinearAxes[k]),
         .unit = "um",
         .reference = Reference::independent,
         .expected = kMisalignmentUm[k],
         .source = "axes of Hamilton et al. 2017, eqs. 4 and 5, by another program",
         .allowed = 5e-3,
         .why = "two decimals",
         .compute = [k](auto) {
           const auto word = [&](const char* name) {
             return word_of(fabrication::inverse(machine_of(name), {6.0, 6.0, 0.0}, {45.0, 180.0}), kLinearAxes[k]);
           };
           return 1e3 * (word("paper") - word("ideal"));
         }});
}

void add_poses(std::vector<ValidationRow>& rows) {
  struct Solved {
    const char* machine;
    int facet;
    double a_deg, c_deg, tilt_arcmin;
  };
  const auto add = [&](ValidationRow row) {
    row.topic = "Rotary poses for plunging facets";
    row.reference = Reference::independent;
    row.source = "solved by another program";
    rows.push_back(std::move(row));
  };
  for (const Solved& solved : {Solved{"paper", 1, 45.000155, -0.119246, 1.17},
                               {"paper", 2, 45.055168, 179.898541, 2.69},
                               {"thesis", 1, 45.000002, -0.015492, -0.75},
                               {"thesis", 2, 45.000002, 179.984508, -0.75}}) {
    const std::string facet = fmt::format("machine {}, facet {}: ", solved.machine, solved.facet);
    add({.quantity = facet + "A",
         .unit = "deg",
         .expected = solved.a_deg,
         .allowed = 5e-7,
         .why = "six decimals",
         .compute = [solved](auto) { return pose_of(solved.machine, solved.facet).pose.a_deg; }});
    add({.quantity = facet + "C",
         .unit = "deg",
         .expected = solved.c_deg,
         .allowed = 5e-7,
         .why = "six decimals",
         .compute = [solved](auto) { return pose_of(solved.machine, solved.facet).pose.c_deg; }});
    add({.quantity = facet + "angle between root and tool edge",
         .unit = "arcmin",
         .expected = solved.tilt_arcmin,
         .allowed = 5e-3,
         .why = "two decimals",
         .compute = [solved](auto) { return pose_of(solved.machine, solved.facet).root_tilt.rad() * kArcminPerRad; }});
  }
  // Returns the normal of a facet that is cut on the misaligned machine of the paper with axis positions planned for
  // ideal axes.
  const auto cut_normal = [](int facet) {
    const Machine machine = machine_of("paper");
    const fabrication::RotaryPose pose = {45.0, facet == 1 ? 0.0 : 180.0};
    return Vec3(
        fabrication::machine_from_workpiece(machine, pose).inverse().direction(fabrication::plunged_normal(machine)));
  };
  const auto angle_arcmin = [](const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * kArcminPerRad;
  };
  for (const auto& [facet, off_arcmin] : {std::pair{1, 5.06}, {2, 5.42}})
    add({.quantity = fmt::format("machine paper, planned for ideal axes: error of the normal of facet {}", facet),
         .unit = "arcmin",
         .expected = off_arcmin,
         .allowed = 5e-3,
         .why = "two decimals",
         .compute = [=, facet = facet](auto) { return angle_arcmin(cut_normal(facet), normal_of(facet)); }});
  add({.quantity = "machine paper, planned for ideal axes: error of the right angle between the facets",
       .unit = "arcmin",
       .expected = 3.32,
       .allowed = 5e-3,
       .why = "two decimals",
       .compute = [=](auto) { return std::abs(angle_arcmin(cut_normal(1), cut_normal(2)) - 90.0 * 60.0); }});
  rows.push_back(
      {.topic = "Rotary poses for plunging facets",
       .quantity = "tilt of the head at the facets of cube corners, asin(1 / sqrt 3)",
       .unit = "deg",
       .expected = std::asin(1.0 / std::numbers::sqrt3) * 180.0 / std::numbers::pi,
       .source = "docs/theory/micro_chiseling.md",
       .allowed = 1e-9,
       .why = "rounding",
       .compute = [](auto) {
         const Vec3 normal(-std::sqrt(2.0 / 3.0), 0.0, 1.0 / std::numbers::sqrt3);
         return fabrication::solve_plunge_pose(machine_of("ideal-dmc"), normal, Vec3::UnitY(), {35.0, 0.0}).pose.a_deg;
       }});
}

/// Returns the job for prisms of one size, as the thesis cut them in acrylic. The tool is as wide as a prism. There are
/// n x n prisms in brick rows, or a single prism for n = 1.
Job job_of(double base_mm, int n, double depth_um, Strategy strategy) {
  Job job;
  fabrication::prism_of(job) = {base_mm, base_mm, 90.0};
  job.array.arrangement = n == 1 ? geometry::Arrangement::single : geometry::Arrangement::offset;
  if (n > 1) job.array.x_length_mm = job.array.y_length_mm = base_mm * n;
  job.tool.width_mm = base_mm;
  job.process.roughing_depth_um = depth_um;
  job.strategy = strategy;
  return job;
}

/// Returns the plan for the square array of 25 x 25 prisms of the thesis, on the machine of the thesis.
fabrication::Plan plan_of_the_thesis() {
  return fabrication::make_plan(job_of(0.451, 25, 15.0, Strategy::two_step), machine_of("thesis"));
}

void add_cuts_and_times(std::vector<ValidationRow>& rows) {
  constexpr const char* kTopic = "Cuts and times of single-point inverted cutting";
  struct Counted {
    double base_mm, depth_um;
    Strategy strategy;
    double cuts;
    const char* source;
  };
  for (const Counted& c : {Counted{1.0, 10.0, Strategy::unidirectional, 71, "Milliken 2017, section 4.1.3"},
                           Counted{1.0, 5.0, Strategy::unidirectional, 142, "Milliken 2017, section 4.1.3"},
                           Counted{0.451, 15.0, Strategy::unidirectional, 22, "Milliken 2017, section 2.7"},
                           Counted{0.451, 15.0, Strategy::two_step, 21, "Milliken 2017, section 2.7"}}) {
    const std::string cuts = fmt::format("{} mm at {} um, {}: roughing cuts", c.base_mm, c.depth_um,
                                         fabrication::kStrategyWords[static_cast<std::size_t>(c.strategy)]);
    rows.push_back({.topic = kTopic,
                    .quantity = cuts + ", planned",
                    .reference = Reference::published,
                    .expected = c.cuts,
                    .source = c.source,
                    .why = "a count",
                    .compute = [c](auto) {
                      return static_cast<double>(
                          fabrication::cuts_per_facet(job_of(c.base_mm, 1, c.depth_um, c.strategy)));
                    }});
    rows.push_back({.topic = kTopic,
                    .quantity = cuts + ", in a study",
                    .reference = Reference::published,
                    .expected = c.cuts,
                    .source = c.source,
                    .why = "a count",
                    .compute = [c](auto) {
                      MachiningProcess process;
                      process.roughing_depth_um = c.depth_um;
                      if (c.strategy == Strategy::unidirectional) process.finishing_cuts = 0;
                      return roughing_cuts({c.base_mm, c.base_mm, 90.0}, process);
                    }});
  }
  // Sums the times of all cuts. A roughing cut goes down the facet and ploughs along the root at 50 mm/min. A finishing
  // cut goes down at 20 mm/min and does not plough. Both kinds dwell for 0.1 s at the root and return at 200 mm/min.
  const double facet_mm = 0.451 / std::numbers::sqrt2;
  const double approach_mm = 0.2 * std::numbers::sqrt2;
  double path_s = 0.0;
  for (int cut = 0; cut < 21; ++cut) {
    const double way_mm = approach_mm + facet_mm - 0.010 - 0.015 * cut + 0.1;
    path_s += 60.0 * (way_mm / 50.0 + (way_mm + 0.015) / 200.0) + 0.1;
  }
  for (int cut = 0; cut < 4; ++cut)
    path_s += 60.0 * ((approach_mm + facet_mm) / 20.0 + (approach_mm + facet_mm + 0.005) / 200.0) + 0.1;
  rows.push_back({.topic = kTopic,
                  .quantity = "0.451 mm, 15 um and 2 x 5 um: time of an element's path, summed cut by cut",
                  .unit = "s",
                  .expected = path_s,
                  .source = "docs/theory/sizing.md",
                  .allowed = 1e-9,
                  .why = "rounding",
                  .compute = [](auto) {
                    return seconds_per_element({0.451, 0.451, 90.0}, {});
                  }});
  constexpr double kMeasuredS = 3600.0 * 0.0081;
  rows.push_back({.topic = kTopic,
                  .quantity = "0.451 mm: time per element, from the measured times of 1 to 1244 elements",
                  .unit = "s",
                  .reference = Reference::published,
                  .expected = kMeasuredS,
                  .source = "Milliken 2017, section 2.7: 0.0081 h",
                  .allowed = 0.06 * kMeasuredS,
                  .why = "6 %: accelerations and rotations of the table are not part of the path",
                  .compute = [](auto) {
                    return seconds_per_element({0.451, 0.451, 90.0}, {});
                  }});
  rows.push_back({.topic = kTopic,
                  .quantity = "613 elements planned for the machine of the thesis: time per element",
                  .unit = "s",
                  .reference = Reference::published,
                  .expected = kMeasuredS,
                  .source = "Milliken 2017, section 2.7: 0.0081 h",
                  .allowed = 0.15 * kMeasuredS,
                  .why = "15 %: accelerations are not published",
                  .compute = [](auto) {
                    const fabrication::Plan plan = plan_of_the_thesis();
                    return plan.time.total_s() / static_cast<double>(plan.elements.size());
                  }});
  rows.push_back({.topic = kTopic,
                  .quantity = "613 elements planned for the machine of the thesis: aperture area per hour",
                  .unit = "mm2/h",
                  .reference = Reference::published,
                  .expected = 25.1,
                  .source = "Milliken 2017, section 2.7",
                  .allowed = 0.15 * 25.1,
                  .why = "15 %: accelerations are not published",
                  .compute = [](auto) {
                    const fabrication::Plan plan = plan_of_the_thesis();
                    return plan.aperture_area_mm2 / (plan.time.total_s() / 3600.0);
                  }});
  rows.push_back({.topic = kTopic,
                  .quantity = "2 finishing cuts of each facet, separate routines: rotations of C",
                  .reference = Reference::published,
                  .expected = 4.0,
                  .source = "Milliken 2017, chapter 2",
                  .why = "a count",
                  .compute = [](auto) { return static_cast<double>(plan_of_the_thesis().c_rotations); }});
}

void add_reach(std::vector<ValidationRow>& rows) {
  constexpr double kWidthMm = 0.2;
  // Length of the dihedral edges of a triangular cube corner with an aperture of 1 mm, and the area of a facet.
  const double edge_mm = 1.0 / (2.0 * std::sqrt(2.0 / 3.0));
  const double facet_mm2 = 0.5 * edge_mm * edge_mm;
  const auto reach = [] {
    fabrication::Tool tool;
    tool.width_mm = kWidthMm;
    return fabrication::chisel_reach(geometry::TriangularCube{1.0}, tool);
  };
  const auto add = appender(rows, "Facet area that a chisel of 0.2 mm reaches in a triangular cube corner of 1 mm",
                            "docs/theory/micro_chiseling.md");
  add({.quantity = "fraction of a facet, 1 - w^2 / (4 area), by simulated plunges",
       .unit = "%",
       .expected = 100.0 * (1.0 - kWidthMm * kWidthMm / (4.0 * facet_mm2)),
       .allowed = 1.0,
       .why = "counted at 1830 points of a facet, up to 14 of them along the side of the triangle",
       .compute = [reach](auto) { return 100.0 * reach().cut_fraction; }});
  add({.quantity = "height of the core over the apex, sqrt 3 w / (2 (sqrt 2 - cot rho)), by simulated plunges",
       .unit = "mm",
       .expected = std::numbers::sqrt3 * kWidthMm /
                   (2.0 * (std::numbers::sqrt2 - 1.0 / std::tan(53.0 * std::numbers::pi / 180.0))),
       .allowed = 1e-6,
       .why = "rounding",
       .compute = [reach](auto) { return reach().cut_core_mm; }});
}

}  // namespace

std::vector<ValidationRow> chisel_validation() {
  std::vector<ValidationRow> rows;
  add_words(rows);
  add_poses(rows);
  add_cuts_and_times(rows);
  add_reach(rows);
  return rows;
}

}  // namespace retrace::studies
