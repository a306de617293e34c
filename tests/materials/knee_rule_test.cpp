// Tests of the wavelengths that are used for the mean of a property with knees. A knee is a wavelength at which the
// property begins to change like a square root, such as the reflectance where total reflection ends. The means are
// compared with sums over fine steps.
#include "materials/knee_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "materials/io/spectrum_reader.h"

namespace retrace::materials::knee_rule_test {
namespace {

using Property = std::function<double(double)>;

double mean(const Spectrum& rule, const Property& property) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.size(); ++k) sum += rule.weights[k] * property(rule.wavelengths_nm[k]);
  return sum;
}

/// Returns the mean of a function of the wavelength, weighted by flux. The midpoint rule with fine steps is used.
double fine_mean(const SpectralCurve& lamp, const SpectralCurve& eye, const Property& property) {
  constexpr double kStepNm = 0.02;
  double sum = 0.0, flux = 0.0;
  for (double w = lamp.wavelengths_nm.front() + 0.5 * kStepNm; w < lamp.wavelengths_nm.back(); w += kStepNm) {
    const double weight = lamp.at(w) * eye.at(w);
    flux += weight;
    sum += weight * property(w);
  }
  return sum / flux;
}

struct KneeRule : ::testing::Test {
  CieTable table = read_cie_table(RETRACE_SOURCE_DIR "/data/cie_v_a_d65_5nm.csv");
};

TEST_F(KneeRule, IsARule) {
  for (const std::vector<double>& knees : {std::vector<double>{}, {555.0}, {450.0, 600.0}, {300.0, 560.5, 900.0}}) {
    const Spectrum rule = knee_rule(table.illuminant_a, table.photopic_efficiency, 5, knees);
    EXPECT_NEAR(std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0), 1.0, 1e-12);
    EXPECT_TRUE(std::ranges::is_sorted(rule.wavelengths_nm));
    for (const double weight : rule.weights) EXPECT_GT(weight, 0.0);
    EXPECT_LE(rule.size(), 2 * (5 + knees.size()));
    EXPECT_NEAR(mean(rule, [](double w) { return w; }),
                fine_mean(table.illuminant_a, table.photopic_efficiency, [](double w) { return w; }), 0.05)
        << "the trapezoidal rule on the 5 nm grid of the table has an error of 0.03 nm";
  }
}

// The test function behaves like a reflectance above the knee, and like the phase of total reflection below the knee.
// Its mean must be accurate with a spectrum that is divided into only four spans.
TEST_F(KneeRule, KneesCostLittle) {
  for (const SpectralCurve* lamp : {&table.illuminant_a, &table.illuminant_d65}) {
    for (double knee = 440.0; knee < 680.0; knee += 7.3) {
      const Property property = [&](double w) {
        const double root = std::sqrt(std::abs(w - knee) / 200.0);
        return w > knee ? std::pow((1.0 - root) / (1.0 + root), 2.0) : 1.0 + 0.2 * root;
      };
      const double expected = fine_mean(*lamp, table.photopic_efficiency, property);
      EXPECT_NEAR(mean(knee_rule(*lamp, table.photopic_efficiency, 4, {knee}), property), expected, 2e-3) << knee;
    }
    const Property two = [](double w) {
      const auto loss = [&](double knee) { return w > knee ? 0.5 * std::sqrt((w - knee) / 200.0) : 0.0; };
      return 1.0 - loss(540.0) - loss(585.0);
    };
    EXPECT_NEAR(mean(knee_rule(*lamp, table.photopic_efficiency, 4, {540.0, 585.0}), two),
                fine_mean(*lamp, table.photopic_efficiency, two), 1e-3);
  }
}

}  // namespace
}  // namespace retrace::materials::knee_rule_test
