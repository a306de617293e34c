#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/number_format.h"
#include "core/text.h"
#include "design/io/design_reader.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "studies/calibration/correction.h"
#include "studies/calibration/io/calibration_files.h"
#include "studies/calibration/test_cuts.h"
#include "studies/fabrication/job_maker.h"
#include "tests/support/seen_parts.h"

// Tests of the measurements in examples/calibration, which docs/tutorials/test_cuts.md uses. The verifier carries out
// programs on a machine with hidden errors. The resulting values and a height map have noise. If
// RETRACE_WRITE_EXAMPLES=1 is set, the test writes the files again. They must be reviewed before they are committed,
// and the numbers in docs/tutorials/test_cuts.md must be updated.

namespace retrace::studies::calibration_example_test {
namespace {

using namespace fabrication;
using geometry::Vec3;
using test::CutSurface, test::measured_of, test::PatternedSurface, test::UnderEdge;

const std::string kFolder = RETRACE_SOURCE_DIR "/examples/calibration/";

using Errors = std::map<std::string_view, double>;

/// Errors of the machine by the keys of setup_quantities(), in um and arcsec. kHidden contains the errors when the test
/// cuts are made. kChange contains the changes of these errors until the part is cut, with another tool and on a warm
/// machine.
const Errors kHidden = {{"c_x_um", 0.6},
                        {"c_y_um", -0.7},
                        {"a_y_um", 0.4},
                        {"a_z_um", 0.8},
                        {"c_lean_x_arcsec", 35.0},
                        {"c_lean_y_arcsec", -48.0},
                        {"a_lean_y_arcsec", 20.0},
                        {"a_lean_z_arcsec", -30.0},
                        {"y_lean_x_arcsec", 25.0},
                        {"y_lean_z_arcsec", 15.0},
                        {"z_lean_x_arcsec", -20.0},
                        {"tool_x_um", 0.5},
                        {"tool_y_um", -0.6},
                        {"tool_z_um", 0.3},
                        {"tool_rotation_x_arcsec", 40.0},
                        {"tool_rotation_y_arcsec", -25.0},
                        {"tool_rotation_z_arcsec", 55.0}};
const Errors kChange = {{"c_lean_y_arcsec", 12.0},
                        {"tool_x_um", 0.2},
                        {"tool_y_um", 0.5},
                        {"tool_z_um", -0.2},
                        {"tool_rotation_y_arcsec", 10.0},
                        {"tool_rotation_z_arcsec", -30.0}};
/// Mark of the chipped edge of the other tool: its distance from the center of the edge, its width and its depth.
constexpr double kChipUm = 120.0;
constexpr double kChipWidthUm = 26.0;
constexpr double kChipDepthNm = 80.0;

std::vector<double> in_order(const Errors& errors) {
  std::vector<double> all;
  for (const SetupQuantity& quantity : setup_quantities(Tilt::table)) {
    const auto found = errors.find(quantity.key);
    all.push_back(found == errors.end() ? 0.0 : found->second);
  }
  return all;
}

std::vector<double> hidden() {
  return in_order(kHidden);
}

std::vector<double> hidden_later() {
  std::vector<double> errors = hidden();
  const std::vector<double> change = in_order(kChange);
  for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += change[k];
  return errors;
}

std::string told(const std::vector<double>& errors) {
  std::string text;
  std::string line = "#";
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const std::string word = fmt::format(" {} {}{}", setup_quantities(Tilt::table)[k].key, shortest(errors[k]),
                                         k + 1 < errors.size() ? "," : ".");
    if (line.size() + word.size() > 110) text += std::exchange(line, "#") + "\n";
    line += word;
  }
  return text + line + "\n";
}

struct Example {
  std::string measurements;
  std::string map;
  std::string machine;
  Calibration calibrated;
  Correction corrected;
};

JobRequest request() {
  JobRequest request;
  request.machine = "ideal";
  request.tool_width_mm = 0.5;
  return request;
}

/// Returns three numbers with a normal distribution. Each number is drawn in a separate statement, the last component
/// first. If the numbers were drawn in the arguments of one call, their order would depend on the compiler.
Vec3 normal_vector(std::normal_distribution<double>& normal, std::mt19937& bits) {
  Vec3 drawn;
  for (Eigen::Index k = 3; k-- > 0;) drawn[k] = normal(bits);
  return drawn;
}

/// Simulates the measurements of the test cuts and fills their table with the values.
void measure(Example& example, const design::Design& design, std::mt19937& bits) {
  std::normal_distribution<double> normal;
  TestCuts cuts = plan_test_cuts(design, request());
  const Machine real = with_errors(cuts.parts.plans.front().machine, hidden());
  std::vector<CutSurface> surfaces;
  std::vector<CutPart> parts;
  std::vector<RigidMotion> poses;
  for (const FabricationResult& plan : cuts.parts.plans) {
    surfaces.emplace_back(real, plan);
    parts.emplace_back(plan, std::vector<std::size_t>());
    const Vec3 turn = 1e-4 * normal_vector(normal, bits);
    poses.push_back({rotation_about(turn.normalized(), Angle::from_rad(turn.norm())),
                     {5e-3 * normal(bits), 5e-3 * normal(bits), 0.0}});
  }
  example.measurements =
      "# Simulated, not measured: the programs of the test cuts were executed on machine \"ideal\" with the errors "
      "below (um and\n"
      "# arcsec). Each part was displaced by some 5 um and rotated by some 20 arcsec. Values have noise of their "
      "uncertainty:\n" +
      told(hidden());
  const std::string table = test_cuts_csv(cuts);
  std::istringstream rows(table);
  std::string row;
  std::getline(rows, row);
  example.measurements += row + "\n";
  for (Measurement& m : cuts.parts.measurements) {
    const bool is_end = m.what == FacetQuantity::cut_end;
    const double truth =
        is_end ? parts[m.part].predicted(m, real, {})
               : measured_of(surfaces[m.part].grooves()[m.at.element],
                             surfaces[m.part].figures(m.at.element, m.at.facet), m.at.facet, m.what, poses[m.part]);
    const std::string value = fixed(truth + m.uncertainty * normal(bits), 2);
    m.value = *number_in(value);
    std::getline(rows, row);
    example.measurements += row.replace(row.find(",,"), 2, "," + value + ",") + "\n";
  }
  example.calibrated = calibrate(std::move(cuts.parts));
}

/// Simulates the height map of a part. The part is cut later than the test cuts, by programs for the calibrated
/// machine.
void look(Example& example, const design::Design& design, std::mt19937& bits) {
  FabricationResult plan = test::planned(job_text(make_job(design, request()).job));
  plan.machine = example.calibrated.machine;
  plan.plan = make_plan(plan.job, plan.machine);
  const Machine real = with_errors(test::planned(job_text(make_job(design, request()).job)).machine, hidden_later());
  example.machine = machine_text(real);
  const CutSurface cut(real, plan);
  FacetMap map = test::seen(PatternedSurface(cut,
                                             [](const UnderEdge& at) {
                                               const double off = (1e3 * at.along_mm - kChipUm) / (0.5 * kChipWidthUm);
                                               return kChipDepthNm * std::max(0.0, 1.0 - off * off);
                                             }),
                            bits, 150);
  const double lowest = *std::ranges::min_element(map.heights.heights_nm);
  example.map = fmt::format(
      "# Simulated, not measured: the part of part.toml, cut by its programs for the calibrated machine on the machine "
      "of\n"
      "# machine_as_it_is.toml. The map is tilted, with 5 nm of noise. The edge has a chip {} um from its centre, {} "
      "nm deep.\n"
      "# pixel_um = {}\n# height_unit = nm\n",
      shortest(kChipUm), shortest(kChipDepthNm), shortest(map.heights.x_pixel_um));
  for (std::size_t row = 0; row < map.heights.rows; ++row)
    for (std::size_t column = 0; column < map.heights.columns; ++column) {
      double& nm = map.heights.at(column, row);
      nm = std::round(nm - lowest);
      example.map += fmt::format("{}{}", static_cast<long>(nm), column + 1 < map.heights.columns ? " " : "\n");
    }
  example.corrected = correct(plan, {std::move(map)});
}

const Example& example() {
  static const Example made = [] {
    Example example;
    std::mt19937 bits(31);
    const design::Design design = design::read_design(kFolder + "part.toml");
    measure(example, design, bits);
    look(example, design, bits);
    return example;
  }();
  return made;
}

/// Returns true if both texts have the same words and numbers. Numbers may differ by one unit of their last digit,
/// because rounding may differ between processors.
bool is_same(const std::string& a, const std::string& b, double last_place) {
  const auto words_of = [](std::string text) {
    std::ranges::replace(text, ',', ' ');
    std::istringstream words(text);
    return std::vector<std::string>{std::istream_iterator<std::string>(words), {}};
  };
  return std::ranges::equal(words_of(a), words_of(b), [&](const std::string& x, const std::string& y) {
    const auto m = number_in(x);
    const auto n = number_in(y);
    return x == y || (m && n && std::abs(*m - *n) <= 1.5 * last_place);
  });
}

TEST(CalibrationExample, FilesAreWhatIsMade) {
  const Example& made = example();
  for (const auto& [name, text, last_place] :
       {std::tuple{"measurements.csv", made.measurements, 0.01}, std::tuple{"facets.txt", made.map, 1.0},
        std::tuple{"machine_as_it_is.toml", made.machine, 1e-9}}) {
    if (std::getenv("RETRACE_WRITE_EXAMPLES") != nullptr) std::ofstream(kFolder + name) << text;
    EXPECT_TRUE(is_same(read_file(kFolder + name, 1U << 20U), text, last_place)) << name;
  }
}

/// The planned measurements contain no distances of facets for some of the parts, so that the positions of these parts
/// along X are unknown. An unknown position must not be mistaken for an error in the height of an axis. The test counts
/// the 95 % intervals of each quantity that contain the true error, over 100 machines.
TEST(CalibrationExample, TestCutsFindWhatIsHidden) {
  constexpr std::uint32_t kMachines = 100;
  const TestCuts cuts = plan_test_cuts(design::read_design(kFolder + "part.toml"), request());
  std::vector<CutPart> parts;
  for (const FabricationResult& plan : cuts.parts.plans) parts.emplace_back(plan, std::vector<std::size_t>());
  std::map<std::string_view, std::size_t> within;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    std::mt19937 bits(seed);
    std::normal_distribution<double> normal;
    const std::vector<double> errors = test::hidden_errors(bits);
    const Machine real = with_errors(cuts.parts.plans.front().machine, errors);
    std::vector<PartPose> poses(parts.size());
    for (PartPose& pose : poses) {
      pose.rotation_arcsec = 50.0 * normal_vector(normal, bits);
      pose.shift_um = {10.0 * normal(bits), 10.0 * normal(bits), 0.0};
    }
    MeasuredParts measured = cuts.parts;
    for (Measurement& m : measured.measurements)
      m.value = parts[m.part].predicted(m, real, poses[m.part]) + m.uncertainty * normal(bits);
    const Calibration found = calibrate(std::move(measured));
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const CalibratedQuantity& q = found.quantities[k];
      if (q.is_observable) within[q.quantity->key] += std::abs(q.value - errors[k]) < 1.96 * q.uncertainty ? 1U : 0U;
    }
  }
  EXPECT_EQ(within.size(), 9U);
  // If each interval contains the true value with a probability of 95 %, at least 89 of 100 intervals contain it with a
  // probability of 99 %.
  for (const auto& [key, count] : within) EXPECT_GE(count, 89U) << key;
}

/// At the end of the tutorial, the determined errors of the machine are the hidden errors.
TEST(CalibrationExample, WhatIsHiddenIsFound) {
  const auto expect_found = [](const Calibration& found, const std::vector<double>& errors) {
    std::size_t told = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const CalibratedQuantity& q = found.quantities[k];
      if (!q.is_observable) continue;
      ++told;
      EXPECT_NEAR(q.value, errors[k], 2.6 * q.uncertainty) << q.quantity->key;
    }
    return told;
  };
  const Example& made = example();
  EXPECT_GE(expect_found(made.calibrated, hidden()), 8U);
  // The calibrated machine already contains the errors that the test cuts have determined. The correction must find the
  // remaining errors.
  std::vector<double> rest = hidden_later();
  for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= made.calibrated.quantities[k].value;
  EXPECT_GE(expect_found(made.corrected.calibration, rest), 2U);
  ASSERT_EQ(made.corrected.marks.size(), 1U);
  EXPECT_TRUE(made.corrected.marks.front().is_of_edge);
  EXPECT_NEAR(made.corrected.marks.front().position_um, kChipUm, 10.0);
}

}  // namespace
}  // namespace retrace::studies::calibration_example_test
