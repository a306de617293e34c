#include "studies/optimise/noisy_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace retrace::testing::noisy_search_test {
namespace {

using studies::ErrorLevel, studies::Estimate, studies::NoisyOptimum, studies::NoisySearchSettings, studies::Observation,
    studies::SearchPoint;
using Position = std::vector<double>;

/// Function with a known maximum.
struct Problem {
  std::string name;
  std::size_t dimensions = 1;
  std::function<double(std::size_t combination, const Position&)> value;
  double maximum = 0.0;
  std::size_t combinations = 1;
  /// Excess over a limit, which is observed together with the value. Empty if the problem has no limit.
  std::function<double(const Position&)> excess = {};
  bool is_cheap = false;           ///< true: is_allowed() checks the limit without an observation
  std::vector<double> peaks = {};  ///< positions of peaks that peaks_near() returns
};

/// Returns a pseudo-random number from -1 to 1 that is a function of the two arguments (SplitMix64).
double hashed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = a * 0x9e3779b97f4a7c15U + b * 0xbf58476d1ce4e5b9U + 0x94d049bb133111ebU;
  for (int k = 0; k < 3; ++k) {
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    x ^= x >> 31U;
  }
  return 2.0 * static_cast<double>(x >> 11U) / 9007199254740992.0 - 1.0;
}

/// Returns a normally distributed pseudo-random number that is a function of the two arguments.
double normal(std::uint64_t a, std::uint64_t b) {
  const double u = 0.5 + 0.4999999999 * hashed(a, 2 * b);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(std::numbers::pi * hashed(a, 2 * b + 1));
}

/// Problem whose observed values have random errors. A fraction of each error is common to all points.
class Noisy : public studies::SearchedFunction {
 public:
  /// \param sigma standard error of an observation with ErrorLevel::scale 1
  /// \param common fraction of the variance that is common to all points of a replicate
  Noisy(const Problem& problem, double sigma, double common, std::uint64_t seed)
      : problem_(problem), sigma_(sigma), common_(common), seed_(seed) {}

  std::vector<Observation> observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) override {
    std::vector<Observation> seen;
    for (const SearchPoint& point : points) {
      Observation one;
      const double sigma = sigma_ * level.scale;
      one.objective =
          Estimate{problem_.value(point.combination, point.fractions) + sigma * error_of(point, level), sigma};
      if (problem_.excess) one.excess.push_back({problem_.excess(point.fractions), 0.0});
      seen.push_back(one);
    }
    return seen;
  }

  bool is_allowed(const SearchPoint& point) const override {
    return !problem_.is_cheap || problem_.excess(point.fractions) <= 0.0;
  }

  std::vector<SearchPoint> peaks_near(const SearchPoint& point, double within) const override {
    std::vector<SearchPoint> found;
    for (const double peak : problem_.peaks)
      if (std::abs(peak - point.fractions[0]) <= within) found.push_back({point.combination, {peak}});
    return found;
  }

  /// Returns positions that are rounded to multiples of decreasing steps, from 0.1 to 1e-4.
  std::vector<SearchPoint> rounder_points(const SearchPoint& point, double within) const override {
    std::vector<SearchPoint> found;
    for (const double step : {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 1e-4}) {
      SearchPoint round = point;
      bool is_near = true;
      for (double& x : round.fractions) {
        const double at = step * std::round(x / step);
        is_near = is_near && std::abs(at - x) <= within;
        x = at;
      }
      if (is_near) found.push_back(round);
    }
    return found;
  }

 private:
  /// Returns the random error of a point, divided by its standard error. Its common fraction is a smooth function of
  /// the position.
  double error_of(const SearchPoint& point, const ErrorLevel& level) const {
    const std::uint64_t stream = seed_ * 1000 + level.replicate * 10 + (level.scale > 3.0 ? 1U : 0U);
    double smooth = normal(stream, 1);
    std::uint64_t own = point.combination + 17;
    for (const double x : point.fractions) {
      smooth = (smooth + 0.3 * std::sin(2.0 * x + normal(stream, 3))) / 1.02;
      own = own * 0x100000001b3U ^ static_cast<std::uint64_t>(x * 1e15);
    }
    return std::sqrt(common_) * smooth + std::sqrt(1.0 - common_) * normal(stream + 7, own);
  }

  const Problem& problem_;
  double sigma_;
  double common_;
  std::uint64_t seed_;
};

double sum_of_squares(const Position& x, const Position& centre, const Position& weights) {
  double sum = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += weights[k] * std::pow(x[k] - centre[k], 2);
  return sum;
}

double teeth(double x) {
  // Fraction of a part of length 1 that whole elements fill, as a function of their size. It has a peak at each size
  // for which 1 / size is a whole number. The second term makes one of the peaks the highest.
  const double size = 0.02 + 0.08 * x;
  return std::floor(1.0 / size + 1e-9) * size - 2.0 * std::pow(x - 0.43, 2);
}

std::vector<double> tooth_positions() {
  std::vector<double> peaks;
  for (int k = 10; k <= 50; ++k) peaks.push_back((1.0 / k - 0.02) / 0.08);
  return peaks;
}

double best_tooth() {
  double best = -1e9;
  for (const double x : tooth_positions()) best = std::max(best, teeth(x));
  return best;
}

/// Returns problems whose maxima are known in closed form.
std::vector<Problem> problems() {
  const auto line = [](auto f) { return [f](std::size_t, const Position& x) { return f(x[0]); }; };
  const auto plane = [](auto f) { return [f](std::size_t, const Position& x) { return f(x[0], x[1]); }; };
  std::vector<Problem> all;
  all.push_back({"parabola", 1, line([](double x) { return 0.9 - std::pow(x - 0.37, 2); }), 0.9});
  all.push_back({"steep parabola", 1, line([](double x) { return 0.5 - 20.0 * std::pow(x - 0.811, 2); }), 0.5});
  all.push_back({"flat parabola", 1, line([](double x) { return 0.7 - 0.02 * std::pow(x - 0.43, 2); }), 0.7});
  all.push_back({"fourth power", 1, line([](double x) { return 1.0 - 3.0 * std::pow(x - 0.6, 4); }), 1.0});
  all.push_back({"kink", 1, line([](double x) { return 0.8 - 0.5 * std::abs(x - 0.3217); }), 0.8});
  all.push_back({"rise and decay", 1, line([](double x) { return 6.0 * x * std::exp(1.0 - 6.0 * x); }), 1.0});
  all.push_back({"maximum at the end", 1, line([](double x) { return 0.2 + 0.3 * x; }), 0.5});
  all.push_back({"two bumps", 1, line([](double x) {
                   return std::exp(-200.0 * std::pow(x - 0.22, 2)) + 0.9 * std::exp(-50.0 * std::pow(x - 0.75, 2));
                 }),
                 1.0 + 0.9 * std::exp(-50.0 * 0.53 * 0.53)});
  all.push_back({"limit that costs nothing", 1, line([](double x) { return x; }), std::sqrt(0.5), 1,
                 [](const Position& x) { return x[0] * x[0] - 0.5; }, true});
  all.push_back({"limit that is observed", 1, line([](double x) { return 1.0 - x; }), 1.0 - 0.25, 1,
                 [](const Position& x) { return std::sqrt(0.25) - std::sqrt(x[0]); }});
  all.push_back({"logarithm", 1, line([](double x) { return 0.6 - std::pow(std::log((x + 0.1) / 0.4), 2); }), 0.6});
  all.push_back({"whole divisions", 1, line(teeth), best_tooth(), 1, {}, false, tooth_positions()});
  all.push_back({"paraboloid", 2,
                 plane([](double x, double y) { return 1.0 - std::pow(x - 0.33, 2) - 2.0 * std::pow(y - 0.71, 2); }),
                 1.0});
  all.push_back(
      {"oblique ellipses", 2,
       plane([](double x, double y) { return 0.4 - std::pow(x + y - 1.1, 2) - 4.0 * std::pow(x - y - 0.2, 2); }), 0.4});
  all.push_back({"oblique limit", 2,
                 plane([](double x, double y) { return -std::pow(x - 0.7, 2) - std::pow(y - 0.7, 2); }), -0.08, 1,
                 [](const Position& x) { return x[0] + x[1] - 1.0; }});
  all.push_back({"product with a cheap limit", 2, plane([](double x, double y) { return x * y; }), 0.25, 1,
                 [](const Position& x) { return x[0] + x[1] - 1.0; }, true});
  all.push_back({"bell", 2, plane([](double x, double y) {
                   return std::exp(-4.0 * std::pow(x - 0.55, 2) - 6.0 * std::pow(y - 0.4, 2));
                 }),
                 1.0});
  all.push_back({"three parameters", 3,
                 [](std::size_t, const Position& x) {
                   return 1.0 - sum_of_squares(x, {0.4, 0.55, 0.62}, {1.0, 0.5, 2.0});
                 },
                 1.0});
  all.push_back({"choice of three", 1,
                 [](std::size_t c, const Position& x) {
                   const double at[] = {0.3, 0.5, 0.8};
                   const double height[] = {0.6, 0.7, 0.65};
                   return height[c] - std::pow(x[0] - at[c], 2);
                 },
                 0.7, 3});
  all.push_back({"choice of equals", 1,
                 [](std::size_t c, const Position& x) {
                   return 0.7 - 1e-5 * static_cast<double>(c) - std::pow(x[0] - 0.2 * static_cast<double>(c + 1), 2);
                 },
                 0.7, 4});
  return all;
}

/// Returns the nearest peak within half a step of the scan, or `x` if there is none. The scan of an optimization moves
/// its points in the same way.
double at_nearest_peak(const Problem& problem, double x) {
  double best = x;
  for (const double peak : problem.peaks)
    if (std::abs(peak - x) < 0.5 / 64.0 && (best == x || std::abs(peak - x) < std::abs(best - x))) best = peak;
  return best;
}

std::vector<std::vector<SearchPoint>> scan_of(const Problem& problem) {
  std::vector<std::vector<SearchPoint>> scan;
  for (std::size_t c = 0; c < problem.combinations; ++c) {
    scan.emplace_back();
    if (problem.dimensions == 1) {
      for (int k = 0; k <= 64; ++k) scan.back().push_back({c, {at_nearest_peak(problem, k / 64.0)}});
      continue;
    }
    const int side = problem.dimensions == 2 ? 8 : 4;
    const auto count = static_cast<int>(std::pow(side, problem.dimensions));
    for (int k = 0; k < count; ++k) {
      SearchPoint point{c, {}};
      for (int rest = k, d = 0; d < static_cast<int>(problem.dimensions); ++d, rest /= side)
        point.fractions.push_back(static_cast<double>(rest % side) / (side - 1));
      scan.back().push_back(point);
    }
  }
  return scan;
}

NoisyOptimum optimum_of(const Problem& problem, double sigma, double common, std::uint64_t seed) {
  Noisy function(problem, sigma, common, seed);
  NoisySearchSettings settings;
  if (sigma == 0.0) settings.scan_scale = settings.refinement_scale = settings.last_scale = 1.0;
  return studies::search_with_noise(function, scan_of(problem), settings);
}

double loss_of(const Problem& problem, const NoisyOptimum& optimum) {
  if (!optimum.best) return 1e9;
  return problem.maximum - problem.value(optimum.best->combination, optimum.best->fractions);
}

TEST(NoisySearch, FindsTheKnownMaximumWithoutNoise) {
  for (const Problem& problem : problems()) {
    SCOPED_TRACE(problem.name);
    const NoisyOptimum optimum = optimum_of(problem, 0.0, 0.0, 1);
    ASSERT_TRUE(optimum.best.has_value());
    EXPECT_NEAR(loss_of(problem, optimum), 0.0, 1e-5);
    EXPECT_EQ(optimum.resolution, 0.0);
    EXPECT_FALSE(optimum.has_noise);
    if (problem.excess) {
      EXPECT_LE(problem.excess(optimum.best->fractions), 1e-12);
    }
  }
}

/// In 95 % of all searches with random errors, the loss must be below the reported resolution. A search with random
/// errors may make at most 1.5 times as many observations as a search without errors.
TEST(NoisySearch, StatesItsErrorForTwentyProblems) {
  constexpr int kSeeds = 25;
  const std::vector<Problem> all = problems();
  ASSERT_EQ(all.size(), 20U);
  for (const double common : {0.0, 0.9})
    for (const double sigma : {1e-4, 1e-3}) {
      int within = 0;
      for (const Problem& problem : all) {
        SCOPED_TRACE(problem.name + ", common " + std::to_string(common) + ", sigma " + std::to_string(sigma));
        const auto without_noise = static_cast<double>(optimum_of(problem, 0.0, 0.0, 1).observations);
        double observations = 0.0;
        int good = 0;
        double worst = 0.0;
        for (int seed = 1; seed <= kSeeds; ++seed) {
          const NoisyOptimum optimum = optimum_of(problem, sigma, common, static_cast<std::uint64_t>(seed));
          observations += static_cast<double>(optimum.observations) / kSeeds;
          const double loss = loss_of(problem, optimum);
          worst = std::max(worst, loss / optimum.resolution);
          good += loss <= optimum.resolution ? 1 : 0;
          EXPECT_LE(optimum.resolution, 5.0 * sigma) << "the stated error is not much larger than the noise";
          if (problem.excess && optimum.best) {
            EXPECT_LE(problem.excess(optimum.best->fractions), 0.0);
          }
        }
        EXPECT_GE(good, 20) << "of " << kSeeds << ", largest loss " << worst << " stated errors";
        EXPECT_LE(observations, 1.5 * without_noise);
        within += good;
      }
      EXPECT_GE(within, static_cast<int>(0.95 * 20 * kSeeds)) << "common " << common << ", sigma " << sigma;
      RecordProperty("within", within);
    }
}

TEST(NoisySearch, ChoosesARoundValueAmongIndistinguishableOnes) {
  const Problem flat = problems()[2];
  int round = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const NoisyOptimum optimum = optimum_of(flat, 1e-4, 0.9, seed);
    const double hundredths = 100.0 * optimum.best->fractions[0];
    round += std::abs(hundredths - std::round(hundredths)) < 1e-9 ? 1 : 0;
  }
  EXPECT_GE(round, 17) << "multiples of 0.01";
}

TEST(NoisySearch, CommonRandomNumbersMakeDifferencesAccurate) {
  std::vector<Estimate> a;
  std::vector<Estimate> b;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const double common = normal(3, k);
    a.push_back({0.5 + common, 1.0});
    b.push_back({0.4 + common + 1e-3 * normal(4, k), 1.0});
  }
  const Estimate difference = studies::paired_difference(a, b);
  EXPECT_NEAR(difference.value, 0.1, 5e-3);
  EXPECT_LT(difference.std_error, 5e-3);
  // With a single replicate, the difference has the standard error of a difference between independent values.
  const Estimate single = studies::paired_difference({{0.5, 3.0}}, {{0.4, 4.0}});
  EXPECT_DOUBLE_EQ(single.std_error, 5.0);
}

}  // namespace
}  // namespace retrace::testing::noisy_search_test
