// Tests of sums over elements and wavelengths that are estimated from a sample. The reference is the sum over all pairs
// of element and wavelength.
#include "studies/photometry/element_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace retrace::testing::element_sample_test {
namespace {

using raytrace::ElementPortion, studies::ElementSample, studies::SampledElement, studies::SampledSum;

constexpr std::size_t kColumns = 24, kRows = 16;

/// Returns the portions of the elements of a rectangular array. Elements at the border have smaller portions.
std::vector<ElementPortion> portions() {
  std::vector<ElementPortion> all;
  for (std::size_t j = 0; j < kRows; ++j)
    for (std::size_t i = 0; i < kColumns; ++i) {
      ElementPortion portion;
      portion.at_mm = {3.0 * static_cast<double>(i), 2.6 * static_cast<double>(j)};
      portion.is_at_border = i == 0 || j == 0 || i + 1 == kColumns || j + 1 == kRows;
      portion.fraction = portion.is_at_border ? 0.001 + 0.001 * static_cast<double>((i + 3 * j) % 5) / 4.0 : 0.0025;
      all.push_back(portion);
    }
  return all;
}

std::vector<double> weights() {
  return {0.1, 0.2, 0.25, 0.2, 0.15, 0.05};
}

/// Function that returns the reading of an element at a wavelength.
using Reading = std::function<double(std::size_t element, std::size_t wavelength)>;

/// Returns the sum of portion * weight * reading over all pairs of element and wavelength.
double whole_sum(const Reading& reading) {
  const std::vector<ElementPortion> all = portions();
  double sum = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t w = 0; w < weights().size(); ++w) sum += all[k].fraction * weights()[w] * reading(k, w);
  return sum;
}

SampledSum estimate(const ElementSample& sample, const Reading& reading) {
  std::vector<double> readings;
  for (const SampledElement& one : sample.samples()) readings.push_back(reading(one.element, one.wavelength));
  return sample.sum(readings);
}

double smooth(std::size_t element, std::size_t wavelength) {
  static const std::vector<ElementPortion> all = portions();
  const auto& at = all[element].at_mm;
  const double x = at.x() / 70.0, y = at.y() / 40.0, u = static_cast<double>(wavelength) / 5.0;
  return 1.0 + 0.6 * x - 0.4 * y + 0.5 * x * x - 0.3 * x * y + 0.2 * u;
}

TEST(ElementSample, SelectsAllPairsIfThereAreFew) {
  const ElementSample sample(portions(), weights(), kColumns * kRows * weights().size());
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const SampledElement& one : sample.samples()) {
    pairs.emplace(one.element, one.wavelength);
    EXPECT_DOUBLE_EQ(one.weight, portions()[one.element].fraction * weights()[one.wavelength]);
  }
  EXPECT_EQ(pairs.size(), kColumns * kRows * weights().size());
  const Reading rough = [](std::size_t k, std::size_t w) { return std::sin(static_cast<double>(7 * k + 3 * w)); };
  const SampledSum sum = estimate(sample, rough);
  EXPECT_NEAR(sum.value, whole_sum(rough), 1e-12);
  EXPECT_EQ(sum.std_error, 0.0);
}

TEST(ElementSample, OmitsElementsWithoutLight) {
  std::vector<ElementPortion> all = portions();
  for (std::size_t k = 0; k < all.size(); k += 2) all[k].fraction = 0.0;
  for (const std::size_t count : {std::size_t{96}, std::size_t{10'000}}) {
    const ElementSample sample(all, weights(), count);
    for (const SampledElement& one : sample.samples()) EXPECT_EQ(one.element % 2, 1U);
  }
}

// The estimate fits polynomials to the sample. These polynomials contain all terms of smooth(), so the estimate must be
// exact.
TEST(ElementSample, SumsOfPolynomialsAreExact) {
  for (const std::size_t count : {48U, 96U, 300U}) {
    const ElementSample sample(portions(), weights(), count);
    EXPECT_LE(sample.samples().size(), count);
    double all_weights = 0.0;
    for (const SampledElement& one : sample.samples()) all_weights += one.weight;
    EXPECT_NEAR(all_weights, whole_sum([](std::size_t, std::size_t) { return 1.0; }), 1e-12) << count;
    if (count < 96) continue;
    const SampledSum sum = estimate(sample, smooth);
    EXPECT_NEAR(sum.value, whole_sum(smooth), 1e-9) << count;
    EXPECT_LT(sum.std_error, 1e-9) << count;
  }
}

// The readings deviate randomly from a smooth function of the element's position. Over many such parts, the actual
// errors of the estimate must be consistent with the reported standard errors.
TEST(ElementSample, ErrorsHaveTheStatedSpread) {
  constexpr int kParts = 400;
  const ElementSample sample(portions(), weights(), 96);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.1);
  double squared_ratios = 0.0;
  int within = 0;
  for (int part = 0; part < kParts; ++part) {
    std::vector<double> deviations;
    for (std::size_t k = 0; k < kColumns * kRows; ++k) deviations.push_back(normal(random));
    const Reading reading = [&](std::size_t k, std::size_t w) { return smooth(k, w) + deviations[k]; };
    const SampledSum sum = estimate(sample, reading);
    const double ratio = (sum.value - whole_sum(reading)) / sum.std_error;
    squared_ratios += ratio * ratio / kParts;
    within += std::abs(ratio) < 1.96 ? 1 : 0;
  }
  EXPECT_NEAR(std::sqrt(squared_ratios), 1.0, 0.35);
  EXPECT_GT(within, kParts * 9 / 10);
}

}  // namespace
}  // namespace retrace::testing::element_sample_test
