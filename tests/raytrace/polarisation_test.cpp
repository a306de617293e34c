// Tests of polarised light in all engines. The results are compared with an independent engine that uses field vectors,
// and with Jones matrices of a cube corner. Symmetries are also tested.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::polarisation_test {
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

using Case = TraceCase;

/// Returns optics with transparent layers that change the phases of total reflection, and with a metal film on the
/// entrance face.
Optics layered() {
  Optics optics = pmma();
  optics.facet_layers = {{{1.9, 0.11}, {1.3777, 0.2}}};
  optics.entrance_layers = thin_aluminium();
  return optics;
}

std::vector<Case> cases() {
  return {{"hexagon with layers", single(HexagonalCube{1.0}, 0.4), 14.0, 70.0, layered()},
          {"prism with layers", single(RtpElement{0.5, 0.4, 90.0}, 0.3), 38.0, 20.0, layered()},
          {"prism across", single(RtpElement{0.5, 0.4, 90.0}, 0.3), 38.0, 0.0},
          {"prism askew", single(RtpElement{0.5, 0.4, 84.0}, 0.3), 33.0, 25.0},
          {"hexagon", single(HexagonalCube{1.0}, 0.4), 24.0, 70.0},
          {"triangle", single(TriangularCube{1.0}, 0.4), 9.0, 200.0}};
}

// For every kind of light, the exact engine and Monte Carlo are compared with a reference engine that uses complex
// field vectors in space.
TEST(Polarisation, AllEnginesAgree) {
  // All results are linear in the Stokes parameters, so that the first four kinds of light determine those of the
  // others.
  std::vector<Stokes> lights = {kUnpolarised, linear(0.0), linear(45.0), {1.0, 0.0, 0.0, 1.0}};
  if (test::is_long_run()) lights.insert(lights.end(), {linear(110.0), {1.0, 0.3, -0.5, -0.4}});
  const double z = student_bound(cases().size() * lights.size() * 4);
  for (const Case& c : cases()) {
    const Part part = build_part(c.spec);
    for (const Stokes& light : lights) {
      SCOPED_TRACE(c.name + ", " + std::to_string(light.q) + " " + std::to_string(light.u) + " " +
                   std::to_string(light.v));
      const Illumination illumination = polarised(c.incidence_deg, c.azimuth_deg, light);
      const ReferenceResult reference =
          reference_trace(part, c.optics, illumination, kCone, test::sample_size<std::uint64_t>(2048, 8192), 5);
      const BeamResult exact = BeamTracer(part).trace(c.optics, illumination, {kCone}, leaving(1e-5));
      const ConeResult sampled = MonteCarlo(part).trace(c.optics, illumination, {kCone}, rays(1U << 16), {}).cones[0];
      const double slack = reference.mean[Account::truncated] + 2e-5;
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(exact.stokes[0].values()[k], reference.stokes[k], z * reference.stokes_error[k] + slack) << k;
        EXPECT_NEAR(exact.stokes[0].values()[k], sampled.stokes.values()[k], 1e-3) << k;
      }
      EXPECT_NEAR(exact.stokes[0].i, exact.ledgers[0][Account::retroreflected], 1e-12);
    }
  }
}

// All results are linear in the Stokes parameters. Unpolarised light is the mean of any two orthogonal states.
TEST(Polarisation, UnpolarisedIsTheMeanOfOrthogonalStates) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.5));
  BeamPolicy policy;
  policy.cutoff = 1e-11;
  Optics optics = pmma();
  optics.absorption_per_mm = 0.5;  // weakens beams with many reflections
  const BeamTracer tracer(part);
  const auto rre = [&](const Stokes& light) {
    return tracer.trace(optics, polarised(31.0, 17.0, light), {0.5}, policy).ledgers[0][Account::retroreflected];
  };
  const double unpolarised = rre(kUnpolarised);
  EXPECT_NEAR(0.5 * (rre(linear(20.0)) + rre(linear(110.0))), unpolarised, 1e-10);
  EXPECT_NEAR(0.5 * (rre({1.0, 0.0, 0.0, 1.0}) + rre({1.0, 0.0, 0.0, -1.0})), unpolarised, 1e-10);
  EXPECT_GT(std::abs(rre(linear(0.0)) - rre(linear(90.0))), 1e-3 * unpolarised);
}

// Averaging the reflectances of s and p at every interface is not correct. At an oblique incidence of 75 degrees, the
// RRE of a prism is 7 % smaller than with this average, and the engine shows this difference.
TEST(Polarisation, ScalarAveragingIsWrong) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  const Illumination askew = from(75.0, 45.0);
  const auto count = test::sample_size<std::uint64_t>(25000, 100000);
  const ReferenceResult kept = reference_trace(part, pmma(), askew, 89.0, count, 3);
  const ReferenceResult averaged = reference_trace(part, pmma(), askew, 89.0, count, 3, Polarisation::averaged);
  const Ledger exact = BeamTracer(part).trace(pmma(), askew, {89.0}, leaving(1e-6)).ledgers[0];
  const auto retro = static_cast<std::size_t>(Account::retroreflected);
  const double z = student_bound(2);
  EXPECT_NEAR(exact.power[retro], kept.mean.power[retro], z * kept.std_error[retro] + 2e-5);
  EXPECT_GT(averaged.mean.power[retro] - exact.power[retro], z * averaged.std_error[retro] + 2e-5);
}

using Jones = Eigen::Matrix2cd;

/// Returns the matrix from the amplitudes of s and p to the amplitudes along the axes of the source.
Eigen::Matrix2d to_axes(const Vec3& direction, const Vec3& s_axis) {
  const Vec3 first = source_axis(Vec3::UnitZ());
  const Vec3 second = Vec3::UnitZ().cross(first);
  const Vec3 p_axis = direction.cross(s_axis);
  Eigen::Matrix2d turn;
  turn << first.dot(s_axis), first.dot(p_axis), second.dot(s_axis), second.dot(p_axis);
  return turn;
}

constexpr double kSin2AtFacets = 2.0 / 3.0;

/// Returns the phase difference arg r_s - arg r_p of a facet of a cube corner without layers.
double retardance_of_bare_facet() {
  return 2.0 * std::atan(std::sqrt((1.0 - kSin2AtFacets) * (kSin2AtFacets - 1.0 / (kPmma * kPmma))) / kSin2AtFacets);
}

/// Returns the phase difference of a facet with one layer, by Airy's formula.
double retardance_behind(const materials::ThinLayer& layer) {
  const auto w = [](std::complex<double> n) { return std::sqrt(n * n - kPmma * kPmma * kSin2AtFacets); };
  const auto reflection = [&](std::complex<double> a, std::complex<double> b, std::complex<double> c) {
    const std::complex<double> turn =
        std::exp(std::complex<double>(0.0, 4.0 * std::numbers::pi * layer.thickness) * w(layer.index));
    const std::complex<double> front = (a - b) / (a + b);
    const std::complex<double> back = (b - c) / (b + c);
    return (front + back * turn) / (1.0 + front * back * turn);
  };
  const std::complex<double> n1 = layer.index;
  return std::arg(reflection(w(kPmma), w(n1), w(1.0)) /
                  reflection(w(kPmma) / (kPmma * kPmma), w(n1) / (n1 * n1), w(1.0)));
}

/// Returns the Jones matrix of three total reflections at facets with the inward normals n[0], n[1] and n[2]
/// (docs/theory). It is a retarder a0 + i (a3 sigma3 + a1 sigma1), from s and p of the first reflection to s and p of
/// the last reflection.
Jones three_reflections(const std::array<Vec3, 3>& n, double retardance) {
  const double c = std::cos(0.5 * retardance);
  const double s = std::sin(0.5 * retardance);
  const double hand = n[0].cross(n[1]).dot(n[2]) > 0.0 ? 1.0 : -1.0;
  const std::complex<double> i(0.0, 1.0);
  const double a0 = c * std::cos(retardance) + 0.5 * s * std::sin(retardance);
  const double a3 = c * std::sin(retardance) - 0.5 * s * std::cos(retardance);
  const double a1 = -hand * 0.5 * std::numbers::sqrt3 * s;
  Jones m;
  m << a0 + i * a3, i * a1, i * a1, a0 - i * a3;
  const Vec3 down = -Vec3::UnitZ();
  const Vec3 last = Vec3::UnitZ() - 2.0 * n[2].z() * n[2];  // direction before the last reflection
  const Eigen::Matrix2d in = to_axes(down, down.cross(n[0]).normalized());
  const Eigen::Matrix2d out = to_axes(Vec3::UnitZ(), last.cross(n[2]).normalized());
  return out * m * in.transpose();
}

/// Returns the Stokes parameters of light from the source after an optical system with the given Jones matrix.
std::array<double, 4> after(const Jones& jones, const Stokes& light) {
  const std::complex<double> i(0.0, 1.0);
  Jones coherency;  // right-handed light on its way down rotates from the first axis to the second
  coherency << 0.5 * (light.i + light.q), 0.5 * (light.u - i * light.v), 0.5 * (light.u + i * light.v),
      0.5 * (light.i - light.q);
  const Jones out = jones * coherency * jones.adjoint();
  return {(out(0, 0) + out(1, 1)).real(), (out(0, 0) - out(1, 1)).real(), 2.0 * out(0, 1).real(),
          2.0 * out(0, 1).imag()};
}

// Expects that a cube corner returns six sub-beams, one for each order of its three facets (Liu and Azzam, Appl. Opt.
// 36, 1553 (1997); Murphy and Goodrow, Appl. Opt. 52, 117 (2013)).
void expect_six_sub_beams(const Optics& optics, double retardance) {
  const Part part = build_part(single(HexagonalCube{kCubeAperture}, 0.4));
  const Vec2 centre = centroid(part.outline);
  std::array<Vec3, 3> edges;  // directions from the apex
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = 120.0 * static_cast<double>(k) * kDeg;
    edges[k] = Vec3(std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), std::sqrt(1.0 / 3.0));
  }
  for (const Stokes& light : {kUnpolarised, linear(0.0), linear(45.0), linear(77.0), Stokes{1.0, 0.0, 0.0, 1.0}}) {
    std::array<double, 6> share{};
    const auto compare = [&](const ReturnedBeam& beam) {
      const Vec2 at = centroid(beam.entry_polygon_mm) - centre;
      double angle_deg = std::atan2(at.y(), at.x()) / kDeg;
      if (angle_deg < 0.0) angle_deg += 360.0;
      const auto sextant = static_cast<std::size_t>(angle_deg / 60.0);
      share[sextant] += beam.stokes.i;
      // The facet between the edges k and k + 1 is perpendicular to the third edge. The next facet is on the other side
      // of the nearer edge.
      const std::size_t k = sextant / 2;
      const std::size_t first = (k + 2) % 3;
      const std::size_t second = sextant % 2 == 0 ? (k + 1) % 3 : k;
      const Jones jones = three_reflections({edges[first], edges[second], edges[3 - first - second]}, retardance);
      const std::array<double, 4> expected = after(jones, light);
      for (std::size_t s = 0; s < 4; ++s)
        EXPECT_NEAR(beam.stokes.values()[s] / beam.stokes.i, expected[s], 1e-9) << "sextant " << sextant << ", " << s;
    };
    Illumination illumination;
    illumination.stokes = light;
    BeamTracer(part).trace(optics, illumination, {0.5}, {}, nullptr, compare);
    for (const double s : share) EXPECT_NEAR(s, 1.0 / 6.0, 1e-9);
  }
}

TEST(Polarisation, SixSubBeamsOfASolidCubeCorner) {
  Optics optics = pmma();
  optics.lossless_entrance = true;
  expect_six_sub_beams(optics, retardance_of_bare_facet());
}

// With a layer on the facets, total reflection remains total, but its phases change.
TEST(Polarisation, SixSubBeamsBehindALayer) {
  Optics optics = pmma();
  optics.lossless_entrance = true;
  for (const materials::ThinLayer& layer : {materials::ThinLayer{1.3777, 0.18}, {1.1, 0.3}, {2.3, 0.1}}) {
    optics.facet_layers = {{layer}};
    expect_six_sub_beams(optics, retardance_behind(layer));
    EXPECT_GT(std::abs(retardance_behind(layer) - retardance_of_bare_facet()), 0.05);
  }
}

}  // namespace
}  // namespace retrace::testing::polarisation_test
