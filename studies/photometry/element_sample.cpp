#include "studies/photometry/element_sample.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "geometry/polygon.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, raytrace::ElementPortion;

// Fraction of the samples that is reserved for elements near the border.
constexpr double kBorderFraction = 0.4;
// Increments of a three-dimensional additive sequence of low discrepancy. They are the powers 1, 2 and 3 of 1 / x,
// where x is the positive root of x^4 = x + 1 (M. Roberts, 2018).
constexpr std::array<double, 3> kSequence = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
// Minimum number of samples for each term of the fitted polynomial.
constexpr std::size_t kSamplesPerTerm = 3;

double fraction_of(double value) {
  return value - std::floor(value);
}

/// Position, wavelength and relative portion (`fullness`) of an element, each mapped to the range -1 to 1.
struct Coordinates {
  double x = 0.0, y = 0.0, wavelength = 0.0, fullness = 0.0;
};

/// Returns the values of the polynomial's terms. A small number of samples restricts the polynomial to terms of low
/// degree, which come first.
Eigen::VectorXd terms_at(const Coordinates& at, bool is_border, std::size_t samples) {
  const auto& [x, y, u, f] = at;
  const std::vector<double> terms =
      is_border
          ? std::vector<double>{1.0, f, u, x, y, f * f, x * x, x * y, y * y, f * x, f * y}
          : std::vector<double>{
                1.0,   u,         x,         y,         x * x,     x * y,         y * y,         u * u,        u * x,
                u * y, x * x * x, x * x * y, x * y * y, y * y * y, x * x * x * x, x * x * y * y, y * y * y * y};
  const std::size_t count = std::clamp<std::size_t>(samples / kSamplesPerTerm, 1, terms.size());
  return Eigen::Map<const Eigen::VectorXd>(terms.data(), static_cast<Eigen::Index>(count));
}

/// Maps elements and wavelengths to Coordinates.
class Scale {
 public:
  Scale(const std::vector<ElementPortion>& portions, const std::vector<std::size_t>& elements, std::size_t wavelengths)
      : portions_(portions), wavelengths_(wavelengths) {
    lower_.setConstant(INFINITY);
    upper_.setConstant(-INFINITY);
    for (const std::size_t k : elements) {
      lower_ = lower_.cwiseMin(portions[k].at_mm);
      upper_ = upper_.cwiseMax(portions[k].at_mm);
      largest_ = std::max(largest_, portions[k].fraction);
    }
  }

  Coordinates at(std::size_t element, std::size_t wavelength) const {
    const Vec2 place = 2.0 * (portions_[element].at_mm - lower_).cwiseQuotient(size()) - Vec2::Ones();
    const double u =
        wavelengths_ > 1 ? 2.0 * static_cast<double>(wavelength) / static_cast<double>(wavelengths_ - 1) - 1.0 : 0.0;
    return {place.x(), place.y(), u, 2.0 * fullness(element) - 1.0};
  }
  /// Returns the portion of an element, divided by the largest portion.
  double fullness(std::size_t element) const { return portions_[element].fraction / largest_; }
  /// Returns a position in the bounding box of the elements, from two fractions between 0 and 1.
  Vec2 position(double u, double v) const { return lower_ + Vec2(u, v).cwiseProduct(upper_ - lower_); }

 private:
  Vec2 size() const { return (upper_ - lower_).cwiseMax(1e-9); }

  const std::vector<ElementPortion>& portions_;
  std::size_t wavelengths_;
  Vec2 lower_;
  Vec2 upper_;
  double largest_ = 0.0;
};

}  // namespace

ElementSample::ElementSample(const std::vector<ElementPortion>& portions, const std::vector<double>& weights,
                             std::size_t max_count) {
  std::array<std::vector<std::size_t>, 2> strata;
  for (std::size_t k = 0; k < portions.size(); ++k)
    if (portions[k].fraction > 0.0) strata[portions[k].is_at_border ? 1 : 0].push_back(k);
  const auto border = static_cast<std::size_t>(kBorderFraction * static_cast<double>(max_count));
  const std::array<std::size_t, 2> wanted = {strata[0].size() * weights.size(), strata[1].size() * weights.size()};
  // If one stratum needs fewer samples, the other stratum gets the remaining ones.
  const std::size_t of_border = std::min(wanted[1], std::max(border, max_count - std::min(max_count, wanted[0])));
  add_stratum(portions, weights, strata[0], max_count - of_border);
  add_stratum(portions, weights, strata[1], of_border);
}

void ElementSample::add_stratum(const std::vector<ElementPortion>& portions, const std::vector<double>& weights,
                                const std::vector<std::size_t>& elements, std::size_t max_count) {
  if (elements.empty()) return;
  Stratum stratum;
  stratum.first = samples_.size();
  if (elements.size() * weights.size() <= max_count) {
    for (const std::size_t element : elements)
      for (std::size_t w = 0; w < weights.size(); ++w)
        samples_.push_back({element, w, portions[element].fraction * weights[w]});
    stratum.count = samples_.size() - stratum.first;
    strata_.push_back(std::move(stratum));
    return;
  }
  const Scale scale(portions, elements, weights.size());
  const double all_weights = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  for (std::size_t k = 0; chosen.size() < max_count && k < 8 * max_count; ++k) {
    std::array<double, 3> u;
    for (std::size_t axis = 0; axis < 3; ++axis) u[axis] = fraction_of(0.5 + static_cast<double>(k) * kSequence[axis]);
    const Vec2 place = scale.position(u[0], u[1]);
    std::size_t wavelength = 0;
    for (double sum = weights[0]; wavelength + 1 < weights.size() && sum < u[2] * all_weights;)
      sum += weights[++wavelength];
    const auto nearest = std::min_element(elements.begin(), elements.end(), [&](std::size_t a, std::size_t b) {
      return (portions[a].at_mm - place).squaredNorm() < (portions[b].at_mm - place).squaredNorm();
    });
    if (chosen.emplace(*nearest, wavelength).second) samples_.push_back({*nearest, wavelength, 0.0});
  }
  stratum.count = samples_.size() - stratum.first;
  const bool is_border = portions[elements.front()].is_at_border;
  const auto terms = [&](std::size_t element, std::size_t wavelength) {
    return terms_at(scale.at(element, wavelength), is_border, stratum.count);
  };
  Eigen::VectorXd sums;
  for (const std::size_t element : elements) {
    for (std::size_t w = 0; w < weights.size(); ++w) {
      const Eigen::VectorXd own = portions[element].fraction * weights[w] * terms(element, w);
      if (sums.size() == 0)
        sums = own;
      else
        sums += own;
    }
    // The deviations of one element from the polynomial are assumed to be equal at all wavelengths.
    stratum.deviations += std::pow(portions[element].fraction * all_weights / scale.fullness(element), 2.0);
  }
  stratum.powers.resize(static_cast<Eigen::Index>(stratum.count), sums.size());
  stratum.fractions.resize(static_cast<Eigen::Index>(stratum.count));
  // Each sample is weighted with the light on its element, because readings of elements with little light deviate more.
  for (std::size_t k = 0; k < stratum.count; ++k) {
    const SampledElement& sample = samples_[stratum.first + k];
    const auto row = static_cast<Eigen::Index>(k);
    stratum.fractions[row] = scale.fullness(sample.element);
    stratum.powers.row(row) = stratum.fractions[row] * terms(sample.element, sample.wavelength).transpose();
  }
  stratum.inverse = stratum.powers.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::VectorXd own_weights = stratum.fractions.cwiseProduct(stratum.inverse.transpose() * sums);
  for (std::size_t k = 0; k < stratum.count; ++k)
    samples_[stratum.first + k].weight = own_weights[static_cast<Eigen::Index>(k)];
  strata_.push_back(std::move(stratum));
}

SampledSum ElementSample::sum(const std::vector<double>& readings) const {
  SampledSum sum;
  double variance = 0.0;
  for (const Stratum& stratum : strata_) {
    const auto count = static_cast<Eigen::Index>(stratum.count);
    Eigen::VectorXd own(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t index = stratum.first + static_cast<std::size_t>(k);
      own[k] = readings[index];
      sum.value += samples_[index].weight * readings[index];
    }
    if (stratum.powers.size() == 0) continue;
    own = own.cwiseProduct(stratum.fractions);
    const double squares = (own - stratum.powers * (stratum.inverse * own)).squaredNorm();
    const double degrees = std::max(1.0, static_cast<double>(stratum.powers.rows() - stratum.powers.cols()));
    double squared_weights = 0.0;
    for (Eigen::Index k = 0; k < count; ++k)
      squared_weights +=
          std::pow(samples_[stratum.first + static_cast<std::size_t>(k)].weight / stratum.fractions[k], 2.0);
    variance += squares / degrees * (squared_weights + stratum.deviations);
  }
  sum.std_error = std::sqrt(variance);
  return sum;
}

}  // namespace retrace::studies
