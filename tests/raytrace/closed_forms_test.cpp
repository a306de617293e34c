// Tests of the tracer against closed forms, which are derived in docs/theory.
#include "tests/support/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "materials/fresnel.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::closed_forms_test {
namespace {

using namespace geometry;
using namespace raytrace;

/// Expects |RRE - expected| <= z * spread + truncated + 1e-9. The spread is the standard deviation of the mean of the
/// replicates, and `truncated` is the truncated power.
void expect_within(const ConeResult& result, double expected, double z, const std::string& what) {
  const double bound = z * result.spread + result.ledger[Account::truncated] + 1e-9;
  EXPECT_LE(std::abs(result.rre - expected), bound)
      << what << ": got " << result.rre << " +- " << result.spread << ", expected " << expected;
}

// The values of Hamilton et al. 2017, Table 1, are printed to 0.01 %. The closed form is f + (1-f) 2R/(1+R), where f is
// the fraction of the area that full elements cover.
TEST(ClosedForms, ArraySizeStudy) {
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  std::ifstream file(std::string(RETRACE_SOURCE_DIR) + "/tests/data/rtp_array_rre.csv");
  ASSERT_TRUE(file) << "tests/data/rtp_array_rre.csv is missing";
  std::string line;
  int rows = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line[0] == 'b') continue;
    std::istringstream cells(line);
    double base = 0, width = 0, full = 0, facets = 0, printed = 0;
    char comma = 0;
    cells >> base >> comma >> width >> comma >> full >> comma >> facets >> comma >> printed;
    ASSERT_FALSE(cells.fail()) << line;
    PartSpec spec = finite(RtpElement{base, width, 90.0}, Arrangement::offset, 10.0, 10.0, 2.0);
    spec.array.shifted_rows = RowParity::odd;
    const Part part = build_part(spec);
    EXPECT_EQ(part.elements_full, static_cast<std::int64_t>(full));
    EXPECT_NEAR(part.retro_facet_area_mm2, facets, 5e-3);
    const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(0.0), {0.5}, rays(1U << 17), {});
    EXPECT_NEAR(100.0 * result.cones[0].rre, printed, 0.05) << "base " << base;
    const double share = full * base * width / 100.0;
    expect_within(result.cones[0], share + (1.0 - share) * 2.0 * fresnel / (1.0 + fresnel), student_bound(5),
                  "base " + std::to_string(base));
    ++rows;
  }
  EXPECT_EQ(rows, 5);
}

TEST(ClosedForms, SinglePrismIsEvenInTheAngle) {
  const Part part = build_part(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  const MonteCarlo tracer(part);
  const std::vector<double> angles = {1, 2, 3, 4, 5, 10, 15, 20, 25, 30, 35, 40};
  const double z = student_bound(angles.size());
  for (const double t : angles) {
    // The seeds differ, so that the two estimates are independent. The bound is a multiple of their spread, and thus
    // valid for any number of rays.
    const std::uint64_t count = test::sample_size(1U << 15, 1U << 17);
    const ConeResult right = tracer.trace(pmma(), from(t), {0.5}, rays(count, 1), {}).cones[0];
    const ConeResult left = tracer.trace(pmma(), from(-t), {0.5}, rays(count, 2), {}).cones[0];
    EXPECT_LE(std::abs(right.rre - left.rre), z * std::hypot(right.spread, left.spread) + 1e-9) << t;
    EXPECT_GT(right.rre, 0.0);
  }
}

// The knee is at the angle of incidence t with sin t = n sin(45 deg - asin(1/n)). At smaller angles both facets reflect
// totally; at larger angles one facet transmits light.
TEST(ClosedForms, KneeOfTotalReflection) {
  const Part part = build_part(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  const MonteCarlo tracer(part);
  const double knee = std::asin(kPmma * std::sin(45.0 * kDeg - std::asin(1.0 / kPmma))) / kDeg;
  EXPECT_NEAR(knee, 4.33, 5e-3);
  for (const double side : {-1.0, 1.0}) {
    const auto transmitted = [&](double t) {
      return tracer.trace(pmma(), from(side * t), {0.5}, rays(1U << 14), {}).cones[0].ledger[Account::transmitted];
    };
    EXPECT_EQ(transmitted(knee - 1e-6), 0.0);
    EXPECT_GT(transmitted(knee + 1e-6), 1e-4);
  }
}

struct Grid {
  std::vector<double> incidence;
  std::vector<double> azimuth;
};

/// Returns a grid of incidence angles and azimuths. A cube corner has a threefold axis, so that azimuths can be reduced
/// to a range of 120 degrees. The grid has a step of 15 degrees in this range and distributes its azimuths over all
/// three thirds.
Grid cube_grid() {
  Grid grid;
  for (double t = 0.0; t <= 60.0; t += 5.0) grid.incidence.push_back(t);
  for (int k = 0; k < 8; ++k) grid.azimuth.push_back(15.0 * k + 120.0 * (k % 3));
  return grid;
}

template <class Expected>
void check_ideal_array(const PartSpec& spec, const Expected& expected) {
  const Part part = build_part(spec);
  const MonteCarlo tracer(part);
  const Grid grid = cube_grid();
  const double z = student_bound(grid.incidence.size() * grid.azimuth.size());
  for (const double t : grid.incidence)
    for (const double p : grid.azimuth) {
      const MonteCarloResult result = tracer.trace(ideal(), from(t, p), {0.01}, rays(1U << 15), {});
      expect_within(result.cones[0], expected(t, p, kPmma), z,
                    "incidence " + std::to_string(t) + " azimuth " + std::to_string(p));
      EXPECT_EQ(result.misses, 0U);
    }
}

TEST(ClosedForms, EffectiveApertureOfAHoneycomb) {
  check_ideal_array(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0), honeycomb_rre);
}

TEST(ClosedForms, EffectiveApertureOfATriangularArray) {
  check_ideal_array(infinite(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0), triangular_rre);
}

// At normal incidence, every path through a right-angled prism has the length 2 thickness + base.
TEST(ClosedForms, AbsorptionFollowsThePathLength) {
  const Part part = build_part(single(RtpElement{0.6, 0.4, 90.0}, 0.7));
  Optics optics = ideal();
  optics.absorption_per_mm = 0.3;
  const MonteCarloResult result = MonteCarlo(part).trace(optics, from(0.0), {0.5}, rays(4096), {});
  EXPECT_NEAR(result.cones[0].rre, std::exp(-0.3 * (2.0 * 0.7 + 0.6)), 1e-12);
  EXPECT_NEAR(result.cones[0].ledger[Account::absorbed], 1.0 - result.cones[0].rre, 1e-12);
}

// In an array of lossless mirrors, all light that enters leaves through the entrance face.
TEST(ClosedForms, ClosedLosslessBoxReturnsEverything) {
  for (const PartSpec& spec : {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0),
                               infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0),
                               infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0)}) {
    const Part part = build_part(spec);
    const MonteCarlo tracer(part);
    for (const double t : {0.0, 13.0, 47.0, 80.0}) {
      const Ledger ledger = tracer.trace(ideal(), from(t, 17.0), {0.5}, rays(1U << 13), {}).cones[0].ledger;
      EXPECT_NEAR(ledger[Account::retroreflected] + ledger[Account::returned_elsewhere], 1.0, 1e-12);
    }
  }
}

// With mirrors behind a real entrance face, all light that enters must finally leave through the entrance face.
TEST(ClosedForms, MirrorsBehindARealFaceReturnEverything) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0));
  Optics optics = pmma();
  optics.mirror_facets = true;
  const Ledger ledger = MonteCarlo(part).trace(optics, from(35.0, 20.0), {0.5}, rays(1U << 14), {}).cones[0].ledger;
  EXPECT_NEAR(ledger[Account::front_specular], materials::reflectance(1.0 / kPmma, std::cos(35.0 * kDeg)), 1e-9);
  EXPECT_NEAR(ledger[Account::retroreflected] + ledger[Account::returned_elsewhere] + ledger[Account::front_specular] +
                  ledger[Account::truncated],
              1.0, 1e-9);
}

// In the plane along its roof edge, a groove of prisms acts like a plane mirror. No light returns at oblique incidence.
TEST(ClosedForms, AlignedGrooveAlongItsRoofIsAMirror) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0));
  const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(36.0, 90.0), {0.5}, rays(1U << 15), {});
  EXPECT_LT(result.cones[0].rre, 1e-9);
}

// The end walls of brick rows form cube corners with the facets. At 36 degrees along the roof edge, the RRE is about
// 0.2.
TEST(ClosedForms, BrickRowsSendLightBackAlongTheRoof) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 1.0));
  const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(36.0, 270.0), {0.5}, rays(1U << 17), {});
  EXPECT_NEAR(result.cones[0].rre, 0.2, 0.02);
}

// A wider cone never contains less light. One run computes all cones.
TEST(ClosedForms, RreAgainstAcceptance) {
  const Part part = build_part(single(HexagonalCube{1.0}, 0.5));
  const MonteCarlo tracer(part);
  const MonteCarloResult all = tracer.trace(pmma(), from(12.0, 40.0), {0.5, 10.0, 30.0, 89.0}, rays(1U << 14), {});
  for (std::size_t k = 1; k < all.cones.size(); ++k) EXPECT_GE(all.cones[k].rre, all.cones[k - 1].rre);
  const MonteCarloResult one = tracer.trace(pmma(), from(12.0, 40.0), {30.0}, rays(1U << 14), {});
  EXPECT_NEAR(one.cones[0].rre, all.cones[2].rre, 1e-12);
}

}  // namespace
}  // namespace retrace::testing::closed_forms_test
