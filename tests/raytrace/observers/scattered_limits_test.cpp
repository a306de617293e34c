// Tests of limits of diffraction with roughness: agreement with rays in wide cones, a closed form for the fringes of
// opposite paths, and no effect of vanishing heights.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/raytrace/observers/phase_screens.h"
#include "tests/support/statistics.h"

namespace retrace::testing::scattered_limits_test {
namespace {

using namespace phase_screens;

struct Element {
  const char* name;
  PartSpec spec;
};
std::array<Element, 2> endless(double size_mm) {
  return {{{"prisms", infinite(RtpElement{size_mm, size_mm, 90.0}, Arrangement::aligned, 0.3)},
           {"cubes", infinite(HexagonalCube{size_mm}, Arrangement::honeycomb, 0.3)}}};
}

// If cones are much wider than the diffraction pattern, the far field agrees with rays that are scattered randomly at
// each facet. This holds for any specular fraction. The allowed difference includes the light that smooth elements
// diffract out of the cone.
TEST(DiffractionWithRoughness, TendsToRaysInWideCones) {
  const std::vector<double> cones_deg = {0.5, 1.0, 2.0, 3.5, 5.0};
  for (const Element& element : endless(1.0)) {
    const Part part = build_part(element.spec);
    const FarField smooth = engine_field(part, optics_of({}, true));
    for (const auto& [sq_nm, length_um] : {std::pair(10.0, 8.0), {30.0, 12.0}}) {
      const Optics optics = optics_of(rough(sq_nm, length_um), true);
      const FarField field = engine_field(part, optics);
      const auto traced = MonteCarlo(part).trace(optics, from(0.0), cones_deg, rays(1U << 16), {});
      for (const ConeResult& cone : traced.cones) {
        const double radius = cone.half_angle_deg * kDeg;
        const double beyond = 1.0 - smooth.split({}, radius).inside;
        EXPECT_LT(beyond, 0.02);
        EXPECT_NEAR(field.split({}, radius).inside / cone.rre, 1.0,
                    0.01 + beyond + student_bound(20) * cone.spread / cone.rre)
            << element.name << ", Sq " << sq_nm << " nm, " << cone.half_angle_deg << " degrees: " << cone.rre
            << ", beyond " << beyond;
      }
    }
  }
}

/// Returns the power that small heights on the facets of one prism scatter, per unit of direction cosine across the
/// roof edge. The two paths, x and -x, hit the same points of both facets, so that the phases at x and -x are equal.
/// The facets are inclined by 45 degrees. Heights with the correlation length l along the facet therefore have the
/// correlation length l / sqrt(2) in x.
/// \param variance variance of the phase
double scattered_by_prism(double size_mm, double length_mm, double variance, double cosine) {
  constexpr int kSteps = 600;
  const double step = size_mm / kSteps;
  double x = 0.0, y = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = (i + 0.5) * step - 0.5 * size_mm;
    for (int j = 0; j < kSteps; ++j) {
      const double b = (j + 0.5) * step - 0.5 * size_mm;
      const double apart = (std::abs(a) - std::abs(b)) / length_mm;
      x += std::exp(-2.0 * apart * apart) * std::cos(2.0 * pi / kWave * cosine * (a - b));
      y += std::exp(-(a - b) * (a - b) / (length_mm * length_mm));
    }
  }
  return variance * x * y * std::pow(step, 4.0) / (size_mm * size_mm * kWave * kWave);
}

// Within a quarter of wavelength / (prism size) of the return direction, the scattered light is twice that of single
// paths. Fringes follow at larger angles. Heights of 1 nm scatter light only one time. Points near x = 0 almost
// coincide with their partners at -x, which limits the accuracy of the far field to l / size.
TEST(DiffractionWithRoughness, OppositePathsOfAPrismDoubleTheScatterAboutTheReturn) {
  constexpr double kSize_mm = 0.45, kLength_um = 10.0, kSq_nm = 1.0;
  const Part part = build_part(single(RtpElement{kSize_mm, kSize_mm}, 0.3));
  const FarField field = engine_field(part, optics_of(rough(kSq_nm, kLength_um), true));
  const double phase = 4.0 * pi * kPmma * std::sqrt(0.5) * kSq_nm / kWaveNm;
  const FarField smooth = engine_field(part, optics_of({}, true));
  const auto by_engine = [&](double cosine) {  // scattered light only, without the mean field
    const Vec3 d(cosine, 0.0, std::sqrt(1.0 - cosine * cosine));
    return (field.diffracted_per_sr(d) + field.scattered_per_sr(d) -
            std::exp(-2.0 * phase * phase) * smooth.diffracted_per_sr(d)) /
           d.z();
  };
  const auto by_sum = [&](double cosine) {
    return scattered_by_prism(kSize_mm, 1e-3 * kLength_um, 2.0 * phase * phase, cosine);
  };
  const double width = kWave / (2.0 * kSize_mm);
  for (const double in_widths : {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 8.0})
    EXPECT_NEAR(by_engine(in_widths * width) / by_sum(in_widths * width), 1.0, 0.02) << in_widths;
  // Far from the return direction and from fringes, only the lobe of single paths remains. It is half as high as the
  // peak at the return direction.
  const double lobe = std::exp(-0.5 * std::pow(pi * 1e-3 * kLength_um * 8.0 * width / kWave, 2.0));
  EXPECT_NEAR(by_engine(0.0) * lobe / by_engine(8.0 * width), 2.0, 0.15);
}

// The scattered power is proportional to the square of small heights. As Sq goes to 0, the far field approaches that of
// smooth facets.
TEST(DiffractionWithRoughness, GoesToTheSmoothFieldWithTheSquareOfTheHeights) {
  for (const Element& element : endless(0.45)) {
    const Part part = build_part(element.spec);
    const FarField smooth = engine_field(part, optics_of({}, true));
    const auto differences = [&](double sq_nm) {
      const FarField field = engine_field(part, optics_of(rough(sq_nm, 20.0), true));
      std::vector<double> all = {field.split({}, 0.05 * kDeg).inside - smooth.split({}, 0.05 * kDeg).inside};
      for (const double cosine : {0.0, 2e-4, 1e-2}) {
        const Vec3 d(cosine, 0.0, std::sqrt(1.0 - cosine * cosine));
        all.push_back(field.diffracted_per_sr(d) + field.scattered_per_sr(d) - smooth.diffracted_per_sr(d));
      }
      return all;
    };
    const auto two = differences(2.0), one = differences(1.0), half = differences(0.5);
    for (std::size_t k = 0; k < two.size(); ++k) {
      EXPECT_NE(half[k], 0.0) << element.name << k;
      EXPECT_NEAR(two[k] / one[k], 4.0, 0.04) << element.name << k;
      EXPECT_NEAR(one[k] / half[k], 4.0, 0.01) << element.name << k;
    }
  }
}

}  // namespace
}  // namespace retrace::testing::scattered_limits_test
