// Polarised light in all engines: an independent engine with field vectors, Jones matrices of a cube corner, symmetry.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "raytrace/beam_tracer.h"
#include "raytrace/monte_carlo.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/statistics.h"

namespace retrace::testing {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kCone = 8.0;

Illumination polarised(double incidence_deg, double azimuth_deg, const Stokes& stokes) {
  Illumination illumination = from(incidence_deg, azimuth_deg);
  illumination.stokes = stokes;
  return illumination;
}

Stokes linear(double angle_deg) {
  return {1.0, std::cos(2.0 * angle_deg * kDeg), std::sin(2.0 * angle_deg * kDeg), 0.0};
}

BeamPolicy leaving(double truncated) {
  BeamPolicy policy;
  policy.truncated_goal = truncated;
  return policy;
}

struct Case {
  std::string name;
  PartSpec spec;
  double incidence_deg;
  double azimuth_deg;
};

std::vector<Case> cases() {
  return {{"prism across", single(RtpElement{0.5, 0.4, 90.0}, 0.3), 38.0, 0.0},
          {"prism askew", single(RtpElement{0.5, 0.4, 84.0}, 0.3), 33.0, 25.0},
          {"hexagon", single(HexagonalCube{1.0}, 0.4), 24.0, 70.0},
          {"triangle", single(TriangularCube{1.0}, 0.4), 9.0, 200.0}};
}

// Both engines against one that carries complex field vectors in space, for every kind of light.
TEST(Polarisation, AllEnginesAgree) {
  const std::vector<Stokes> lights = {kUnpolarised,  linear(0.0),          linear(45.0),
                                      linear(110.0), {1.0, 0.0, 0.0, 1.0}, {1.0, 0.3, -0.5, -0.4}};
  const double z = student_bound(cases().size() * lights.size() * 4);
  for (const Case& c : cases()) {
    const Part part = build_part(c.spec);
    for (const Stokes& light : lights) {
      SCOPED_TRACE(c.name + ", " + std::to_string(light.q) + " " + std::to_string(light.u) + " " +
                   std::to_string(light.v));
      const Illumination illumination = polarised(c.incidence_deg, c.azimuth_deg, light);
      const ReferenceResult reference = reference_trace(part, pmma(), illumination, kCone, 8192, 5);
      const BeamResult exact = BeamTracer(part).trace(pmma(), illumination, {kCone}, leaving(1e-5));
      const ConeResult sampled = MonteCarlo(part).trace(pmma(), illumination, {kCone}, rays(1U << 16), {}).cones[0];
      const double slack = reference.mean[Account::truncated] + 2e-5;
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(exact.stokes[0].values()[k], reference.stokes[k], z * reference.stokes_error[k] + slack) << k;
        EXPECT_NEAR(exact.stokes[0].values()[k], sampled.stokes.values()[k], 1e-3) << k;
      }
      EXPECT_NEAR(exact.stokes[0].i, exact.ledgers[0][Account::retroreflected], 1e-12);
    }
  }
}

// Everything is linear in the Stokes parameters: unpolarised light is the mean of any two orthogonal ones.
TEST(Polarisation, UnpolarisedIsTheMeanOfOrthogonalStates) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.5));
  BeamPolicy policy;
  policy.cutoff = 1e-11;
  Optics optics = pmma();
  optics.absorption_per_mm = 0.5;  // ends deep beams early
  const BeamTracer tracer(part);
  const auto rre = [&](const Stokes& light) {
    return tracer.trace(optics, polarised(31.0, 17.0, light), {0.5}, policy).ledgers[0][Account::retroreflected];
  };
  const double unpolarised = rre(kUnpolarised);
  EXPECT_NEAR(0.5 * (rre(linear(20.0)) + rre(linear(110.0))), unpolarised, 1e-10);
  EXPECT_NEAR(0.5 * (rre({1.0, 0.0, 0.0, 1.0}) + rre({1.0, 0.0, 0.0, -1.0})), unpolarised, 1e-10);
  EXPECT_GT(std::abs(rre(linear(0.0)) - rre(linear(90.0))), 1e-3 * unpolarised);
}

// Averaging the reflectances of s and p at every interface is not what light does: at 75 degrees, askew, a prism sends
// back 7 % less than that would say, and the engine tells the difference.
TEST(Polarisation, ScalarAveragingIsWrong) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  const Illumination askew = from(75.0, 45.0);
  constexpr std::uint64_t kRays = 100000;
  const ReferenceResult kept = reference_trace(part, pmma(), askew, 89.0, kRays, 3);
  const ReferenceResult averaged = reference_trace(part, pmma(), askew, 89.0, kRays, 3, Polarisation::averaged);
  const Ledger exact = BeamTracer(part).trace(pmma(), askew, {89.0}, leaving(1e-6)).ledgers[0];
  const auto retro = static_cast<std::size_t>(Account::retroreflected);
  const double z = student_bound(2);
  EXPECT_NEAR(exact.power[retro], kept.mean.power[retro], z * kept.std_error[retro] + 2e-5);
  EXPECT_GT(averaged.mean.power[retro] - exact.power[retro], z * averaged.std_error[retro] + 2e-5);
}

}  // namespace
}  // namespace retrace::testing
