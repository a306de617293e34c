// Tests of diffraction against the patterns of a disc (Airy) and of a rectangle, direct quadrature, and a pixel model
// of a cube corner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/random.h"
#include "raytrace/observers/aperture_field.h"
#include "raytrace/observers/disc_means.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/pixel_cube.h"

namespace retrace::testing::diffraction_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using Complex = std::complex<double>;

Polygon regular(std::size_t corners, double radius_mm, const Vec2& centre = Vec2::Zero()) {
  Polygon polygon;
  for (std::size_t k = 0; k < corners; ++k) {
    const double a = 2.0 * pi * static_cast<double>(k) / static_cast<double>(corners);
    polygon.push_back(centre + radius_mm * Vec2(std::cos(a), std::sin(a)));
  }
  return polygon;
}

/// Returns the far field of a plane wave that leaves through a polygon. By default, the wave returns along the normal.
FarField field_of(const Polygon& polygon, double wavelength_nm, const Vec3& direction = Vec3::UnitZ(),
                  FarFieldPolicy policy = {}) {
  const Part part = build_part(single(HexagonalCube{1.0}, 1.0));
  policy.wavelength_nm = wavelength_nm;
  policy.window_rad = 0.5;
  FarFieldCollector collector(part, {}, policy);
  ReturnedBeam beam;
  beam.direction = direction;
  beam.stokes.i = 1.0;
  beam.transmission = 1.0;
  beam.exit_polygon_mm = polygon;
  beam.entry_polygon_mm = polygon;
  beam.trail.first = CellInstance{};
  collector.add(beam);
  return collector.finish();
}

Vec3 tilted(double x, double y = 0.0) {
  return {x, y, std::sqrt(1.0 - x * x - y * y)};
}

// Returns the integral of exp(-i kappa . r) over a polygon. It is computed with Gauss rules over triangles, which are
// accurate for smooth functions.
Complex quadrature(const Polygon& polygon, const Vec2& kappa) {
  const GaussRule rule = gauss_legendre(24);
  Complex sum = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k - 1] - polygon[0];
    const Vec2 b = polygon[k] - polygon[0];
    const double twice = a.x() * b.y() - a.y() * b.x();
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
        const double u = rule.nodes[i];
        const Vec2 p = polygon[0] + u * ((1.0 - rule.nodes[j]) * a + rule.nodes[j] * b);
        const double phase = kappa.dot(p);
        sum += rule.weights[i] * rule.weights[j] * u * twice * Complex(std::cos(phase), -std::sin(phase));
      }
  }
  return sum;
}

TEST(PolygonTransform, AgreesWithQuadrature) {
  for (std::uint32_t k = 0; k < 200; ++k) {
    const auto u = [k](std::uint32_t which) { return unit_interval(philox({3, which}, k, 0)[0]); };
    Polygon polygon;
    double angle = 0.0;
    while ((angle += 0.2 + 1.6 * u(static_cast<std::uint32_t>(polygon.size()))) < 2.0 * pi)
      polygon.push_back(Vec2(3.0 * u(90), -2.0) + Vec2(std::cos(angle), 0.6 * std::sin(angle)));
    if (polygon.size() < 3) continue;
    const double scale = std::pow(10.0, 4.5 * u(91) - 3.0);
    const Vec2 kappa = scale * Vec2(std::cos(7.0 * u(92)), std::sin(7.0 * u(92)));
    const Complex expected = quadrature(polygon, kappa);
    EXPECT_NEAR(std::abs(PolygonTransform(polygon).at(kappa) - expected), 0.0, 1e-11) << k << " " << scale;
  }
}

TEST(PolygonTransform, IsSmoothWhereItsSeriesBegins) {
  const PolygonTransform hexagon(regular(6, 1.0, {0.3, -0.2}));
  for (const double direction : {0.0, pi / 6.0, pi / 2.0, 1.0})
    for (const double k : {1e-7, 0.99e-5, 1.01e-5, 0.99e-3, 1.01e-3}) {
      const Vec2 kappa = k * Vec2(std::cos(direction), std::sin(direction));
      EXPECT_NEAR(std::abs(hexagon.at(kappa) - quadrature(hexagon.polygon(), kappa)), 0.0, 3e-10);
    }
  EXPECT_EQ(hexagon.at(Vec2::Zero()), Complex(hexagon.area_mm2()));
}

/// Fields that are computed in SIMD lanes equal single transforms, from the center of the pattern to far outside. If
/// two groups share a polygon, its transform is computed only one time, whichever corner its list starts with.
TEST(ApertureField, AgreesWithSingleTransforms) {
  constexpr double kWavelength_mm = 550e-6;
  JonesMatrix amplitude;
  amplitude << Complex(0.3, 0.1), Complex(-0.2, 0.4), Complex(0.0, 0.7), Complex(0.5, -0.6);
  Polygon hexagon = regular(6, 1.0, {0.3, -0.2});
  std::vector<CoherentGroup> groups(2);
  groups[0].polygons.push_back({PolygonTransform(hexagon), {0.1, 0.02}, amplitude, 1.0, {}});
  std::rotate(hexagon.begin(), hexagon.begin() + 2, hexagon.end());
  groups[1].polygons.push_back({PolygonTransform(hexagon), {0.1, 0.02}, Complex(0.0, 1.0) * amplitude, 1.0, {}});
  groups[1].polygons.push_back({PolygonTransform(regular(4, 0.7, {-2.0, 1.0})), {0.1, 0.0201}, amplitude, 1.0, {}});
  groups[1].polygons.back().mean_factor = 0.8;
  groups[1].copies = 3.0;
  Eigen::Matrix2cd coherency;
  coherency << 0.6, Complex(0.1, -0.2), Complex(0.1, 0.2), 0.4;
  const ApertureField field(groups, kWavelength_mm, coherency, 1e-7);
  std::vector<Vec2> cosines = {{0.1, 0.02}, {0.1, 0.0201}, {7.0, -15.0}};
  for (int k = 0; k < 100; ++k) cosines.push_back({0.1 + 1e-4 * k * std::cos(k), 0.02 + 1e-4 * k * std::sin(k)});
  const Eigen::ArrayXXd found = field.per_cosines(cosines, nullptr);
  for (std::size_t k = 0; k < cosines.size(); ++k) {
    double expected = 0.0;
    for (const CoherentGroup& group : groups) {
      JonesMatrix sum = JonesMatrix::Zero();
      for (const FieldPolygon& p : group.polygons)
        sum += p.mean_factor * p.transform.at(2.0 * pi / kWavelength_mm * (cosines[k] - p.cosines)) * p.amplitude;
      expected += group.copies * (sum * coherency * sum.adjoint()).trace().real();
    }
    EXPECT_NEAR(found(static_cast<Eigen::Index>(k), 0) * kWavelength_mm * kWavelength_mm, expected,
                1e-9 * (expected + 1e-3))
        << k;
  }
}

// For a disc of 1 mm at 550 nm, the first dark ring is at 1.2197 wavelengths over the diameter (the first zero of J1
// divided by pi). The peak is area / wavelength^2.
TEST(Diffraction, FirstNullOfADiscIsThatOfAiry) {
  constexpr double kWave = 550e-6;
  const FarField field = field_of(regular(2000, 0.5), 550.0);
  double angle = 1.0 * kWave;
  double least = field.diffracted_per_sr(tilted(angle));
  for (double s = 1.0; s < 1.4; s += 1e-4) {
    const double here = field.diffracted_per_sr(tilted(s * kWave));
    if (here < least) {
      least = here;
      angle = s * kWave;
    }
  }
  const double peak = field.diffracted_per_sr(Vec3::UnitZ());
  EXPECT_NEAR(angle / kWave, 1.21967, 2e-4);
  EXPECT_LT(least, 1e-8 * peak);
  EXPECT_NEAR(peak, 0.25 * pi / (kWave * kWave), 1e-5 * peak);
  // The pattern is [2 J1(x) / x]^2.
  for (const double s : {0.3, 0.8, 1.6, 2.7}) {
    const double x = pi * s;
    const double airy = std::pow(2.0 * std::cyl_bessel_j(1.0, x) / x, 2.0);
    EXPECT_NEAR(field.diffracted_per_sr(tilted(s * kWave)) / peak, airy, 1e-5);
  }
}

TEST(Diffraction, SquareApertureIsSincSquared) {
  constexpr double kWave = 587.56e-6;
  const Polygon square = {{0.0, 0.0}, {0.7, 0.0}, {0.7, 0.4}, {0.0, 0.4}};
  const FarField field = field_of(square, 587.56);
  const auto sinc2 = [](double x) { return x == 0.0 ? 1.0 : std::pow(std::sin(x) / x, 2.0); };
  const double peak = 0.28 / (kWave * kWave);
  for (const double x : {0.0, 3e-4, 1.1e-3, 4e-3})
    for (const double y : {0.0, 5e-4, 2e-3}) {
      const Vec3 d = tilted(x, y);
      const double expected = d.z() * peak * sinc2(pi * 0.7 * x / kWave) * sinc2(pi * 0.4 * y / kWave);
      EXPECT_NEAR(field.diffracted_per_sr(d), expected, 1e-10 * peak);
    }
}

// As a function of the direction cosines, the pattern is the same at oblique incidence. The intensity per steradian is
// therefore proportional to the cosine of the direction.
TEST(Diffraction, ObliquePatternIsOneOverTheCosines) {
  const Polygon hexagon = regular(6, 0.5);
  const Vec3 oblique = tilted(0.05, 0.02);
  const FarField straight = field_of(hexagon, 550.0);
  const FarField turned = field_of(hexagon, 550.0, oblique);
  for (const double x : {0.0, 4e-4, 1.5e-3}) {
    const Vec3 a = tilted(x, 0.3e-3);
    const Vec3 b = tilted(0.05 + x, 0.02 + 0.3e-3);
    EXPECT_NEAR(turned.diffracted_per_sr(b) / b.z(), straight.diffracted_per_sr(a) / a.z(),
                1e-9 * straight.diffracted_per_sr(a) + 1e-3);
  }
}

// The power within the window and the power outside the window are integrated separately: the former on a lattice, the
// latter over the tails.
TEST(Diffraction, WindowAndOutsideAddUpToThePower) {
  for (const double size : {0.05, 0.2, 1.0})
    for (const Polygon& shape : {regular(6, 0.5 * size), regular(3, 0.5 * size), regular(400, 0.5 * size)}) {
      const FarField field = field_of(shape, 550.0);
      const FarField::Split split = field.split(ReturnFrame{}, 0.035);
      EXPECT_NEAR(split.inside + split.outside, 1.0, 1e-3) << size << " " << shape.size();
      EXPECT_GT(split.outside, 1e-4);
    }
}

/// Returns the far field of the light that the entrance face reflects, without the light that facets reflect.
FarField front_of(const Part& part, const Optics& optics, const Illumination& light) {
  FarFieldPolicy policy;
  policy.wavelength_nm = 550.0;
  policy.window_rad = 0.5;
  FarFieldCollector collector(part, light, policy);
  BeamPolicy beams;
  beams.cutoff = 1e-2;
  BeamTracer(part).trace(optics, light, {0.5}, beams, nullptr, [&](const ReturnedBeam& beam) {
    if (beam.depth == 0) collector.add(beam);
  });
  return collector.finish();
}

// A weak beam is diffracted like a strong one if there are few beams. An undiffracted beam would have an infinite
// intensity in its direction.
TEST(Diffraction, WeakBeamsAreDiffractedIfTheyAreFew) {
  constexpr double kWave_mm = 550e-6;
  constexpr double kWeak = 1e-6;
  const Part part = build_part(single(HexagonalCube{1.0}, 1.0));
  FarFieldPolicy policy;
  policy.wavelength_nm = 1e6 * kWave_mm;
  FarFieldCollector collector(part, {}, policy);
  const std::array<Vec3, 2> directions = {Vec3::UnitZ(), tilted(0.01)};
  for (std::size_t k = 0; k < directions.size(); ++k) {
    ReturnedBeam beam;
    beam.direction = directions[k];
    beam.stokes.i = k == 0 ? 1.0 : kWeak;
    beam.transmission = beam.stokes.i;
    beam.exit_polygon_mm = beam.entry_polygon_mm = regular(64, 0.2);
    beam.trail.first = CellInstance{static_cast<std::uint32_t>(k)};
    collector.add(beam);
  }
  const FarField field = collector.finish();
  EXPECT_TRUE(field.rays().empty());
  EXPECT_NEAR(field.total_power(), 1.0 + kWeak, 1e-12);
}

// The entrance face of a finite part diffracts like an aperture. For unit incident power, the intensity in the
// direction of the reflection is R A cos(theta) / w^2. R is the reflectance, A the area, theta the angle of incidence
// and w the wavelength. For a rectangle, the intensity falls like sinc^2 in a plane parallel to a side. The total power
// of the pattern is R.
TEST(Diffraction, EntranceFaceOfAFinitePartIsAnAperture) {
  constexpr double kWave = 550e-6;
  const double base = 0.3;
  const PartSpec prism = single(RtpElement{base, 0.2, 90.0}, 0.5);
  for (const PartSpec& spec : {prism, single(HexagonalCube{0.4}, 0.5), single(TriangularCube{0.5}, 0.5),
                               finite(RtpElement{0.1, 0.1, 90.0}, Arrangement::aligned, 0.3, 0.2, 0.5)})
    for (const double incidence_deg : {0.0, 2.0}) {
      const Part part = build_part(spec);
      const Illumination light = from(incidence_deg, 30.0);
      const FarField field = front_of(part, pmma(), light);
      Vec3 reflected = direction_to_source(light);
      reflected.head<2>() *= -1.0;
      const double power = field.total_power();
      EXPECT_NEAR(power, std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0), 1e-5);
      const double peak = power * part.entrance_area_mm2 * reflected.z() / (kWave * kWave);
      EXPECT_NEAR(field.diffracted_per_sr(reflected), peak, 1e-9 * peak);
      const FarField::Split split = field.split(ReturnFrame{}, 0.2);
      EXPECT_NEAR(split.inside + split.outside, power, 1e-3 * power);
    }
  const FarField field = front_of(build_part(prism), pmma(), from(0.0));
  const double peak = field.diffracted_per_sr(Vec3::UnitZ());
  for (const double phase : {0.4, 1.0, 1.5, 2.0}) {
    const double x = phase * kWave / base;
    const double sinc = std::sin(pi * phase) / (pi * phase);
    EXPECT_NEAR(field.diffracted_per_sr(tilted(x)) / tilted(x).z(), peak * sinc * sinc, 1e-9 * peak) << phase;
  }
}

// A full cube corner returns six sub-beams. They are tested for mirrors and for total reflection, whose phases split
// the pattern.
TEST(Diffraction, SixSectorsOfACubeCornerAgreeWithAPixelModel) {
  constexpr double kAperture = 0.5;
  const Part part = build_part(single(HexagonalCube{kAperture}, 0.3));
  for (const bool mirrors : {true, false}) {
    Optics optics = pmma();
    optics.mirror_facets = mirrors;
    optics.lossless_entrance = true;
    FarFieldPolicy policy;
    policy.wavelength_nm = 550.0;
    FarFieldCollector collector(part, {}, policy);
    BeamPolicy beams;
    beams.truncated_goal = 1e-6;
    beams.separate_cells = true;
    BeamTracer(part).trace(optics, {}, {0.5}, beams, nullptr, [&](const ReturnedBeam& b) { collector.add(b); });
    const FarField field = collector.finish();
    ASSERT_EQ(field.groups().size(), 1U);
    // With mirrors all six beams have the same field. The polygons of neighbouring beams are therefore joined.
    if (mirrors) {
      EXPECT_LT(field.groups()[0].polygons.size(), 6U);
    } else {
      EXPECT_EQ(field.groups()[0].polygons.size(), 6U);
    }

    constexpr double kWave = 550e-6;
    const PixelCube cube({.aperture_mm = kAperture, .wavelength_mm = kWave, .mirrors = mirrors});
    EXPECT_NEAR(cube.area_mm2(), area(part.outline), 2e-3 * area(part.outline));
    const double peak = cube.area_mm2() / (kWave * kWave);
    double most = 0.0;
    for (const double radius : {0.0, 0.5, 1.0, 1.5, 2.2})
      for (const double turn : {0.0, 30.0, 75.0, 140.0, 222.0, 300.0}) {
        const Vec2 q = radius * kWave / kAperture * Vec2(std::cos(turn * kDeg), std::sin(turn * kDeg));
        const double found = field.diffracted_per_sr(tilted(q.x(), q.y())) / peak;
        EXPECT_NEAR(found, cube.at(q), 3e-3) << radius << " " << turn << " " << mirrors;
        most = std::max(most, found);
      }
    // With total reflection, there is little light at the center of the pattern.
    EXPECT_GT(most, mirrors ? 0.99 : 0.2);
    EXPECT_LT(field.diffracted_per_sr(Vec3::UnitZ()) / peak, mirrors ? 1.01 : 0.5);
  }
}

// Sums over many polygons take long. They must stop when the computation is cancelled, before or after the field is
// complete.
TEST(FarField, IsNotSummedOnceItIsCancelled) {
  Cancellation cancellation;
  FarFieldPolicy policy;
  policy.cancel = &cancellation;
  const FarField field = field_of(regular(6, 0.5), 550.0, Vec3::UnitZ(), policy);
  EXPECT_GT(field.diffracted_per_sr(Vec3::UnitZ()), 0.0);
  cancellation.request();
  EXPECT_EQ(field.diffracted_per_sr(Vec3::UnitZ()), 0.0);
  EXPECT_TRUE(field_of(regular(6, 0.5), 550.0, Vec3::UnitZ(), policy).groups().empty());
}

// At most FarFieldPolicy::max_polygons polygons are diffracted. The power of all other polygons is reported.
TEST(FarField, TellsWhatTheBudgetOfPolygonsLeavesUndiffracted) {
  FarFieldPolicy policy;
  EXPECT_EQ(field_of(regular(6, 0.5), 550.0, Vec3::UnitZ(), policy).beyond_budget_power(), 0.0);
  policy.max_polygons = 0;
  const FarField field = field_of(regular(6, 0.5), 550.0, Vec3::UnitZ(), policy);
  EXPECT_TRUE(field.groups().empty());
  EXPECT_NEAR(field.beyond_budget_power(), 1.0, 1e-12);
  // If the patterns are narrower than the finest detail that is computed, diffraction is not necessary, and no power is
  // reported.
  policy.finest_detail_rad = 1.0;
  EXPECT_EQ(field_of(regular(6, 0.5), 550.0, Vec3::UnitZ(), policy).beyond_budget_power(), 0.0);
}

/// Returns the mean of a far field over the kernel. The reference uses Gauss quadrature along radii, separately on both
/// sides of the kernel's kink, with enough points to resolve the field.
double mean_over(const FarField& field, const Vec3& direction, const ApertureKernel& kernel, double kink_rad) {
  constexpr int kRound = 300;
  const GaussRule rule = gauss_legendre(80);
  const Vec3 right = direction.cross(Vec3::UnitY()).normalized();
  const Vec3 up = direction.cross(right);
  std::vector<Vec3> directions;
  std::vector<double> weights;
  for (const auto& [from, to] : {std::pair{0.0, kink_rad}, std::pair{kink_rad, kernel.reach_rad()}})
    for (std::size_t node = 0; node < rule.nodes.size(); ++node) {
      const double r = std::lerp(from, to, rule.nodes[node]);
      for (int k = 0; k < kRound; ++k) {
        const double a = 2.0 * pi * (k + 0.5) / kRound;
        directions.push_back(std::cos(r) * direction + std::sin(r) * (std::cos(a) * right + std::sin(a) * up));
        weights.push_back(rule.weights[node] * (to - from) * std::sin(r) * kernel.per_sr(r) * 2.0 * pi / kRound);
      }
    }
  const std::vector<double> values = field.diffracted_per_sr(directions);
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += weights[k] * values[k];
  return sum;
}

/// Compares means over the discs of source and receiver with quadrature. The details of the diffraction patterns are
/// wider than the discs, as wide as the discs, or much narrower. Light leaves along the normal or obliquely.
TEST(DiscMeans, AreMeansOverTheDiscs) {
  for (const double discs_arcmin : {3.0, 10.0})
    for (const double radius_mm : {0.1, 0.4, 1.5})
      for (const double slant : {0.0, 0.3}) {
        const FarField first = field_of(regular(6, radius_mm), 550.0, tilted(slant, 0.1 * slant));
        const FarField second = field_of(regular(3, radius_mm), 610.0, tilted(slant + 1e-3, 0.1 * slant));
        const ApertureKernel kernel({Angle::from_deg(discs_arcmin / 60.0), Angle::from_deg(0.5 * discs_arcmin / 60.0)});
        const double kink_rad = 0.25 * Angle::from_deg(discs_arcmin / 60.0).rad();
        const std::vector<BandedField> fields = {{&first, {1.0, 0.5, 0.0}}, {&second, {0.0, 2.0, 3.0}}};
        const CosineSquare square{Vec2(slant, 0.1 * slant), 0.006, 9};
        const auto means = disc_means(fields, square, kernel, nullptr);
        ASSERT_EQ(means.size(), 81U);
        std::array<double, 3> greatest{};
        for (const auto& mean : means)
          for (std::size_t band = 0; band < 3; ++band) greatest[band] = std::max(greatest[band], mean[band]);
        for (const std::size_t k : {40U, 41U, 31U, 50U, 22U, 77U}) {
          const Vec2 at = square.at(k);
          const double one = mean_over(first, tilted(at.x(), at.y()), kernel, kink_rad);
          const double other = mean_over(second, tilted(at.x(), at.y()), kernel, kink_rad);
          EXPECT_NEAR(means[k][0], one, 2e-4 * greatest[0]) << radius_mm << ' ' << slant << ' ' << k;
          EXPECT_NEAR(means[k][1], 0.5 * one + 2.0 * other, 2e-4 * greatest[1])
              << radius_mm << ' ' << slant << ' ' << k;
          EXPECT_NEAR(means[k][2], 3.0 * other, 2e-4 * greatest[2]) << radius_mm << ' ' << slant << ' ' << k;
        }
      }
}

/// The mean of a single ray is the kernel around the direction of the ray. Below the horizon, the mean is 0.
TEST(DiscMeans, OfRaysAreTheKernel) {
  FarFieldPolicy policy;
  policy.diffraction = false;
  const FarField field = field_of(regular(6, 5.0), 550.0, tilted(0.99), policy);
  const ApertureKernel kernel({Angle::from_deg(1.0), Angle::from_deg(1.0)});
  const CosineSquare square{Vec2(0.99, 0.0), 0.02, 41};
  const std::vector<BandedField> fields = {{&field, {1.0, 1.0, 1.0}}};
  const auto means = disc_means(fields, square, kernel, nullptr);
  for (std::size_t k = 0; k < means.size(); ++k) {
    const Vec2 at = square.at(k);
    const bool is_above = at.squaredNorm() < 1.0;
    const double expected =
        is_above ? kernel.per_sr(std::acos(std::min(1.0, tilted(at.x(), at.y()).dot(tilted(0.99))))) : 0.0;
    EXPECT_NEAR(means[k][0], expected, 1e-5 * kernel.per_sr(0.0)) << k;
  }
}

}  // namespace
}  // namespace retrace::testing::diffraction_test
