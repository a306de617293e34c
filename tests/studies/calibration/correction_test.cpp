#include "studies/calibration/correction.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "tests/support/prism_jobs.h"
#include "tests/support/refusals.h"
#include "tests/support/sample_size.h"
#include "tests/support/seen_parts.h"

// Tests of the correction of machines with hidden errors. The verifier cuts a part on such a machine. A profiler with
// noise measures the part, whose position and orientation are unknown. The correction must find the errors of the
// machine and their uncertainties.

namespace retrace::studies::correction_test {
namespace {

using namespace fabrication;
using test::CutSurface, test::four_prisms, test::hidden_errors, test::seen;

const std::uint32_t kMachines = retrace::test::sample_size(40U, 200U);

/// Machine with hidden errors of about 1 um and 0.02 degrees, and the errors that the correction finds.
struct FoundMachine {
  std::vector<double> hidden;
  Machine real;
  CutSurface first;  ///< surface that the programs of the job cut
  Correction found;
};

/// Returns the machine for a seed. Each machine is computed only one time for all tests of this file.
const FoundMachine& found_machine(std::uint32_t seed) {
  static std::map<std::uint32_t, FoundMachine> all;
  if (const auto known = all.find(seed); known != all.end()) return known->second;
  std::mt19937 bits(seed);
  std::vector<double> hidden = hidden_errors(bits);
  Machine real = with_errors(four_prisms().machine, hidden);
  CutSurface first(real);
  Correction found = correct(four_prisms(), {seen(first, bits)});
  found.maps.clear();
  return all.emplace(seed, FoundMachine{std::move(hidden), std::move(real), std::move(first), std::move(found)})
      .first->second;
}

/// The 95 % intervals must contain the hidden values on 95 % of the machines. The tolerance is 2.58 standard deviations
/// of the binomial distribution, which correct intervals exceed with a probability of 1 %.
TEST(Correction, IntervalsHoldWhatIsHidden) {
  std::map<std::string_view, std::size_t> within;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    const FoundMachine& machine = found_machine(seed);
    std::vector<std::string_view> told;
    for (std::size_t k = 0; k < machine.hidden.size(); ++k) {
      const CalibratedQuantity& q = machine.found.calibration.quantities[k];
      if (!q.is_observable) continue;
      told.push_back(q.quantity->key);
      within[q.quantity->key] += std::abs(q.value - machine.hidden[k]) < 1.96 * q.uncertainty ? 1U : 0U;
    }
    EXPECT_EQ(told, (std::vector<std::string_view>{"c_lean_y_arcsec", "tool_rotation_z_arcsec"})) << seed;
  }
  for (const auto& [key, count] : within) {
    EXPECT_NEAR(static_cast<double>(count), 0.95 * kMachines, 2.58 * std::sqrt(0.95 * 0.05 * kMachines)) << key;
  }
}

/// The programs are planned for the corrected machine, and the verifier cuts them on the real machine. The errors of
/// the facets must be less than the predicted errors (two standard uncertainties) or 5 % of the errors of the first
/// part, whichever is larger. The error of an apex angle may be two predicted tilts, because two facets contribute.
TEST(Correction, TheSecondPartIsAsPromised) {
  constexpr double kLeft = 0.05;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    const FoundMachine& machine = found_machine(seed);
    FabricationResult second = four_prisms();
    second.machine = machine.found.calibration.machine;
    second.plan = make_plan(second.job, second.machine);
    const CutSurface cut(machine.real, second);
    const DeviationPrediction before = machine.first.off();
    const DeviationPrediction now = cut.off();
    const DeviationPrediction& promised = machine.found.after;
    EXPECT_LT(now.distance_nm, std::max(kLeft * before.distance_nm, promised.distance_nm)) << seed;
    EXPECT_LT(now.tilt_arcsec, std::max(kLeft * before.tilt_arcsec, promised.tilt_arcsec)) << seed;
    EXPECT_LT(cut.apex_error_arcsec(), std::max(kLeft * machine.first.apex_error_arcsec(), 2.0 * promised.tilt_arcsec))
        << seed;
  }
}

/// The registration uses 300 of the 90,000 points, which is as many as the map has rows. Points at regular steps would
/// therefore all be in one column.
TEST(Correction, MapsOfAnySizeAreRegistered) {
  for (const std::size_t points : {120U, 300U}) {
    std::mt19937 bits(7);
    const RegisteredMap map = registered(seen(CutSurface(four_prisms().machine), bits, points), four_prisms());
    EXPECT_EQ(map.figures.size(), 24U) << points;
    EXPECT_LT(map.rms_nm, 6.0) << points;
  }
}

TEST(Correction, RefusesMapsOfOtherParts) {
  std::mt19937 bits(1);
  FacetMap map = seen(CutSurface(four_prisms().machine), bits);
  const auto refused = [](const FacetMap& given) -> std::string {
    try {
      correct(four_prisms(), {given});
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "accepted";
  };
  FacetMap rough = map;
  std::normal_distribution<double> normal;
  for (double& nm : rough.heights.heights_nm) nm = 5e4 * normal(bits);
  EXPECT_EQ(refused(rough), "map.txt");
  FacetMap flat = map;
  std::fill(flat.heights.heights_nm.begin(), flat.heights.heights_nm.end(), 0.0);
  EXPECT_NE(refused(flat), "accepted");
  FacetMap empty = map;
  std::fill(empty.heights.heights_nm.begin(), empty.heights.heights_nm.end(), surface_models::kMissing);
  EXPECT_EQ(refused(empty), "map.txt");
}

}  // namespace
}  // namespace retrace::studies::correction_test
