// Tests of the exact engine against closed forms, symmetries and the Monte Carlo tracer.
#include "raytrace/exact/beam_tracer.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "materials/fresnel.h"
#include "raytrace/exact/beam.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::beam_tracer_test {
namespace {

using namespace geometry;
using namespace raytrace;

BeamPolicy leaving(double truncated) {
  BeamPolicy policy;
  policy.truncated_goal = truncated;
  return policy;
}

Ledger beams(const Part& part, const Optics& optics, const Illumination& illumination, double cone_deg,
             double truncated = 1e-10) {
  return BeamTracer(part).trace(optics, illumination, {cone_deg}, leaving(truncated)).ledgers[0];
}

TEST(BeamTracer, ArraySizeStudyExactly) {
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  for (const double base : {10.0, 5.0, 2.0, 1.0, 0.5}) {
    PartSpec spec = finite(RtpElement{base, base, 90.0}, Arrangement::offset, 10.0, 10.0, 2.0);
    spec.array.shifted_rows = RowParity::odd;
    const Part part = build_part(spec);
    const double full = static_cast<double>(part.elements_full) * base * base / 100.0;
    const Ledger ledger = beams(part, pmma(), from(0.0), 0.5);
    EXPECT_NEAR(ledger[Account::retroreflected], full + (1.0 - full) * 2.0 * fresnel / (1.0 + fresnel), 1e-9);
    EXPECT_NEAR(ledger.total(), 1.0, 1e-12);
  }
}

TEST(BeamTracer, EffectiveAperturesExactly) {
  const Part honeycomb = build_part(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0));
  const Part triangular = build_part(infinite(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0));
  const BeamTracer honeycomb_tracer(honeycomb);
  const BeamTracer triangular_tracer(triangular);
  for (double t = 0.0; t <= 75.0; t += 5.0)
    for (double p = 0.0; p < 360.0; p += 18.7) {
      const auto rre = [&](const BeamTracer& tracer) {
        return tracer.trace(ideal(), from(t, p), {0.01}, {}).ledgers[0][Account::retroreflected];
      };
      EXPECT_NEAR(rre(honeycomb_tracer), honeycomb_rre(t, p, kPmma), 1e-9) << t << ", " << p;
      EXPECT_NEAR(rre(triangular_tracer), triangular_rre(t, p, kPmma), 1e-9) << t << ", " << p;
    }
}

TEST(BeamTracer, KneeOfTotalReflection) {
  const Part part = build_part(single(RtpElement{0.45, 0.45, 90.0}, 0.5));
  const double knee = std::asin(kPmma * std::sin(45.0 * kDeg - std::asin(1.0 / kPmma))) / kDeg;
  EXPECT_EQ(beams(part, pmma(), from(knee - 1e-9), 0.5)[Account::transmitted], 0.0);
  EXPECT_GT(beams(part, pmma(), from(knee + 1e-9), 0.5)[Account::transmitted], 1e-6);
}

TEST(BeamTracer, AbsorptionIsExact) {
  const Part part = build_part(single(RtpElement{0.6, 0.4, 90.0}, 0.7));
  Optics optics = ideal();
  optics.absorption_per_mm = 0.3;
  const Ledger ledger = beams(part, optics, from(0.0), 0.5);
  EXPECT_NEAR(ledger[Account::retroreflected], std::exp(-0.3 * (2.0 * 0.7 + 0.6)), 1e-13);
  EXPECT_NEAR(ledger.total(), 1.0, 1e-12);
}

// A cube corner reflects totally at every azimuth up to the angle of incidence t with sin t = n sin(54.74 deg -
// asin(1/n)). Total reflection ends first for light that is tilted towards a dihedral edge.
TEST(BeamTracer, TotalReflectionLimitOfCubeCorners) {
  struct Published {
    double index;
    double limit_deg;
  };
  for (const auto& [index, limit_deg] : {Published{1.4906, 19.0}, Published{1.585, 25.3}, Published{1.4607, 17.0}}) {
    const double inside = std::acos(1.0 / std::numbers::sqrt3) - std::asin(1.0 / index);
    const double limit = std::asin(index * std::sin(inside)) / kDeg;
    EXPECT_NEAR(limit, limit_deg, 0.05);
    Optics optics;
    optics.index = index;
    optics.lossless_entrance = true;
    BeamPolicy policy;
    policy.cutoff = 1e-9;  // weaker beams have passed from cell to cell and do not return to the source
    for (const PartSpec& spec : {infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.7),
                                 infinite(TriangularCube{1.0}, Arrangement::triangular, 0.7)}) {
      const bool is_honeycomb = spec.array.arrangement == Arrangement::honeycomb;
      const Part part = build_part(spec);
      const BeamTracer tracer(part);
      const auto missing = [&, n = index](double t, double p) {
        const double all = is_honeycomb ? honeycomb_rre(t, p, n) : triangular_rre(t, p, n);
        return all - tracer.trace(optics, from(t, p), {0.01}, policy).ledgers[0][Account::retroreflected];
      };
      for (double p = 0.0; p < 360.0; p += 7.5) EXPECT_NEAR(missing(limit - 1e-9, p), 0.0, 1e-9) << p;
      EXPECT_GT(std::max(missing(limit + 1e-9, 0.0), missing(limit + 1e-9, 180.0)), 1e-6);
    }
  }
}

// A honeycomb has a threefold axis and a mirror plane. A triangular array has a sixfold axis, because every second
// cell is rotated by 180 degrees.
TEST(BeamTracer, Symmetries) {
  const Part honeycomb = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.7));
  const Part triangular = build_part(infinite(TriangularCube{1.0}, Arrangement::triangular, 0.7));
  Optics optics = pmma();
  // Weakens beams with many reflections, which rounding errors could move above or below the cut-off.
  optics.absorption_per_mm = 1.0;
  const auto rre = [&](const Part& part, double p) {
    return beams(part, optics, from(33.0, p), 0.5, 1e-9)[Account::retroreflected];
  };
  for (const double p : {7.0, 25.0, 50.0}) {
    const double at = rre(honeycomb, p);
    for (const double same : {p + 120.0, p + 240.0, -p}) EXPECT_NEAR(rre(honeycomb, same), at, 1e-9) << same;
    const double turned = rre(triangular, p);
    for (int k = 1; k < 6; ++k) EXPECT_NEAR(rre(triangular, p + 60.0 * k), turned, 1e-9) << k;
  }
}

struct RandomCase {
  PartSpec spec;
  Optics optics;
  Illumination illumination;
};

rc::Gen<double> between(double low, double high) {
  return rc::gen::map(rc::gen::inRange<std::uint32_t>(0, 1U << 30),
                      [=](std::uint32_t k) { return low + (high - low) * k / static_cast<double>(1U << 30); });
}

rc::Gen<bool> chance(double p) {
  return rc::gen::map(between(0.0, 1.0), [=](double u) { return u < p; });
}

rc::Gen<PartSpec> element_and_arrangement() {
  return rc::gen::exec([] {
    PartSpec spec;
    const double size = *between(0.4, 1.4);
    const int kind = *rc::gen::inRange(0, 3);
    if (kind == 0) {
      spec.element = RtpElement{size, *between(0.4, 1.4), *between(88.0, 92.0)};
      spec.array.arrangement = *rc::gen::element(Arrangement::aligned, Arrangement::offset);
      spec.array.x_gap_mm = *chance(0.3) ? 0.1 : 0.0;
    } else if (kind == 1) {
      spec.element = HexagonalCube{size};
      spec.array.arrangement = Arrangement::honeycomb;
    } else {
      spec.element = TriangularCube{size};
      spec.array.arrangement = Arrangement::triangular;
    }
    return spec;
  });
}

rc::Gen<RandomCase> random_case() {
  return rc::gen::exec([] {
    RandomCase c;
    c.spec = *element_and_arrangement();
    c.spec.thickness_mm = *between(0.1, 1.1);
    if (*chance(0.2)) {
      c.spec.array.arrangement = Arrangement::single;
      c.spec.array.x_gap_mm = 0.0;
    } else if (*chance(0.5)) {
      c.spec.array.extent = Extent::infinite;
    } else {
      // Arrays have few elements, so that the test is fast. One array in eight has so many elements that the
      // cell engine uses its inner region.
      const Vec2 size = bounding_box(element_cell(c.spec.element).outline).size();
      c.spec.array.x_length_mm = *between(2.9, 4.9) * (size.x() + c.spec.array.x_gap_mm);
      c.spec.array.y_length_mm = *between(3.1, 5.1) * size.y();
      if (*chance(0.3)) c.spec.array.partial_elements = PartialElements::omit;
    }
    c.optics.index = *between(1.3, 1.9);
    if (*chance(0.3)) c.optics.absorption_per_mm = *between(0.0, 0.3);
    c.illumination = from(*between(0.0, 75.0), *between(0.0, 360.0));
    return c;
  });
}

// The exact engine and Monte Carlo share only the geometry and Fresnel's formulas. For at least 88 % of 200 random
// designs, their difference must be within the 95 % interval of Monte Carlo. With fewer designs, the observed fraction
// has a larger standard error, so that `min_coverage` lowers the required fraction.
TEST(BeamTracer, AgreesWithMonteCarlo) {
  const std::size_t count = test::sample_size<std::size_t>(40, 200);
  const std::vector<RandomCase> cases =
      rc::gen::container<std::vector<RandomCase>>(count, random_case())(rc::Random(11), rc::kNominalSize).value();
  const double t95 = student_bound_of(0.05, Sampling::kReplicates);
  int within = 0;
  int cell_cases = 0;
  int cell_within = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const RandomCase& c = cases[k];
    const Part part = build_part(c.spec);
    // The truncated power is smaller than the error of Monte Carlo in nearly all designs.
    const Ledger exact = beams(part, c.optics, c.illumination, 2.0, 5e-4);
    EXPECT_NEAR(exact.total(), 1.0, 1e-9) << k;
    EXPECT_GT(exact[Account::truncated], -1e-9) << k;
    const auto agrees = [&](MonteCarlo::Engine engine) {
      const ConeResult traced =
          MonteCarlo(part, engine).trace(c.optics, c.illumination, {2.0}, rays(1U << 14), {}).cones[0];
      return std::abs(exact[Account::retroreflected] - traced.rre) <=
             t95 * traced.spread + exact[Account::truncated] + 1e-9;
    };
    within += agrees(MonteCarlo::Engine::embree) ? 1 : 0;
    if (!MonteCarlo::cell_supports(part)) continue;
    ++cell_cases;
    cell_within += agrees(MonteCarlo::Engine::cell) ? 1 : 0;
  }
  const double required = test::min_coverage(0.88, 200.0, static_cast<double>(count));
  EXPECT_GE(within, required * static_cast<double>(count));
  // 40 % of the designs are infinite arrays, which the cell engine can trace. The minimum of `cell_cases` is 2.9
  // standard errors of a binomial count below this expected number: 60 of 200 designs.
  const double with_cells = 0.4 * static_cast<double>(count);
  EXPECT_GE(cell_cases, with_cells - 2.9 * std::sqrt(0.6 * with_cells));
  EXPECT_GE(cell_within, required * cell_cases);
}

TEST(BeamTracer, RunsOutOfItsBudgetAloud) {
  const Part part = build_part(infinite(TriangularCube{1.0}, Arrangement::triangular, 0.7));
  BeamPolicy policy;
  policy.max_beams = 1000;
  try {
    BeamTracer(part).trace(pmma(), from(20.0, 10.0), {0.5}, policy);
    FAIL();
  } catch (const BudgetError& error) {
    EXPECT_EQ(recorded_place_of(error), "failed");
  }
}

// If x increases linearly by `width` over a rectangle, starting at `least`, the mean of exp(-x) is
// exp(-least) (1 - exp(-width)) / width.
TEST(MeanTransmission, IsThatOfTheClosedForm) {
  const Corners corners = {Vec3(1.0, 0.0, 0.0), Vec3(1.0, 1.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 0.0)};
  for (const double least : {0.0, 0.3, 2000.0})
    for (const double width : {1e-9, 1e-3, 0.1, 0.4999, 0.5001, 1.0, 2.0, 5.0, 40.0, 2000.0}) {
      const double expected = std::exp(-least) * -std::expm1(-width) / width;
      const double found = mean_transmission(corners, {least, Vec3(width, 0.0, 0.0)}, 1.0);
      EXPECT_NEAR(found, expected, 1e-14 * expected) << least << ", " << width;
    }
}

// Compares the mean of exp(-x) over a triangle with a sum over a fine subdivision, from no absorption to strong
// absorption.
TEST(MeanTransmission, IsTheIntegral) {
  const Corners corners = {Vec3(0.1, 0.0, 0.0), Vec3(1.0, 0.2, 0.3), Vec3(0.4, 0.9, -0.2), Vec3(0.0, 0.5, -0.2)};
  const PathLength length{2.0, Vec3(1.0, -0.5, 0.3)};
  for (const double a : {0.0, 1e-6, 0.1, 1.0, 10.0, 100.0}) {
    double sum = 0.0;
    double whole = 0.0;
    constexpr int kSteps = 400;
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const Vec3 u = corners[k - 1] - corners[0];
      const Vec3 v = corners[k] - corners[0];
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; i + j < kSteps; ++j)
          for (const double third : {1.0 / 3.0, 2.0 / 3.0}) {
            if (third > 0.5 && i + j + 1 >= kSteps) continue;
            const Vec3 p = corners[0] + (i + third) / kSteps * u + (j + third) / kSteps * v;
            sum += u.cross(v).norm() * std::exp(-a * length.at(p));
            whole += u.cross(v).norm();
          }
    }
    EXPECT_NEAR(mean_transmission(corners, length, a) / (sum / whole), 1.0, 1e-3 * std::min(1.0, a * a / 100.0) + 1e-6);
  }
}

}  // namespace
}  // namespace retrace::testing::beam_tracer_test
