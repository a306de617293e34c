#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <regex>
#include <string>
#include <string_view>

#include "core/limit_error.h"
#include "core/number_format.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/job/fins.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/v_tool.h"
#include "tests/fabrication/chiseling_programs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/support/refusals.h"
#include "tests/support/sample_size.h"

// Tests of V-shaped tools at positions that are rounded to the increments of the control. Bounds on the height of fins
// are compared with randomly displaced cuts. Correct jobs with random tools must pass verification.

namespace retrace::fabrication::test::rounded_cuts_test {
namespace {

using namespace chiseling;

/// Returns the height, above the first facet, of the fin that remains between two cuts. The facets are at the angles 0
/// and `between`.
/// \param first angle of the wedge that the first cut removes above its facet, in rad
/// \param second angle of the wedge that the second cut removes above its facet, in rad
/// \param tip tip of the first wedge
/// \param other_tip tip of the second wedge
double fin_between(double first, double second, double between, const geometry::Vec2& tip,
                   const geometry::Vec2& other_tip) {
  const geometry::Vec2 up(std::cos(first), std::sin(first));
  const geometry::Vec2 other_up(std::cos(between - second), std::sin(between - second));
  // Intersection of the upper boundaries of both cuts.
  const geometry::Vec2 apart = other_tip - tip;
  const double along =
      (apart.x() * other_up.y() - apart.y() * other_up.x()) / (up.x() * other_up.y() - up.y() * other_up.x());
  return along > 0.0 ? (tip + along * up).y() : 0.0;
}

TEST(RoundedCuts, FinsAreNoHigherThanTheFormula) {
  std::mt19937 bits(11);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  for (int tool = 0; tool < 30; ++tool) {
    const double between = 0.5 * std::numbers::pi + uniform(-0.05, 0.05);
    const double overlap = uniform(0.01, 0.5);
    const double first = uniform(0.6, 1.0);
    const double second = between + overlap - first;
    const double bound =
        rounded_fin_mm({Angle::from_rad(first), Angle::from_rad(second), Angle::from_rad(between)}, 1.0);
    double highest = 0.0;
    for (int k = 0; k < 20'000; ++k) {
      // Displace the tips along and normal to the facets, in increments. Half of the samples have the maximum
      // displacements.
      const auto corner = [&](double size) {
        return k % 2 == 0 ? std::copysign(size, uniform(-1, 1)) : uniform(-size, size);
      };
      const double along = 2.0 * std::numbers::sqrt3;
      const geometry::Vec2 tip(corner(along), corner(1.0));
      const double other_along = corner(along);
      const double other_across = corner(1.0);
      const geometry::Vec2 other_tip = other_along * geometry::Vec2(std::cos(between), std::sin(between)) +
                                       other_across * geometry::Vec2(std::sin(between), -std::cos(between));
      highest = std::max(highest, fin_between(first, second, between, tip, other_tip));
      highest = std::max(highest, fin_between(second, first, between, tip, other_tip));
    }
    EXPECT_LE(highest, bound * (1.0 + 1e-9)) << first << ' ' << second << ' ' << between;
    EXPECT_GE(highest, 0.9 * bound - 1.0) << first << ' ' << second << ' ' << between;
  }
}

/// Three facet planes with random angle errors, and the directions of the spine of a random tool while it cuts each of
/// the facets. The spine is the edge between the two flanks of the tool.
struct RandomCuts {
  std::array<geometry::Vec3, 3> normals;
  std::array<geometry::Vec3, 3> spines;
};

RandomCuts random_cuts(std::mt19937& bits) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  const geometry::Vec3 spine(uniform(0.7, 1.1), uniform(0.7, 1.1), 1.0);
  RandomCuts cuts;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto facet = static_cast<std::size_t>(k);
    geometry::Vec3 normal(uniform(-0.01, 0.01), uniform(-0.01, 0.01), uniform(-0.01, 0.01));
    normal[k] = 1.0;
    cuts.normals[facet] = normal.normalized();
    // The two dihedral edges of facet k are the two coordinate axes that follow axis k.
    cuts.spines[facet][(k + 1) % 3] = spine.x();
    cuts.spines[facet][(k + 2) % 3] = spine.y();
    cuts.spines[facet][k] = spine.z();
    cuts.spines[facet].normalize();
  }
  return cuts;
}

/// Returns true if the cut along a facet removes a point. The cut removes the cone that is spanned by the two edges of
/// the facet and the spine, displaced by `tip`. The cone is computed from its own three planes.
bool removes(const RandomCuts& cuts, std::size_t facet, const geometry::Vec3& tip, const geometry::Vec3& point) {
  const geometry::Vec3& normal = cuts.normals[facet];
  const geometry::Vec3 first = cuts.normals[(facet + 2) % 3].cross(normal);
  const geometry::Vec3 second = normal.cross(cuts.normals[(facet + 1) % 3]);
  Eigen::Matrix3d cone;
  cone << first, second, cuts.spines[facet];
  return (cone.inverse() * (point - tip)).minCoeff() >= 0.0;
}

/// Returns true if cuts at exact positions leave a peak above the apex. The function tests directions from the apex on
/// a fine grid. A peak exists if no cut removes the points in one of these directions.
bool leaves_a_peak(const RandomCuts& cuts) {
  constexpr int kSteps = 160;
  for (int i = 1; i < kSteps; ++i)
    for (int j = 1; i + j < kSteps; ++j) {
      const geometry::Vec3 heights(i, j, kSteps - i - j);
      Eigen::Matrix3d planes;
      for (Eigen::Index k = 0; k < 3; ++k) planes.row(k) = cuts.normals[static_cast<std::size_t>(k)].transpose();
      const geometry::Vec3 point = planes.inverse() * heights;
      if (!removes(cuts, 0, geometry::Vec3::Zero(), point) && !removes(cuts, 1, geometry::Vec3::Zero(), point) &&
          !removes(cuts, 2, geometry::Vec3::Zero(), point))
        return true;
    }
  return false;
}

/// Cuts can leave a peak above the apex although they overlap along every dihedral edge. If the formula predicts no
/// such peak, a search on a grid of directions must find none.
TEST(RoundedCuts, PeaksAreWhereTheFormulaHasThem) {
  std::mt19937 bits(5);
  int peaks = 0;
  int covered = 0;
  for (int tool = 0; tool < 400; ++tool) {
    const RandomCuts cuts = random_cuts(bits);
    const std::array<EdgeCover, 3> covers = edge_covers(cuts.normals, cuts.spines);
    const auto fins = [&](const EdgeCover& cover) { return std::isinf(rounded_fin_mm(cover, 1.0)); };
    if (std::any_of(covers.begin(), covers.end(), fins)) continue;
    const double height = rounded_peak_mm(covers, 1.0);
    // A narrow peak may be located between the points of the grid.
    if (height > 1e3 && std::isfinite(height)) continue;
    const bool is_peak = leaves_a_peak(cuts);
    if (std::isfinite(height)) {
      EXPECT_FALSE(is_peak) << height;
      ++covered;
    } else if (is_peak) {
      ++peaks;
    }
  }
  EXPECT_GE(covered, 20);
  EXPECT_GE(peaks, 20);
}

/// Displaces the tips by random rounding errors. The cuts must remove every point whose heights above two of the facets
/// exceed the bound.
TEST(RoundedCuts, PeaksAreNoHigherThanTheFormula) {
  std::mt19937 bits(7);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  int checked = 0;
  for (int tool = 0; tool < 300; ++tool) {
    const RandomCuts cuts = random_cuts(bits);
    const double bound = highest_fin_mm(edge_covers(cuts.normals, cuts.spines), 1.0);
    if (bound > 1e4) continue;
    ++checked;
    for (int k = 0; k < 200; ++k) {
      std::array<geometry::Vec3, 3> tips;
      for (std::size_t f = 0; f < 3; ++f) {
        const geometry::Vec3& normal = cuts.normals[f];
        geometry::Vec3 along(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        along = (along - along.dot(normal) * normal).normalized();
        tips[f] = std::copysign(rounded_across_mm(1.0), uniform(-1, 1)) * normal + rounded_along_mm(1.0) * along;
      }
      // Each sample has heights above the bound over two of the facets, and a random height over the third facet. A
      // lower point may belong to the fin along the edge between these two facets.
      geometry::Vec3 heights(uniform(0, 2), uniform(0, 2), uniform(0, 2));
      heights = (heights * bound).cwiseMax(3.0 * rounded_along_mm(1.0));
      for (const int facet : {k % 3, (k + 1) % 3}) heights[facet] = std::max(heights[facet], bound * 1.0001);
      Eigen::Matrix3d planes;
      for (Eigen::Index f = 0; f < 3; ++f) planes.row(f) = cuts.normals[static_cast<std::size_t>(f)].transpose();
      const geometry::Vec3 point = planes.inverse() * heights;
      EXPECT_TRUE(removes(cuts, 0, tips[0], point) || removes(cuts, 1, tips[1], point) ||
                  removes(cuts, 2, tips[2], point))
          << bound << ' ' << heights.transpose();
    }
  }
  EXPECT_GE(checked, 20);
}

/// Returns a job of one cube corner with angle errors, in a rotated zone.
Job one_corner(double aperture_mm, const std::array<double, 3>& errors_arcmin, double rotation_deg,
               const geometry::Vec2& apex_mm) {
  Job job = cube_job(true, aperture_mm);
  job.array.pattern.clear();
  job.array.x_length_mm = job.array.y_length_mm = 1.0;
  job.angle_errors.dihedral_error_arcmin = errors_arcmin;
  job.zones.resize(1);
  job.zones[0].rotation_deg = rotation_deg;
  job.zones[0].apexes_mm = {apex_mm};
  return job;
}

bool fits(const Job& job) {
  try {
    check_v_tool(job.element, job.angle_errors, job.tool, [](std::string_view key, const std::string& text) {
      throw InputError({"", 0, std::string(key)}, text);
    });
  } catch (const InputError&) {
    return false;
  }
  return true;
}

/// Correct jobs with a blunt nose pass, even if rounding leaves a fin of 10 nm. Near the apex, some measuring lines run
/// along the dihedral edge of the two other facets. These lines must end before the fin at that edge.
TEST(RoundedCuts, RightCutsOfABluntNosePass) {
  for (const auto& [clearance_deg, apex] :
       {std::pair{3.0, geometry::Vec2(0.844313, 0.5911)}, {2.0, geometry::Vec2(0.51237, 0.5031)}}) {
    Job job = one_corner(0.2386, {17.11, -11.52, -25.79}, -87.0, apex);
    job.tool = {};
    job.tool.width_mm = 0.3;
    job.tool.nose_angle_deg = 45.0;
    job.tool.wedge_deg = 63.0;
    job.tool.clearance_deg = clearance_deg;
    job.tool.edge_radius_um = 1.0;
    job.process.finishing_cuts = 2;
    ASSERT_TRUE(fits(job));
    const Verification v = verified(job, machine(), text_of(job, machine()));
    EXPECT_TRUE(v.passes()) << listed(v);
  }
}

/// Returns a job of one cube corner with a random tool, size, position and angle errors.
Job random_corner(std::mt19937& bits) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); };
  const double error = uniform(0.0, 40.0);
  Job job = one_corner(uniform(0.1, 0.4), {uniform(-error, error), uniform(-error, error), uniform(-error, error)},
                       uniform(-180.0, 180.0), {uniform(0.4, 0.6), uniform(0.4, 0.6)});
  job.tool.nose_angle_deg = uniform(30.0, 60.0);
  job.tool.clearance_deg = uniform(2.0, 6.0);
  job.tool.wedge_deg = uniform(55.0, 72.0);
  job.tool.edge_radius_um = uniform(0.0, 5.0);
  job.tool.width_mm = 1.5 * cavity_edge_mm(job.element) * std::numbers::sqrt2 *
                      std::tan(0.5 * job.tool.nose_angle_deg * std::numbers::pi / 180.0);
  return job;
}

TEST(RoundedCuts, RandomNosesPass) {
  const int noses = retrace::test::sample_size(40, 500);
  std::mt19937 bits(17);
  int cut = 0;
  for (int tried = 0; cut < noses && tried < 10 * noses; ++tried) {
    const Job job = random_corner(bits);
    if (!fits(job)) continue;
    std::string text;
    try {
      text = text_of(job, machine());
    } catch (const InputError& error) {
      EXPECT_EQ(place_of(error), "tool.wedge_deg");
      continue;
    }
    ++cut;
    const Verification v = verified(job, machine(), text);
    EXPECT_TRUE(v.passes()) << job_text(job) << listed(v);
  }
  EXPECT_EQ(cut, noses);
}

/// On a machine with alignment errors, the tool is rotated relative to the facets, which changes the overlap of the
/// cuts at dihedral edges. A job with zones must either be refused, because fins would remain at these edges, or pass
/// verification.
TEST(RoundedCuts, RandomNosesPassOnMachinesWithErrors) {
  const int noses = retrace::test::sample_size(40, 500);
  std::mt19937 bits(19);
  int cut = 0;
  int refused = 0;
  for (int tried = 0; cut < noses && tried < 20 * noses; ++tried) {
    const Job job = random_corner(bits);
    if (!fits(job)) continue;
    const Machine m = crooked_machine();
    std::string text;
    try {
      text = text_of(job, m);
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    ++cut;
    const Verification v = verified(job, m, text);
    EXPECT_TRUE(v.passes()) << job_text(job) << listed(v);
  }
  EXPECT_EQ(cut, noses);
  EXPECT_GT(refused, 0);
}

/// A Fanuc control rounds positions to its increments. A job of cube corners must either pass verification or be
/// refused with an error that names the key to change.
TEST(RoundedCuts, CubeCornersOfEveryIncrementSystemPassOrAreRefused) {
  for (const IncrementSystem system : {IncrementSystem::b, IncrementSystem::c, IncrementSystem::d, IncrementSystem::e})
    for (const bool is_hexagonal : {false, true})
      for (const double error_arcmin : {0.0, 25.0, -25.0}) {
        Job job = cube_job(is_hexagonal, 0.2);
        job.tool.width_mm *= 1.2;
        job.angle_errors.dihedral_error_arcmin = {error_arcmin, -0.5 * error_arcmin, 0.3 * error_arcmin};
        Machine m = machine();
        m.control.increment_system = system;
        const bool is_coarse = system == IncrementSystem::b || system == IncrementSystem::c;
        try {
          const Verification v = verified(job, m, text_of(job, m, "fanuc"), NcDialect::fanuc);
          EXPECT_TRUE(v.passes()) << static_cast<int>(system) << ' ' << is_hexagonal << ' ' << error_arcmin << "\n"
                                  << listed(v);
          EXPECT_FALSE(is_coarse);
        } catch (const InputError& error) {
          EXPECT_TRUE(is_coarse) << error.what();
          EXPECT_EQ(recorded_place_of(error), system == IncrementSystem::b ? "process.roughing_depth_um" : "machine");
        }
      }
}

/// If a job is refused, its error reports a minimum wedge angle or a maximum increment. A job at this limit is
/// accepted, and a job beyond the limit is refused. Messages contain the limit, and their numbers have at most eight
/// digits.
TEST(RoundedCuts, LimitsOfRefusedJobsAreAccepted) {
  const auto refusal = [](const Job& job, const Machine& m) -> std::optional<LimitError> {
    try {
      check_on_machine(job, m);
    } catch (const LimitError& error) {
      EXPECT_FALSE(std::regex_search(error.what(), std::regex("[0-9]{9}|[0-9]\\.[0-9]{8}"))) << error.what();
      return error;
    }
    return std::nullopt;
  };
  int wedges = 0;
  int steps = 0;
  for (const std::int64_t step_nm : {1, 3, 10, 40, 70, 100})
    for (const double wedge_deg : {58.95, 59.0, 59.3, 60.0, 62.0, 65.0, 80.0}) {
      Job job = cube_job(true, 0.2);
      job.process.roughing_depth_um = job.process.finishing_depth_um = 20.0;
      job.tool.wedge_deg = wedge_deg;
      Machine m = machine();
      m.increments.linear_nm = step_nm;
      const std::optional<LimitError> refused = refusal(job, m);
      if (!refused) continue;
      const std::string what = refused->what();
      if (refused->where().key == "tool.wedge_deg") {
        ++wedges;
        EXPECT_NE(what.find(" " + shortest(refused->limit()) + ","), std::string::npos) << what;
        job.tool.wedge_deg = refused->limit();
        EXPECT_FALSE(refusal(job, m)) << what;
        EXPECT_TRUE(fits(job)) << what;
        job.tool.wedge_deg = refused->limit() - 0.11;
        EXPECT_TRUE(refusal(job, m)) << what;
      } else {
        ASSERT_EQ(refused->where().key, "machine") << what;
        ++steps;
        EXPECT_NE(what.find(" " + fixed(refused->limit(), 4) + " um"), std::string::npos) << what;
        m.increments.linear_nm = static_cast<std::int64_t>(std::floor(1e3 * refused->limit() + 1e-6));
        if (m.increments.linear_nm >= 1) {
          EXPECT_FALSE(refusal(job, m)) << what;
        }
        ++m.increments.linear_nm;
        EXPECT_TRUE(refusal(job, m)) << what;
      }
    }
  EXPECT_GT(wedges, 5);
  EXPECT_GT(steps, 5);
}

}  // namespace
}  // namespace retrace::fabrication::test::rounded_cuts_test
