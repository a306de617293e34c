#include "studies/calibration/calibration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "studies/calibration/io/measurement_reader.h"
#include "tests/support/prism_jobs.h"
#include "tests/support/refusals.h"
#include "tests/support/seen_parts.h"

// Tests of the calibration of machines. The verifier cuts test parts with a machine that has errors in all quantities
// that a set-up leaves uncertain. The verifier does not use the derivatives of the calibration. From noisy measurements
// of the tilts and distances of the facets, the calibration must determine these errors.

namespace retrace::studies::calibration_test {
namespace {

using namespace fabrication;
using test::hidden_errors, test::measured_of, test::planned, test::prism_job, test::programs_of;

/// Returns a job with prisms 10 mm apart. Their facets are cut at C = 0, 90, 180 and 270, and at the position of axis A
/// that belongs to their apex angle.
std::string job_text(double apex_angle_deg) {
  return prism_job({apex_angle_deg, 9.5, 30.0, 1});
}

const std::vector<double> kApexAngles = {90.0, 70.0, 105.0};

/// Jobs of the three test parts, with the contents of their programs.
struct TestCuts {
  std::vector<FabricationResult> plans;
  std::vector<std::vector<NcProgram>> programs;

  TestCuts() {
    for (const double angle : kApexAngles) {
      plans.push_back(planned(job_text(angle)));
      programs.push_back(programs_of(plans.back()));
    }
  }
};

const TestCuts& test_cuts() {
  static const TestCuts cuts;
  return cuts;
}

/// Returns the standard uncertainty of a measurement, in nm or arcsec.
double uncertainty_of(FacetQuantity what) {
  return what == FacetQuantity::distance ? 5.0 : 1.0;
}

/// Returns measurements of parts that the machine has cut. Each part is rotated by about 50 arcsec and shifted by about
/// 10 um.
MeasuredParts measured_on(const Machine& real, std::mt19937& bits) {
  std::normal_distribution<double> normal;
  const TestCuts& cuts = test_cuts();
  MeasuredParts parts;
  parts.file = "measurements.csv";
  for (std::size_t k = 0; k < cuts.plans.size(); ++k) {
    const FabricationResult& plan = cuts.plans[k];
    parts.jobs.push_back(fmt::format("{}.toml", k));
    parts.plans.push_back(plan);
    const Verification v = verify_programs(plan.job, real, cuts.programs[k], {}, {});
    const std::vector<Cavity> grooves = designed_cavities(plan.job);
    const geometry::Vec3 turn = 50.0 / kArcsecPerRad * geometry::Vec3(normal(bits), normal(bits), normal(bits));
    const RigidMotion pose{rotation_about(turn.normalized(), Angle::from_rad(turn.norm())),
                           {1e-2 * normal(bits), 1e-2 * normal(bits), 0.0}};
    for (std::size_t element = 0; element < grooves.size(); ++element)
      for (std::size_t facet = 0; facet < 2; ++facet)
        for (const FacetQuantity what : {FacetQuantity::distance, FacetQuantity::tilt_up, FacetQuantity::tilt_along}) {
          Measurement m{k, {element, facet}, what, 0.0, uncertainty_of(what), {}, 0.0, 0};
          m.value = measured_of(grooves[element], v.elements[element].figures.facets[facet], facet, what, pose) +
                    m.uncertainty * normal(bits);
          m.line = static_cast<int>(parts.measurements.size()) + 2;
          parts.measurements.push_back(m);
        }
  }
  return parts;
}

std::vector<std::string> told(const Calibration& found) {
  std::vector<std::string> keys;
  for (const CalibratedQuantity& q : found.quantities)
    if (q.is_observable) keys.emplace_back(q.quantity->key);
  return keys;
}

/// Measurements of facets determine only three quantities individually. The other quantities are known only in
/// combinations, or not at all. Quantities that are not known are, for example, errors that move the cutting edge along
/// itself or in the plane of the facet, the clearance, and a common shift of all axes.
TEST(Calibration, SaysWhatFacetsDoNotTell) {
  std::mt19937 bits(1);
  const Calibration found = calibrate(measured_on(test_cuts().plans.front().machine, bits));
  EXPECT_EQ(told(found), (std::vector<std::string>{"c_lean_y_arcsec", "a_z_um", "tool_rotation_z_arcsec"}));
}

/// For quantities that can be determined, the 95 % intervals contain the true values in 90 to 99 % of the cases. The
/// test uses 100 machines.
TEST(Calibration, IntervalsHoldWhatIsHidden) {
  constexpr int kMachines = 100;
  std::size_t within = 0;
  std::size_t all = 0;
  int with_outliers = 0;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    std::mt19937 bits(seed);
    const std::vector<double> hidden = hidden_errors(bits);
    const Calibration found = calibrate(measured_on(with_errors(test_cuts().plans.front().machine, hidden), bits));
    with_outliers += found.outliers.empty() ? 0 : 1;
    for (std::size_t k = 0; k < hidden.size(); ++k) {
      if (!found.quantities[k].is_observable) continue;
      ++all;
      if (std::abs(found.quantities[k].value - hidden[k]) < 1.96 * found.quantities[k].uncertainty) ++within;
    }
  }
  const double share = static_cast<double>(within) / static_cast<double>(all);
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.99);
  EXPECT_LE(with_outliers, kMachines / 20) << "right measurements are rarely taken for wrong ones";
}

/// Returns the largest tilt of the facets relative to each other. The best-fitting rotation of the whole part is
/// subtracted.
double largest_tilt_arcsec(const FabricationResult& plan, const Machine& real) {
  const Verification v = verify_programs(plan.job, real, programs_of(plan), {}, {});
  const std::vector<Cavity> grooves = designed_cavities(plan.job);
  std::vector<double> tilts;
  std::vector<geometry::Vec3> of_turn;
  for (std::size_t element = 0; element < grooves.size(); ++element)
    for (std::size_t facet = 0; facet < 2; ++facet) {
      const FacetFigures& figures = v.elements[element].figures.facets[facet];
      const DesignFacet& design = common(grooves[element]).facets[facet];
      tilts.insert(tilts.end(), {kArcsecPerRad * figures.slope_up, kArcsecPerRad * figures.slope_along});
      of_turn.push_back(design.up_slope.cross(design.normal));
      of_turn.push_back(design.along.cross(design.normal));
    }
  Eigen::MatrixXd turns(static_cast<Eigen::Index>(tilts.size()), 3);
  for (std::size_t k = 0; k < tilts.size(); ++k) turns.row(static_cast<Eigen::Index>(k)) = of_turn[k].transpose();
  const Eigen::VectorXd all = Eigen::VectorXd::Map(tilts.data(), static_cast<Eigen::Index>(tilts.size()));
  return (all - turns * turns.colPivHouseholderQr().solve(all)).cwiseAbs().maxCoeff();
}

/// The first programs are planned for the nominal machine, the second for the calibrated machine. The tilts of the
/// second part's facets must be at most a twentieth of those of the first part, or at most 2 arcsec.
TEST(Calibration, TheSecondCutIsRight) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    std::mt19937 bits(seed);
    const Machine real = with_errors(test_cuts().plans.front().machine, hidden_errors(bits));
    const Calibration found = calibrate(measured_on(real, bits));
    FabricationResult second = test_cuts().plans.front();
    const double first_arcsec = largest_tilt_arcsec(second, real);
    second.machine = found.machine;
    second.plan = make_plan(second.job, second.machine);
    EXPECT_LT(largest_tilt_arcsec(second, real), std::max(0.05 * first_arcsec, 2.0)) << seed;
  }
}

TEST(Calibration, NamesWhatTheOthersContradict) {
  std::mt19937 bits(3);
  MeasuredParts parts = measured_on(test_cuts().plans.front().machine, bits);
  parts.measurements[10].value += 30.0 * parts.measurements[10].uncertainty;
  const Calibration found = calibrate(parts);
  ASSERT_EQ(found.outliers.size(), 1U);
  EXPECT_EQ(found.outliers[0].measurement.line, parts.measurements[10].line);
  EXPECT_GT(found.outliers[0].deviations, 20.0);
  // If a third of the measurements are wrong, the calibration cannot determine which ones.
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < parts.measurements.size(); k += 3)
    parts.measurements[k].value += 1e4 * normal(bits) * parts.measurements[k].uncertainty;
  try {
    calibrate(parts);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "measurements.csv:8");
  }
}

std::string refusal_of(const MeasuredParts& parts) {
  try {
    calibrate(parts);
  } catch (const InputError& error) {
    return recorded_place_of(error);
  }
  return "accepted";
}

/// On one part, the user enters the tilts along the roots of rotated prisms with the wrong sign. Only 4 of 72 rows are
/// wrong, which would not be too many outliers. Without these rows, however, no measurement of this quantity remains,
/// so that the table is refused.
TEST(Calibration, RefusesAWrongSignOfAllThatWasMeasuredOfAFacet) {
  const Machine& ideal = test_cuts().plans.front().machine;
  const Machine real = with_error(ideal, *setup_quantity(Tilt::table, "tool_rotation_z_arcsec"), 60.0);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    std::mt19937 bits(seed);
    MeasuredParts parts = measured_on(real, bits);
    ASSERT_EQ(refusal_of(parts), "accepted");
    const auto is_of_turned = [](const Measurement& m) {
      return m.part == 1 && m.what == FacetQuantity::tilt_along && (m.at.element == 1 || m.at.element == 2);
    };
    for (Measurement& m : parts.measurements)
      if (is_of_turned(m)) m.value = -m.value;
    EXPECT_TRUE(refusal_of(parts).ends_with(": value")) << seed;
    // If only one of two rows is wrong, it is an outlier, and the table is accepted.
    for (Measurement& m : parts.measurements)
      if (is_of_turned(m) && m.at != FacetId{1, 0}) m.value = -m.value;
    EXPECT_EQ(refusal_of(parts), "accepted") << seed;
  }
}

/// The test tilts a part so that its +X or +Y side rises. The facets then rise towards this side, and positive_sense()
/// must name the same direction.
TEST(Calibration, TiltsAlongTheRootArePositiveWhereTheWordsSay) {
  const FabricationResult& plan = test_cuts().plans.front();
  const CutPart part(plan, {});
  for (std::size_t element = 0; element < 4; ++element)
    for (const std::size_t facet : {0U, 1U}) {
      const Measurement along{0, {element, facet}, FacetQuantity::tilt_along, 0.0, 1.0, {}, 0.0, 0};
      const std::string words = part.positive_sense(along);
      ASSERT_TRUE(words == "rises towards +X" || words == "rises towards +Y") << words;
      EXPECT_EQ(words == "rises towards +Y", plan.plan.elements[element].rotated);
      PartPose pose;
      // By the right-hand rule, a rotation about -Y raises the +X side, and a rotation about X raises the +Y side.
      pose.rotation_arcsec = words.ends_with("X") ? geometry::Vec3(0, -10, 0) : geometry::Vec3(10, 0, 0);
      EXPECT_NEAR(part.predicted(along, plan.machine, pose), 10.0 / std::numbers::sqrt2, 1e-3);
    }
}

/// The measurement `end` is the distance between the end of a cut and the root. It must equal the height of the
/// material that the verifier finds at the root, or the depth of the cut into the other facet.
TEST(Calibration, WhereCutsEndIsWhatTheVerifierFinds) {
  const FabricationResult& plan = test_cuts().plans.front();
  const SetupQuantity& quantity = *setup_quantity(Tilt::table, "tool_z_um");
  const CutPart part(plan, {});
  for (const double amount : {1.0, -1.0}) {
    const Machine real = with_error(plan.machine, quantity, amount);
    const Verification v = verify_programs(plan.job, real, test_cuts().programs.front(), {}, {});
    double left_nm = 0.0;
    double cut_nm = 0.0;
    for (const FacetFigures& facet : v.elements[0].figures.facets) {
      left_nm = std::max(left_nm, facet.root.nm);
      cut_nm = std::max(cut_nm, -facet.deepest.nm);
    }
    for (const std::size_t facet : {0U, 1U}) {
      const double end_nm = part.predicted({0, {0, facet}, FacetQuantity::cut_end, 0.0, 1.0, {}, 0.0, 0}, real, {});
      EXPECT_NEAR(std::abs(end_nm), amount > 0.0 ? left_nm : cut_nm, 0.03 * std::abs(end_nm));
      EXPECT_EQ(end_nm > 0.0, amount > 0.0);
    }
  }
}

/// Angles follow from the tilts of both facets, and depths from the distances of both facets.
TEST(Calibration, AnglesAndDepthsFollowFromFacets) {
  std::mt19937 bits(5);
  const FabricationResult& plan = test_cuts().plans.front();
  const Machine real = with_errors(plan.machine, hidden_errors(bits));
  const CutPart part(plan, {});
  for (const std::size_t element : {0U, 1U, 2U, 3U}) {
    const auto measured = [&](std::size_t facet, FacetQuantity what) {
      return part.predicted({0, {element, facet}, what, 0.0, 1.0, {}, 0.0, 0}, real, {});
    };
    const Measurement angle{0, {element, 0}, FacetQuantity::angle, 0.0, 1.0, FacetId{element, 1}, 0.0, 0};
    EXPECT_NEAR(part.predicted(angle, real, {}),
                -measured(0, FacetQuantity::tilt_up) - measured(1, FacetQuantity::tilt_up), 0.02);
    // Distances are measured at the center of a facet, which is half the length of the facet above the root. To get the
    // distances at the root, the effect of the tilts is subtracted.
    const double half_nm = 0.5e6 * std::sqrt(0.125) / kArcsecPerRad;
    const double sum = measured(0, FacetQuantity::distance) + measured(1, FacetQuantity::distance) -
                       half_nm * (measured(0, FacetQuantity::tilt_up) + measured(1, FacetQuantity::tilt_up));
    EXPECT_NEAR(measured(0, FacetQuantity::depth), -sum / std::sqrt(2.0), 2.0) << "but for terms of the second order";
  }
}

/// Tests the messages for wrong tables.
TEST(Calibration, RefusesTables) {
  const FileTexts texts = {{"a.toml", job_text(90.0)}, {"b.toml", job_text(90.0)}};
  const std::string columns = "job,element,facet,what,value,uncertainty,from_element,from_facet,at\n";
  const auto refused = [&](const std::string& table) -> std::string {
    try {
      calibrate(parse_measurements(table, "m.csv", texts));
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "accepted";
  };
  const auto starts = [&](const std::string& rows, const std::string& message) {
    const std::string found = refused(rows);
    EXPECT_TRUE(found.starts_with(message)) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  };
  starts("job,element,facet,what,value\n", "m.csv:1");
  starts(columns, "m.csv");
  starts(columns + "a.toml,0,1,up_arcsec,,1,,,\n", "m.csv");
  starts(columns + "a.toml,0,1,tilt,1,1,,,\n", "m.csv:2: what");
  starts(columns + "a.toml,0,1,up_arcsec,nan,1,,,\n", "m.csv:2: value");
  starts(columns + "a.toml,0,1,up_arcsec,1,0,,,\n", "m.csv:2: uncertainty");
  starts(columns + "a.toml,0.5,1,up_arcsec,1,1,,,\n", "m.csv:2: element");
  starts(columns + "a.toml,4,1,up_arcsec,1,1,,,\n", "m.csv:2");
  starts(columns + "a.toml,0,3,up_arcsec,1,1,,,\n", "m.csv:2");
  starts(columns + "a.toml,0,1,up_arcsec,1,1,0,,\n", "m.csv:2");
  starts(columns + "a.toml,0,1,angle_arcsec,1,1,,,\n", "m.csv:2");
  starts(columns + "a.toml,0,1,angle_arcsec,1,1,0,1,\n", "m.csv:2");
  starts(columns + "a.toml,0,1,up_arcsec,1,1,,,0.5\n", "m.csv:2: at");
  starts(columns + "a.toml,0,1,end_nm,1,1,,,2\n", "m.csv:2: at");
  starts(columns + ",0,1,up_arcsec,1,1,,,\n", "m.csv:2: job");
  starts(columns + "c.toml,0,1,up_arcsec,1,1,,,\n", "m.csv:2: job");
  starts(columns +
             "a.toml,0,1,up_arcsec,1e5,1,,,\na.toml,0,2,up_arcsec,-1e5,1,,,\na.toml,1,1,up_arcsec,9e5,1,,,\n"
             "a.toml,1,2,up_arcsec,1e5,1,,,\n",
         "m.csv");
}

}  // namespace
}  // namespace retrace::studies::calibration_test
