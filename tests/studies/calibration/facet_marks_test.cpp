#include "studies/calibration/facet_marks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "studies/calibration/correction.h"
#include "tests/support/prism_jobs.h"
#include "tests/support/seen_parts.h"

// Tests of waves and of marks of a chipped edge on the facets of a part. The part is measured with noise, and its
// position and orientation are unknown. Existing waves and marks must be found with the right properties, none may be
// found on other facets, and the errors of the machine must be found as well.

namespace retrace::studies::facet_marks_test {
namespace {

using namespace fabrication;
using geometry::Vec3;
using test::CutSurface, test::four_prisms, test::hidden_errors, test::PatternedSurface, test::seen, test::UnderEdge;

struct HiddenMachine {
  std::vector<double> errors;
  CutSurface cut;

  explicit HiddenMachine(std::mt19937& bits)
      : errors(hidden_errors(bits)), cut(with_errors(four_prisms().machine, errors)) {}

  template <class Pattern>
  Correction corrected(std::mt19937& bits, Pattern pattern) const {
    return correct(four_prisms(), {seen(PatternedSurface(cut, pattern), bits)});
  }
  /// Returns the number of 95 % intervals that contain the hidden value, and the number of all intervals.
  std::pair<int, int> held(const Correction& found) const {
    std::pair<int, int> counts;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const CalibratedQuantity& q = found.calibration.quantities[k];
      if (!q.is_observable) continue;
      counts.first += std::abs(q.value - errors[k]) < 1.96 * q.uncertainty ? 1 : 0;
      ++counts.second;
    }
    return counts;
  }
};

constexpr std::uint32_t kMachines = 40;

TEST(FacetMarks, NothingIsToldOfNoise) {
  std::uint32_t alarms = 0;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    std::mt19937 bits(seed);
    const HiddenMachine machine(bits);
    const Correction found = machine.corrected(bits, [](const UnderEdge&) { return 0.0; });
    EXPECT_EQ(found.facets, 8U);
    alarms += found.waves.empty() && found.marks.empty() ? 0U : 1U;
  }
  EXPECT_LE(alarms, kMachines / 20);
}

using Simulation =
    std::function<void(std::uint32_t seed, std::mt19937& bits, const HiddenMachine& machine, Correction& found)>;

/// Simulates measurements for all hidden machines, and expects that 90 % of the intervals contain the hidden values.
/// \param simulate function that measures a part of the machine and checks the correction `found`
void expect_hidden_values_found(const Simulation& simulate) {
  int held = 0;
  int all = 0;
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    std::mt19937 bits(seed);
    const HiddenMachine machine(bits);
    Correction found;
    simulate(seed, bits, machine, found);
    if (::testing::Test::HasFatalFailure()) return;
    const auto [in, of] = machine.held(found);
    held += in;
    all += of;
  }
  EXPECT_GE(held, 0.9 * all);
}

/// Waves along the edge have the same phase on all facets, because they are copies of the edge. Waves up the facet
/// begin with a different phase on each facet.
TEST(FacetMarks, WavesAreFound) {
  const auto simulate = [](std::uint32_t seed, std::mt19937& bits, const HiddenMachine& machine, Correction& found) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const bool is_along = seed % 2 == 0;
    const double length_um = seed <= 4 ? 40.0 : 30.0 + 40.0 * uniform(bits);
    const double amplitude_nm = seed <= 4 ? 20.0 : 10.0 + 20.0 * uniform(bits);
    const double phase = 2.0 * std::numbers::pi * uniform(bits);
    found = machine.corrected(bits, [=](const UnderEdge& at) {
      return amplitude_nm * std::sin(phase + 2e3 * std::numbers::pi / length_um * (is_along ? at.along_mm : at.up_mm));
    });
    ASSERT_EQ(found.waves.size(), 1U) << seed;
    const FacetWave& wave = found.waves.front();
    EXPECT_EQ(wave.is_along_edge, is_along) << seed;
    EXPECT_NEAR(wave.length_um, length_um, 0.05 * length_um) << seed;
    EXPECT_NEAR(wave.amplitude_nm, amplitude_nm, 0.2 * amplitude_nm) << seed;
    EXPECT_GE(wave.facets.size(), 6U) << seed;
    ASSERT_EQ(wave.frequency_hz.has_value(), !is_along) << seed;
    // The feed of finishing cuts is 20 mm/min.
    if (!is_along) {
      EXPECT_NEAR(*wave.frequency_hz, 20.0 / 60.0 / (1e-3 * wave.length_um), 1e-9) << seed;
    }
    EXPECT_TRUE(found.marks.empty()) << seed;
    EXPECT_FALSE(found.calibration.warnings.empty()) << seed;
  };
  expect_hidden_values_found(simulate);
}

/// The edge has a pit, and every facet has a ridge that is the negative of this pit.
TEST(FacetMarks, ChipsOfTheEdgeAreFound) {
  const auto simulate = [](std::uint32_t seed, std::mt19937& bits, const HiddenMachine& machine, Correction& found) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double place_um = -180.0 + 360.0 * uniform(bits);
    const double width_um = seed <= 20 ? 20.0 : 15.0 + 10.0 * uniform(bits);
    const double depth_nm = seed <= 20 ? 50.0 : 30.0 + 70.0 * uniform(bits);
    found = machine.corrected(bits, [=](const UnderEdge& at) {
      const double off = (1e3 * at.along_mm - place_um) / (0.5 * width_um);
      return depth_nm * std::max(0.0, 1.0 - off * off);
    });
    ASSERT_EQ(found.marks.size(), 1U) << seed;
    const FacetMark& mark = found.marks.front();
    EXPECT_TRUE(mark.is_along_cut) << seed;
    EXPECT_TRUE(mark.is_of_edge) << seed;
    EXPECT_NEAR(mark.position_um, place_um, 10.0) << seed;
    EXPECT_NEAR(mark.height_nm, depth_nm, 0.25 * depth_nm) << seed;
    // If the part is displaced, the map may not contain the ends of some facets.
    EXPECT_EQ(mark.facets.size(), mark.facets_covering) << seed;
    EXPECT_GE(mark.facets_covering, 6U) << seed;
    EXPECT_TRUE(found.waves.empty()) << seed;
  };
  expect_hidden_values_found(simulate);
}

/// A scratch on a single facet must not be attributed to the edge.
TEST(FacetMarks, AScratchOfOneFacetIsNotTheEdges) {
  std::mt19937 bits(3);
  const HiddenMachine machine(bits);
  const auto groove = std::get<PrismGroove>(designed_cavities(four_prisms().job).front());
  class Scratched {
   public:
    Scratched(const CutSurface& cut, const PrismGroove& groove) : cut_(cut), groove_(groove) {}
    double z(double x, double y) const {
      const double plain = cut_.z(x, y);
      const Vec3 p(x, y, plain);
      const bool is_there = plain < 0.0 && std::abs(groove_.along_mm(p) - 0.1) < 0.008 &&
                            groove_.facets[0].up_slope.dot(p - groove_.root_mm) > 0.0 &&
                            std::abs(y - groove_.root_mm.y()) < groove_.half_base_mm && y > groove_.root_mm.y();
      return is_there ? plain - 8e-5 : plain;
    }

   private:
    const CutSurface& cut_;
    const PrismGroove& groove_;
  };
  const Correction found = correct(four_prisms(), {seen(Scratched(machine.cut, groove), bits)});
  ASSERT_EQ(found.marks.size(), 1U);
  EXPECT_FALSE(found.marks.front().is_of_edge);
  EXPECT_LT(found.marks.front().height_nm, 0.0);
  ASSERT_EQ(found.marks.front().facets.size(), 1U);
  EXPECT_EQ(found.marks.front().facets.front(), (FacetId{0, 0}));
  EXPECT_NEAR(std::abs(found.marks.front().position_um), 100.0, 10.0);
  EXPECT_EQ(found.marks.front().facets_covering, 8U);
}

}  // namespace
}  // namespace retrace::studies::facet_marks_test
