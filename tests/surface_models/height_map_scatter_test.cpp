// Tests of scatter from measured maps: closed forms, diffraction by the spectrum of the map, and facets.
#include "surface_models/scatter/height_map_scatter.h"

#include "core/error.h"
#include "surface_models/form.h"
#include "surface_models/scatter/phase.h"
#include "tests/support/statistics.h"
#include "tests/surface_models/scatter_checks.h"

namespace retrace::testing::height_map_scatter_test {
namespace {

using namespace scatter_checks;

constexpr double kPi = std::numbers::pi;

/// Returns a map of waves along x with a whole number of periods.
HeightMap sine_map(std::size_t points, double pixel_um, double sq_nm, double length_um) {
  HeightMap map = flat(points, pixel_um);
  for (std::size_t r = 0; r < points; ++r)
    for (std::size_t c = 0; c < points; ++c)
      map.at(c, r) =
          std::sqrt(2.0) * sq_nm * std::cos(2.0 * kPi * (static_cast<double>(c) + 0.5) * pixel_um / length_um);
  return map;
}

TEST(HeightMapScatter, SpecularShareIsTheClosedForm) {
  constexpr std::uint32_t kDraws = 100000;
  std::uint32_t seed = 500;
  for (const double sq_nm : {5.0, 10.0, 20.0, 40.0})
    for (const double t_deg : {0.0, 45.0, 54.74, 75.0}) {
      const HeightMapScatter model(random_map(64, 0.5, sq_nm, 3.0, 3.0), 550.0);
      const ScatterEvent event = inside(t_deg);
      const double p = std::exp(-std::pow(4.0 * kPi * kIndex * sq_nm * std::cos(t_deg * kRadians) / 550.0, 2));
      EXPECT_NEAR(specular_fraction(model, event, {}, Lobe::reflection), p, 1e-9);
      EXPECT_NEAR(specular_draws(model, event, Lobe::reflection, ++seed, kDraws), p,
                  normal_bound(16) * std::sqrt(p * (1.0 - p) / kDraws) + 1e-9)
          << sq_nm << " nm, " << t_deg << " deg";
    }
}

// For Gaussian heights, the specular fraction equals the diffraction integral over the map itself.
TEST(HeightMapScatter, SpecularShareIsTheMeanPhaseOfTheMap) {
  const HeightMap map = random_map(512, 0.5, 30.0, 2.0, 2.0);
  std::complex<double> mean = 0.0;
  const double per_nm = 4.0 * kPi * kIndex * std::cos(45.0 * kRadians) / 550.0;
  for (const double z : map.heights_nm) mean += std::polar(1.0, per_nm * z);
  mean /= static_cast<double>(map.heights_nm.size());
  EXPECT_NEAR(specular_fraction(HeightMapScatter(map, 550.0), inside(45.0), {}, Lobe::reflection), std::norm(mean),
              0.01);
}

TEST(HeightMapScatter, SamplesFollowTheDensity) {
  // The correlation lengths along x and y differ, so that the test detects swapped axes. In one case, the horizon cuts
  // the lobe.
  const HeightMapScatter model(random_map(32, 0.4, 40.0, 2.0, 1.0), 550.0);
  std::uint32_t seed = 600;
  for (const auto& [name, event, lobe] : cases()) {
    const double wave_um = 0.55 / event.index_of(lobe);
    // The density has steps between the cells of the spectrum. Each bin therefore is one of these cells.
    const double step = wave_um / (32 * 0.4);
    const Vec2 centre = specular_direction(event, Vec3::UnitZ(), lobe)->head<2>();
    const Density density = scaled_density(model, event, lobe);
    constexpr int kHalf = 6, kSide = 2 * kHalf + 1;
    std::vector<double> expected(kSide * kSide + 1, 0.0), seen(kSide * kSide + 1, 0.0);
    constexpr std::uint32_t kDraws = 200000;
    using boost::math::quadrature::gauss;
    double sum = 0.0;
    for (int j = 0; j < kSide * kSide; ++j) {
      const double x = centre.x() + step * (j % kSide - kHalf), y = centre.y() + step * (j / kSide - kHalf);
      const auto column = [&](double at_x) {
        return gauss<double, 7>::integrate(
            [&](double at_y) {
              return density({at_x, at_y});
            },
            y - 0.4999999 * step, y + 0.4999999 * step);
      };
      const Vec2 corner(std::abs(x) + step, std::abs(y) + step);
      if (corner.norm() < 1.0)
        expected[static_cast<std::size_t>(j)] =
            kDraws * gauss<double, 7>::integrate(column, x - 0.4999999 * step, x + 0.4999999 * step);
      sum += expected[static_cast<std::size_t>(j)];
    }
    expected.back() = kDraws - sum;
    const Draw draw = draw_of(model, event, lobe);
    ++seed;
    for (std::uint32_t k = 0; k < kDraws; ++k) {
      RandomStream random = stream(seed, k);
      const auto beta = draw(random);
      std::size_t bin = kSide * kSide;
      if (beta) {
        const int x = static_cast<int>(std::lround((beta->x() - centre.x()) / step)) + kHalf;
        const int y = static_cast<int>(std::lround((beta->y() - centre.y()) / step)) + kHalf;
        if (x >= 0 && x < kSide && y >= 0 && y < kSide) {
          const auto found = static_cast<std::size_t>(y * kSide + x);
          if (expected[found] >= 10.0) bin = found;
        }
      }
      seen[bin] += 1.0;
    }
    double chi2 = 0.0, rest = expected.back();
    int bins = 0;
    for (std::size_t j = 0; j + 1 < expected.size(); ++j) {
      if (expected[j] < 10.0) {
        rest += expected[j];
        continue;
      }
      chi2 += (seen[j] - expected[j]) * (seen[j] - expected[j]) / expected[j];
      ++bins;
    }
    chi2 += (seen.back() - rest) * (seen.back() - rest) / rest;
    EXPECT_GE(bins, 20) << name;
    EXPECT_GT(boost::math::cdf(boost::math::complement(boost::math::chi_squared(bins), chi2)),
              sidak_level(cases().size()))
        << name;
  }
}

TEST(HeightMapScatter, SpecularShareIsTheClosedFormOnBothSides) {
  std::uint32_t seed = 800;
  for (const double sq_nm : {20.0, 60.0}) {
    const HeightMapScatter model(random_map(64, 0.5, sq_nm, 4.0, 4.0), 550.0);
    for (const Case& c : cases()) expect_closed_form_share(model, sq_nm, c, ++seed, 2 * cases().size());
  }
}

TEST(HeightMapScatter, ConservesEnergy) {
  const HeightMapScatter model(random_map(32, 0.4, 40.0, 2.0, 1.0), 550.0);
  for (const Case& c : cases()) {
    const double scattered = disc_integral(scaled_density(model, c.event, c.lobe), 700, 700);
    EXPECT_GT(scattered, 0.01) << c.name;
    // The density has steps. Numerical integration in this test has errors of about 1e-3.
    EXPECT_NEAR(scattered + specular_fraction(model, c.event, {}, c.lobe), 1.0, 2e-3) << c.name;
  }
}

// The waves of the map are oblique, so that a mirrored map would be detected. In transmission, reciprocity applies to
// the density divided by n squared.
TEST(HeightMapScatter, IsReciprocalBeforeScaling) {
  HeightMap map = random_map(64, 0.4, 25.0, 3.0, 2.0);
  for (std::size_t r = 0; r < map.rows; ++r)
    for (std::size_t c = 0; c < map.columns; ++c)
      map.at(c, r) += 15.0 * std::sin(2.0 * kPi * (3.0 * static_cast<double>(c) + 5.0 * static_cast<double>(r)) / 64.0);
  const HeightMapScatter model(map, 550.0);
  for (const double a : {0.12, 0.33, 0.58})
    for (const double b : {0.07, 0.41, 0.61}) {
      ScatterEvent forward = inside(0.0), backward = inside(0.0), in = outside(0.0);
      forward.direction_in = -direction_of(Vec2(-a, 0.1), Lobe::reflection);
      const Vec3 up = direction_of(Vec2(b, -0.13), Lobe::reflection);
      backward.direction_in = -up;
      const double there = model.unscaled_density(forward, {}, Lobe::reflection, up.head<2>());
      EXPECT_GT(there, 0.0);
      EXPECT_NEAR(model.unscaled_density(backward, {}, Lobe::reflection, -forward.direction_in.head<2>()), there,
                  1e-9 * there);
      const Vec3 left = direction_of(Vec2(b, -0.13), Lobe::transmission);
      const auto turned = [](const Vec3& v) { return Vec3(v.x(), -v.y(), -v.z()); };
      in.direction_in = turned(-left);
      const double leaves = model.unscaled_density(forward, {}, Lobe::transmission, left.head<2>());
      const double enters = model.unscaled_density(in, {}, Lobe::transmission, turned(-forward.direction_in).head<2>());
      EXPECT_GT(leaves, 0.0);
      EXPECT_NEAR(leaves * kIndex * kIndex, enters, 1e-6 * enters);
    }
}

// The map consists of roofs with two slopes. The probability that light hits a slope is proportional to the area of
// this slope, projected along the light. Light from both sides of the surface is tested.
TEST(HeightMapScatter, FacetsAreDrawnByTheirCrossSection) {
  HeightMap map = flat(96, 1.0);
  for (std::size_t r = 0; r < 96; ++r)
    for (std::size_t c = 0; c < 96; ++c) {
      const double phase = static_cast<double>(c % 48);
      map.at(c, r) = phase < 32.0 ? 60.0 * phase : 120.0 * (48.0 - phase);
    }
  const HeightMapScatter model(map, 550.0);
  // Levelling tilts both slopes equally. Central differences at the crests and at the border belong to neither slope.
  // Of 96 columns, 62 rise and 29 fall.
  const HeightMap levelled = without_form(map, 1);
  const double rise = 1e-3 * (levelled.at(11, 0) - levelled.at(10, 0));
  const double fall = 1e-3 * (levelled.at(41, 0) - levelled.at(40, 0));
  constexpr std::uint32_t kDraws = 100000;
  std::uint32_t seed = 900;
  for (const double t_deg : {0.0, 40.0, 70.0})
    for (const bool is_inside : {true, false}) {
      ScatterEvent event = is_inside ? inside(t_deg) : outside(t_deg);
      const Vec3 light = -event.direction_in;
      double rising = 0.0, falling = 0.0;
      ++seed;
      for (std::uint32_t k = 0; k < kDraws; ++k) {
        RandomStream random = stream(seed, k);
        const Facet facet = sample_facet(model, event, random);
        ASSERT_TRUE(facet.is_tilted);
        const double slope = (is_inside ? 1.0 : -1.0) * facet.normal.x() / facet.normal.z();
        rising += std::abs(slope - rise) < 1e-9 ? 1.0 : 0.0;
        falling += std::abs(slope - fall) < 1e-9 ? 1.0 : 0.0;
      }
      const auto section = [&](double slope) { return light.z() + (is_inside ? 1.0 : -1.0) * slope * light.x(); };
      const double expected = 62.0 * section(rise) / (62.0 * section(rise) + 29.0 * section(fall));
      const double count = rising + falling;
      EXPECT_GT(count, 0.9 * kDraws);
      EXPECT_NEAR(rising / count, expected, normal_bound(6) * std::sqrt(expected * (1.0 - expected) / count))
          << t_deg << (is_inside ? " inside" : " outside");
    }
}

// A sine wave with small heights is a grating. Its first orders are at w / (n L), and no light is scattered along y.
TEST(HeightMapScatter, LowWavesDiffract) {
  const HeightMapScatter model(sine_map(64, 0.5, 5.0, 4.0), 550.0);
  ScatterEvent event = inside(0.0);
  double scattered = 0.0, x2 = 0.0, y2 = 0.0;
  for (std::uint32_t k = 0; k < 200000; ++k) {
    RandomStream random = stream(21, k);
    const auto drawn = sample(model, event, sample_facet(model, event, random), Lobe::reflection, random);
    ASSERT_TRUE(drawn);
    if (drawn->is_specular) continue;
    scattered += 1.0;
    x2 += drawn->direction.x() * drawn->direction.x();
    y2 += drawn->direction.y() * drawn->direction.y();
  }
  EXPECT_GT(scattered, 4000.0);
  EXPECT_NEAR(std::sqrt(x2 / scattered) / (0.55 / kIndex / 4.0), 1.0, 0.03);
  EXPECT_LT(std::sqrt(y2 / scattered), 0.25 * std::sqrt(x2 / scattered));
}

// A sine wave with large heights reflects by its slopes, which are at most sqrt(2) 2 pi Sq / L, along x only.
TEST(HeightMapScatter, HighWavesReflectByTheirSlopes) {
  const double sq_nm = 300.0, length_um = 32.0;
  const HeightMapScatter model(sine_map(512, 0.25, sq_nm, length_um), 550.0);
  const ScatterEvent event = inside(0.0);
  double squares = 0.0, largest = 0.0;
  constexpr std::uint32_t kDraws = 100000;
  for (std::uint32_t k = 0; k < kDraws; ++k) {
    RandomStream random = stream(22, k);
    const Facet facet = sample_facet(model, event, random);
    ASSERT_TRUE(facet.is_tilted);
    const Vec2 slope = facet.normal.head<2>() / facet.normal.z();
    EXPECT_NEAR(slope.y(), 0.0, 1e-12);
    squares += slope.squaredNorm();
    largest = std::max(largest, slope.norm());
  }
  const double rms = 2.0 * kPi * 1e-3 * sq_nm / length_um;
  EXPECT_NEAR(std::sqrt(squares / kDraws) / rms, 1.0, 0.01);
  EXPECT_NEAR(largest / (std::sqrt(2.0) * rms), 1.0, 0.01);
}

// A saw-tooth has small slopes in one direction and large slopes in the other. Its facets are tested from both sides of
// the surface.
TEST(HeightMapScatter, FacetsHaveTheMapsOrientation) {
  HeightMap map = flat(64, 1.0);
  for (std::size_t r = 0; r < 64; ++r)
    for (std::size_t c = 0; c < 64; ++c) {
      const double phase = static_cast<double>(c % 16);
      map.at(c, r) = 100.0 * (phase < 12.0 ? phase : 3.0 * (16.0 - phase));
    }
  const HeightMapScatter model(map, 550.0);
  const auto rising = [&](bool inside_material) {
    ScatterEvent event = inside_material ? inside(0.0) : outside(0.0);
    double towards_minus_x = 0.0;
    for (std::uint32_t k = 0; k < 10000; ++k) {
      RandomStream random = stream(23, k);
      towards_minus_x += sample_facet(model, event, random).normal.x() < -1e-3 ? 1.0 : 0.0;
    }
    return towards_minus_x / 10000.0;
  };
  // Heights rise along x over 3/4 of a period. There, the normals that point out of the material are tilted towards -x.
  EXPECT_GT(rising(false), 0.65);
  EXPECT_LT(rising(true), 0.35);
}

TEST(HeightMapScatter, FlatMapsAndMissingPoints) {
  RandomStream random = stream(24, 0);
  HeightMap map = flat(16, 1.0);
  map.at(3, 4) = kMissing;
  const HeightMapScatter model(map, 550.0);
  const auto drawn = sample(model, inside(30.0), sample_facet(model, inside(30.0), random), Lobe::reflection, random);
  ASSERT_TRUE(drawn);
  EXPECT_TRUE(drawn->is_specular);
  EXPECT_EQ(specular_fraction(model, inside(30.0), {}, Lobe::reflection), 1.0);
  EXPECT_THROW(HeightMapScatter(flat(7, 1.0), 550.0), InputError);
  map.heights_nm.assign(256, kMissing);
  EXPECT_THROW(HeightMapScatter(map, 550.0), InputError);
}

TEST(HeightMapScatter, Warns) {
  EXPECT_TRUE(warnings(HeightMapScatter(random_map(128, 0.15, 20.0, 1.5, 1.5), 550.0), kIndex, 550.0).empty());
  const auto coarse = warnings(HeightMapScatter(sine_map(64, 1.29, 20.0, 40.0), 550.0), kIndex, 550.0);
  EXPECT_EQ(coarse.size(), 2U);  // warnings about the sampling and about the kurtosis of a sine
}

}  // namespace
}  // namespace retrace::testing::height_map_scatter_test
