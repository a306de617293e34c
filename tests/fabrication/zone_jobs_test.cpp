#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/io/job_files.h"
#include "geometry/elements/element_cells.h"
#include "geometry/polygon.h"
#include "tests/fabrication/chiseling_programs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/support/refusals.h"

// Tests of jobs whose cube corners have intended angle errors or belong to zones. Results are compared with closed
// forms and with the path of the tool. The verifier must find a change of any number in a job.

namespace retrace::fabrication::test::zone_jobs_test {
namespace {

using geometry::AngleErrors;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kRadPerArcmin = std::numbers::pi / (180.0 * 60.0);

using namespace chiseling;

/// Returns the apexes of a rotated honeycomb.
/// \param middle apex of the first element
std::vector<Vec2> honeycomb(const Vec2& middle, double turn_deg, double aperture_mm, int columns, int rows) {
  const double turn = turn_deg * std::numbers::pi / 180.0;
  const Eigen::Rotation2Dd turned(turn);
  std::vector<Vec2> apexes;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const double half_row = 0.25 * std::sqrt(3.0) * aperture_mm;
      apexes.push_back(middle + turned * Vec2(0.75 * aperture_mm * i, half_row * (2.0 * j + i % 2)));
    }
  return apexes;
}

/// Returns a job with three zones of different sizes, angle errors and rotations.
Job zoned_job() {
  Job job = cube_job(true, 0.3);
  job.array.pattern.clear();
  job.array.x_length_mm = 3.0;
  job.array.y_length_mm = 1.5;
  job.angle_errors.dihedral_error_arcmin = {12.0, 12.0, 12.0};
  job.zones.resize(3);
  job.zones[0].apexes_mm = honeycomb({0.2, 0.2}, 0.0, 0.3, 2, 2);
  job.zones[1].dihedral_error_arcmin = {20.0, -15.0, 40.0};
  job.zones[1].facet_tilt_arcmin = {3.0, 0.0, -2.0};
  job.zones[1].rotation_deg = 33.0;
  job.zones[1].apexes_mm = honeycomb({1.1, 0.3}, 33.0, 0.3, 2, 2);
  job.zones[2].aperture_mm = 0.2;
  job.zones[2].dihedral_error_arcmin = {0.0, 0.0, 0.0};
  job.zones[2].rotation_deg = 180.0;
  job.zones[2].apexes_mm = honeycomb({2.6, 1.2}, 180.0, 0.2, 3, 2);
  return job;
}

TEST(CubeCorners, HaveTheAnglesThatTheirErrorsSay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> arcmin(-40.0, 40.0);
  for (int trial = 0; trial < 50; ++trial)
    for (const bool rotated : {false, true}) {
      AngleErrors errors;
      for (double& error : errors.dihedral_error_arcmin) error = arcmin(random);
      const CubeCorner corner = cube_corner(geometry::HexagonalCube{0.5, {}}, errors, rotated);
      const Vec3 apex = corner.apex_over({0.1, 0.2, 0.3});
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& before = corner.normals[(k + 2) % 3];
        EXPECT_NEAR(before.dot(corner.normals[k]), std::sin(errors.dihedral_error_arcmin[k] * kRadPerArcmin), 1e-14);
        EXPECT_NEAR(corner.edges[k].dot(before), 0.0, 1e-15);
        EXPECT_NEAR(corner.edges[k].dot(corner.normals[k]), 0.0, 1e-15);
        EXPECT_GT(corner.edges[k].z(), 0.5);
        // The y axis of the part is the x axis of the workpiece. The x axis of the part is the -y axis of the
        // workpiece.
        const double azimuth = (120.0 * static_cast<double>(k) + (rotated ? 90.0 : -90.0)) * std::numbers::pi / 180.0;
        const Vec2 along(std::cos(azimuth), std::sin(azimuth));
        EXPECT_GT(corner.edges[k].head<2>().normalized().dot(along), std::cos(0.03));
        EXPECT_NEAR(corner.normals[k].dot(apex), 0.1 * static_cast<double>(k + 1), 1e-14);
      }
    }
}

TEST(CubeCorners, TiltsOpenFacetsByTheirAngle) {
  AngleErrors errors;
  errors.facet_tilt_arcmin = {30.0, 0.0, -12.0};
  const CubeCorner corner = cube_corner(geometry::TriangularCube{0.5, {}}, errors);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(std::acos(corner.normals[k].z()),
                std::acos(1.0 / std::numbers::sqrt3) - errors.facet_tilt_arcmin[k] * kRadPerArcmin, 1e-13);
}

TEST(CubeCorners, WithErrorsOfAllSignsVerifyBelowANanometre) {
  for (const bool is_hexagonal : {false, true})
    for (const std::array<double, 3>& errors :
         {std::array{20.0, 20.0, 20.0}, {-20.0, -20.0, -20.0}, {60.0, -60.0, 3.0}, {-1.0, 0.0, 45.0}})
      for (const Machine& m : {machine(), crooked_machine()}) {
        Job job = cube_job(is_hexagonal, 0.15);
        job.angle_errors.dihedral_error_arcmin = errors;
        const Verification v = verified(job, m, text_of(job, m));
        EXPECT_TRUE(v.passes()) << m.name << " " << errors[0] << "\n" << listed(v);
        EXPECT_EQ(v.elements_cut, 9);
        EXPECT_LT(v.facet_distance_nm_max, 1.0);
        EXPECT_LT(std::abs(v.apex_error_arcmin_max), 0.02);
      }
}

TEST(CubeCorners, WithAnyErrorsVerify) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    Job job = cube_job(trial % 2 == 0, 0.2 + 0.1 * unit(random));
    job.tool.width_mm *= 1.3;
    const double most_arcmin = trial % 5 == 0 ? 250.0 : 40.0;
    for (double& error : job.angle_errors.dihedral_error_arcmin) error = most_arcmin * unit(random);
    for (double& tilt : job.angle_errors.facet_tilt_arcmin) tilt = 20.0 * unit(random);
    const Verification v = verified(job, machine(), text_of(job, machine()));
    EXPECT_TRUE(v.passes()) << trial << "\n" << job_text(job).substr(0, 700) << "\n" << listed(v);
    EXPECT_LT(v.facet_distance_nm_max, 1.0) << trial;
  }
}

TEST(ZoneJobs, AreReadAndWrittenWithoutLoss) {
  const Job job = zoned_job();
  const Job again = parse_job(job_text(job), "j.toml");
  EXPECT_EQ(job_text(again), job_text(job));
  EXPECT_EQ(cut_elements(again).size(), 14U);
}

TEST(ZoneJobs, ProgramsVerifyBelowANanometre) {
  const Job job = zoned_job();
  for (const Machine& m : {machine(), crooked_machine()}) {
    const Verification v = verified(job, m, text_of(job, m));
    EXPECT_TRUE(v.passes()) << m.name << "\n" << listed(v);
    EXPECT_EQ(v.elements_cut, 14);
    EXPECT_LT(v.facet_distance_nm_max, 1.0);
    EXPECT_LT(std::abs(v.apex_error_arcmin_max), 0.03);
  }
}

TEST(ZoneJobs, EveryDialectCutsTheSame) {
  const Job job = zoned_job();
  for (const auto dialect :
       {NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac, NcDialect::a3200, NcDialect::automation1}) {
    const std::string_view word = kNcDialectWords[static_cast<std::size_t>(dialect)];
    const Verification v = verified(job, machine(), text_of(job, machine(), word), dialect);
    EXPECT_TRUE(v.passes()) << word << "\n" << listed(v);
  }
}

/// Records the feed moves of the tool tip in the workpiece frame.
struct TipWays : NcSink {
  explicit TipWays(const Machine& m) : machine_of(m) {}
  void motion(const NcMotion& motion, const NcSettings&) override {
    if (motion.move == NcMove::rapid || (motion.moved & 7) == 0 || (motion.moved & ~7U) != 0) return;
    const RigidMotion back = machine_from_workpiece(machine_of, rotary_pose(machine_of, motion.to)).inverse();
    ways.push_back(
        {back.point(machine_point(machine_of, motion.from)), back.point(machine_point(machine_of, motion.to))});
  }
  void dwell(double, const NcLocation&, const AxisPositions&) override {}
  const Machine& machine_of;
  std::vector<std::pair<Vec3, Vec3>> ways;
};

/// The deepest moves of the tip, down and up each facet, must span the plane of this facet. This reference is
/// independent of the planner and of the verifier.
TEST(ZoneJobs, TheTipSpansPlanesWithTheAnglesOfEachZone) {
  const Job job = zoned_job();
  const Machine m = machine();
  TipWays tip(m);
  run_nc(parse_nc(text_of(job, m), "p.ngc", NcDialect::rs274ngc, control_texts()), tip);
  const std::vector<std::array<double, 3>> errors = {{12, 12, 12}, {20, -15, 40}, {0, 0, 0}};
  const std::vector<double> turns_deg = {0.0, 33.0, 180.0};
  const std::vector<double> apertures_mm = {0.3, 0.3, 0.2};
  for (std::size_t z = 0; z < 3; ++z)
    for (const Vec2& apex : job.zones[z].apexes_mm) {
      const Vec3 root(apex.y() - 0.75, 1.5 - apex.x(), -0.5 * apertures_mm[z] * std::numbers::sqrt2);
      std::vector<std::pair<double, Vec3>> planes;  // azimuth of the normal, and the normal
      for (std::size_t k = 0; k + 1 < tip.ways.size(); ++k) {
        const auto& [from, down_to] = tip.ways[k];
        const auto& [up_from, to] = tip.ways[k + 1];
        if ((down_to - root).norm() > 3e-6 || (up_from - down_to).norm() > 1e-12) continue;
        Vec3 normal = (from - down_to).cross(to - down_to).normalized();
        if (normal.z() < 0.0) normal = -normal;
        planes.emplace_back(std::atan2(normal.y(), normal.x()), normal);
      }
      ASSERT_EQ(planes.size(), 3U) << z;
      // Facet k is between edges k and k + 1. Edge 0 runs along -y of the workpiece, rotated with the zone.
      for (std::size_t k = 0; k < 3; ++k) {
        const auto plane_of = [&](double facet) {
          const double faces = (120.0 * facet - 90.0 + 60.0 + 180.0 + turns_deg[z]) * std::numbers::pi / 180.0;
          return *std::ranges::max_element(planes, {}, [&](const auto& p) { return std::cos(p.first - faces); });
        };
        const Vec3 first = plane_of(static_cast<double>(k) + 2.0).second;
        const Vec3 second = plane_of(static_cast<double>(k)).second;
        if (z == 1) continue;  // the facets of this zone also have tilts
        EXPECT_NEAR(first.dot(second), std::sin(errors[z][k] * kRadPerArcmin), 2e-5) << z << " " << k;
      }
    }
}

/// A program must fail verification for a job that differs from the job of the program in one number of one zone.
TEST(ZoneJobs, EveryNumberOfEveryZoneMatters) {
  const Job job = zoned_job();
  const Machine m = machine();
  std::vector<std::pair<std::string, std::function<void(Job&)>>> changes;
  for (std::size_t z = 0; z < 3; ++z) {
    for (std::size_t k = 0; k < 3; ++k) {
      changes.emplace_back(fmt::format("zone {} edge {}", z, k), [=](Job& j) {
        auto own = j.zones[z].dihedral_error_arcmin.value_or(j.angle_errors.dihedral_error_arcmin);
        own[k] += 1.0;
        j.zones[z].dihedral_error_arcmin = own;
      });
      changes.emplace_back(fmt::format("zone {} tilt {}", z, k), [=](Job& j) {
        auto own = j.zones[z].facet_tilt_arcmin.value_or(j.angle_errors.facet_tilt_arcmin);
        own[k] -= 1.0;
        j.zones[z].facet_tilt_arcmin = own;
      });
    }
    changes.emplace_back(fmt::format("zone {} turn", z), [=](Job& j) { j.zones[z].rotation_deg -= 0.05; });
    changes.emplace_back(fmt::format("zone {} size", z), [=](Job& j) {
      j.zones[z].aperture_mm = j.zones[z].aperture_mm.value_or(0.3) + (z == 0 ? -1e-4 : -1e-4);
    });
    for (std::size_t k = 0; k < job.zones[z].apexes_mm.size(); ++k) {
      changes.emplace_back(fmt::format("zone {} apex {}", z, k), [=](Job& j) { j.zones[z].apexes_mm[k].y() += 5e-5; });
      changes.emplace_back(fmt::format("zone {} without {}", z, k), [=](Job& j) {
        j.zones[z].apexes_mm.erase(j.zones[z].apexes_mm.begin() + static_cast<std::ptrdiff_t>(k));
      });
    }
  }
  for (const auto& [what, change] : changes) {
    Job other = job;
    change(other);
    EXPECT_FALSE(verified(job, m, text_of(other, m)).passes()) << what;
  }
}

/// Over all poses, C rotates in one direction. It skips the widest gap between the angles of the poses. The facets of
/// each zone are cut in the order 1, 2, 3.
TEST(ZoneJobs, PosesTurnAsLittleAsTheyCan) {
  const Plan plan = make_plan(zoned_job(), machine());
  ASSERT_EQ(plan.poses.size(), 9U);
  std::vector<double> turns_deg;
  for (const double zone_deg : {0.0, 33.0, 180.0})
    for (const double facet_deg : {0.0, 120.0, 240.0}) turns_deg.push_back(std::fmod(zone_deg + facet_deg, 360.0));
  std::ranges::sort(turns_deg);
  double widest_deg = turns_deg.front() + 360.0 - turns_deg.back();
  for (std::size_t k = 1; k < turns_deg.size(); ++k) widest_deg = std::max(widest_deg, turns_deg[k] - turns_deg[k - 1]);
  double way_deg = 0.0;
  for (std::size_t k = 1; k < plan.poses.size(); ++k) {
    EXPECT_LT(plan.poses[k].rounded.c_deg, plan.poses[k - 1].rounded.c_deg);
    way_deg += plan.poses[k - 1].rounded.c_deg - plan.poses[k].rounded.c_deg;
  }
  EXPECT_NEAR(way_deg, 360.0 - widest_deg, 1.0);  // tolerance: angle errors rotate facets by some arc minutes
  std::array<int, 3> last{};
  for (const CuttingPose& pose : plan.poses) {
    int& before = last[pose.facet.zone];
    if (before != 0) {
      EXPECT_EQ(pose.facet.facet, before % 3 + 1);
    }
    before = pose.facet.facet;
  }
}

/// Returns the volume that all cavities remove together. The volume is summed over small squares. The depth is computed
/// from the facet planes at the centre of each square.
double removed_by_squares_mm3(const Job& job, double step_mm) {
  struct Cavity {
    Vec3 root;
    std::array<Vec3, 3> normals;
  };
  std::vector<Cavity> cavities;
  for (const CutElement& element : cut_elements(job)) {
    Cavity& cavity = cavities.emplace_back();
    const CubeCorner corner = blank_corner(job, element.zone, element.rotated);
    cavity.root = element.origin_mm - Vec3(0.0, 0.0, corner.depth_mm);
    for (std::size_t k = 0; k < 3; ++k) cavity.normals[k] = element.workpiece_from_element * corner.normals[k];
  }
  double sum_mm3 = 0.0;
  for (double x = -1.2; x < 1.2; x += step_mm)
    for (double y = -2.0; y < 2.0; y += step_mm) {
      double lowest = 0.0;
      for (const Cavity& cavity : cavities) {
        const Vec3 from = Vec3(x + 0.5 * step_mm, y + 0.5 * step_mm, 0.0) - cavity.root;
        double over = -std::numeric_limits<double>::infinity();
        for (const Vec3& normal : cavity.normals)
          over = std::max(over, cavity.root.z() - normal.head<2>().dot(from.head<2>()) / normal.z());
        lowest = std::min(lowest, over);
      }
      sum_mm3 -= lowest * step_mm * step_mm;
    }
  return sum_mm3;
}

TEST(ZoneJobs, TakeWhatAllCavitiesTakeTogether) {
  Job job = zoned_job();
  // Place the zones so close together that cavities of one zone extend into hexagons of another zone.
  job.zones[1].rotation_deg = 180.0;
  job.zones[1].apexes_mm = {{0.76, 0.4}, {0.76, 0.66}, {0.76, 0.92}};
  const Verification v = verified(job, machine(), text_of(job, machine()));
  EXPECT_TRUE(v.passes()) << listed(v);
  EXPECT_GT(v.elements_overcut, 0);
  EXPECT_GT(v.zone_overcut_mm2, 0.0);
  EXPECT_GT(v.zone_overcut_um_max, 1.0);
  const double expected_mm3 = removed_by_squares_mm3(job, 0.004);
  EXPECT_NEAR(v.removed_volume_mm3, expected_mm3, 2e-3 * expected_mm3);
}

/// A honeycomb whose cells belong alternately to two zones must give the same result as a honeycomb without zones. No
/// zone removes material of the other zone.
TEST(ZoneJobs, OneArrayInTwoZonesIsTheArray) {
  Job array = cube_job(true, 0.3);
  Job zones = array;
  zones.array.pattern.clear();
  zones.zones.resize(2);
  const Vec2 middle = 0.5 * Vec2(array.array.x_length_mm, array.array.y_length_mm);
  std::size_t k = 0;
  for (const CutElement& element : cut_elements(array))
    zones.zones[k++ % 2].apexes_mm.push_back(middle + Vec2(-element.centre_mm.y(), element.centre_mm.x()));
  const Verification one = verified(array, machine(), text_of(array, machine()));
  const Verification two = verified(zones, machine(), text_of(zones, machine()));
  EXPECT_TRUE(two.passes()) << listed(two);
  EXPECT_EQ(two.elements_overcut, 0);
  EXPECT_NEAR(two.border_overcut_mm3, one.border_overcut_mm3, 2e-3 * one.border_overcut_mm3);
  EXPECT_NEAR(two.removed_volume_mm3, one.removed_volume_mm3, 1e-3 * one.removed_volume_mm3);
}

struct Wrong {
  std::string what;
  std::function<void(Job&)> change;
  std::string place;
};

TEST(ZoneJobs, WhatIsWrongIsRefusedWithItsKey) {
  const Wrong cases[] = {
      {"outside",
       [](Job& j) {
         j.zones[1].apexes_mm[2] = {2.95, 0.7};
       },
       "j.toml:30: zone[2].apexes_mm"},
      {"twice", [](Job& j) { j.zones[2].apexes_mm[1] = j.zones[0].apexes_mm[0] + Vec2(0.1, 0.0); },
       "j.toml:36: zone[3].apexes_mm"},
      {"itself", [](Job& j) { j.zones[0].apexes_mm[1] = j.zones[0].apexes_mm[0]; }, "j.toml:24: zone[1].apexes_mm"},
      {"none", [](Job& j) { j.zones[0].apexes_mm.clear(); }, "j.toml:24: zone[1].apexes_mm"},
      {"size", [](Job& j) { j.zones[0].aperture_mm = 0.0; }, "j.toml:23: zone[1].aperture_mm"},
      {"error",
       [](Job& j) {
         j.zones[0].dihedral_error_arcmin = {301.0, 0.0, 0.0};
       },
       "j.toml:23: zone[1].dihedral_error_arcmin"},
      {"turn", [](Job& j) { j.zones[0].rotation_deg = 361.0; }, "j.toml:23: zone[1].rotation_deg"},
      {"margin", [](Job& j) { j.array.x_offset_mm = 0.1; }, "j.toml:19: array.x_offset_mm"},
      {"pattern", [](Job& j) { j.array.pattern = {"#"}; }, "j.toml:21: array.pattern"},
      {"single", [](Job& j) { j.array.arrangement = geometry::Arrangement::single; }, "j.toml:16: array.arrangement"},
      {"base",
       [](Job& j) {
         j.substrate.emplace();
         j.substrate->shape = geometry::SphereSubstrate{100.0};
       },
       "j.toml:39: substrate.kind"},
      {"tool", [](Job& j) { j.tool.width_mm = 0.2; }, "j.toml:39: tool.width_mm"},
  };
  for (const Wrong& wrong : cases) {
    SCOPED_TRACE(wrong.what);
    Job job = zoned_job();
    wrong.change(job);
    EXPECT_EQ(refusal_of([&] { parse_job(job_text(job), "j.toml"); }), wrong.place);
  }
}

TEST(ZoneJobs, AreOfCubeCorners) {
  const std::string text = job_text(square_job(2)) + "\n[[zone]]\napexes_mm = [[1, 1]]\n";
  EXPECT_EQ(refusal_of([&] { parse_job(text, "j.toml"); }), "j.toml:55: zone");
}

}  // namespace
}  // namespace retrace::fabrication::test::zone_jobs_test
