#include "surface_models/texture_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "surface_models/autocorrelation.h"

namespace retrace::surface_models {
namespace {

/// Range of the fit in correlation lengths. Beyond it, only the waviness remains.
constexpr double kFitReach = 3.5;
constexpr double kMinFitPoints = 3.0;
/// Maximum number of distances in a fit. If there are more, every n-th distance is used.
constexpr std::size_t kMaxSamples = 20000;
/// Maximum ratio of two variances at which roughness is set to 0: the variance of the roughness map, divided by the
/// variance of the waviness that the filter leaves in this map.
constexpr double kExplained = 1.2;
/// Heights below this value are rounding errors.
constexpr double kRoundingNm = 1e-6;

/// Effect of the filter on Gaussian roughness with the correlation length l in `dimensions` dimensions. For the
/// transmission exp(-ln2 (L f)^2), all autocorrelations are Gaussians or sums of Gaussians.
class FilteredGaussian {
 public:
  FilteredGaussian(double length_um, double cutoff_um, int dimensions) : l2_(length_um * length_um), d_(dimensions) {
    const double widening = std::numbers::ln2 * cutoff_um * cutoff_um / (std::numbers::pi * std::numbers::pi);
    once_ = l2_ + widening;
    twice_ = l2_ + 2.0 * widening;
  }

  /// Returns the autocorrelation of the remaining roughness, for unit variance before the filter.
  double roughness(double distance2_um2) const {
    return std::exp(-distance2_um2 / l2_) - 2.0 * fraction(once_) * std::exp(-distance2_um2 / once_) +
           fraction(twice_) * std::exp(-distance2_um2 / twice_);
  }
  /// Returns the variance that passes into the waviness.
  double waviness() const { return fraction(twice_); }
  /// Returns the mean square gradient of the roughness that passes into the waviness, per um^2.
  double waviness_gradient() const { return 2.0 * d_ * fraction(twice_) / twice_; }
  /// Returns the correlation length of the roughness that passes into the waviness.
  double waviness_length_um() const { return std::sqrt(twice_); }

 private:
  double fraction(double wide) const { return d_ == 1 ? std::sqrt(l2_ / wide) : l2_ / wide; }
  double l2_;
  double d_;
  double once_ = 0.0;
  double twice_ = 0.0;
};

struct Sample {
  double distance2_um2 = 0.0;
  double roughness_nm2 = 0.0;
  double waviness = 0.0;  ///< relative to its value at distance 0
};

/// Returns the autocorrelations of roughness and waviness at the same distances within a circle.
std::vector<Sample> samples_within(const Autocorrelation& roughness, const Autocorrelation& waviness, double reach_um) {
  std::vector<Sample> samples;
  const double scale = waviness.variance_nm2() > 0.0 ? 1.0 / waviness.variance_nm2() : 0.0;
  const auto most_dy = static_cast<std::ptrdiff_t>(roughness.y_lags) - 1;
  for (std::ptrdiff_t dy = -most_dy; dy <= most_dy; ++dy)
    for (std::size_t dx = 0; dx < roughness.x_lags; ++dx) {
      const double x = static_cast<double>(dx) * roughness.x_pixel_um;
      const double y = static_cast<double>(dy) * roughness.y_pixel_um;
      // Distances along -x equal those along x rotated by 180 degrees, so they are omitted.
      if ((dx == 0 && dy < 0) || x * x + y * y > reach_um * reach_um || !std::isfinite(roughness.at(dx, dy))) continue;
      samples.push_back({x * x + y * y, roughness.at(dx, dy), scale * waviness.at(dx, dy)});
    }
  if (samples.size() <= kMaxSamples) return samples;
  const std::size_t stride = samples.size() / kMaxSamples + 1;
  std::vector<Sample> fewer;
  for (std::size_t i = 0; i < samples.size(); i += stride) fewer.push_back(samples[i]);
  return fewer;
}

/// Fit of the autocorrelation of the roughness map. The fit is the sum of two autocorrelations: that of
/// FilteredGaussian, and that of the waviness that the filter left. The second has the shape of the autocorrelation of
/// the waviness map.
struct Fit {
  double length_um = 0.0;
  double variance_nm2 = 0.0;  ///< variance of the roughness before the filter
  double waviness_nm2 = 0.0;  ///< variance of the remaining waviness, >= 0
  double squares = 0.0;
};

Fit fit_at(double length_um, const std::vector<Sample>& samples, double cutoff_um, int dimensions) {
  const FilteredGaussian model(length_um, cutoff_um, dimensions);
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Sample& s : samples) {
    const Eigen::Vector2d row(model.roughness(s.distance2_um2), s.waviness);
    normal += row * row.transpose();
    right += row * s.roughness_nm2;
  }
  Eigen::Vector2d solution = normal.completeOrthogonalDecomposition().solve(right);
  if (solution[1] < 0.0) solution = {right[0] / normal(0, 0), 0.0};
  Fit fit{length_um, solution[0], solution[1], 0.0};
  for (const Sample& s : samples) {
    const double d = solution[0] * model.roughness(s.distance2_um2) + solution[1] * s.waviness - s.roughness_nm2;
    fit.squares += d * d;
  }
  return fit;
}

/// Returns a first estimate of the correlation length: the geometric mean of the 1/e lengths along both axes.
std::optional<double> rough_length_um(const Autocorrelation& r, int dimensions) {
  const std::optional<double> x = correlation_length_um(r, Axis::x);
  if (dimensions == 1) return x;
  const std::optional<double> y = correlation_length_um(r, Axis::y);
  // Along a lay (preferred direction of the texture), heights may be correlated over the whole map. The correlation
  // length along this axis is then undefined, and only the length along the other axis is used.
  if (!x || !y) return x ? x : y;
  return std::sqrt(*x * *y);
}

/// Fits the roughness model.
/// \param first_um first estimate of the correlation length
Fit fit_roughness(const Autocorrelation& roughness, const Autocorrelation& waviness, double first_um, double cutoff_um,
                  int dimensions) {
  const double coarser = dimensions == 1 ? roughness.x_pixel_um : std::max(roughness.x_pixel_um, roughness.y_pixel_um);
  const double reach = std::max(kFitReach * first_um, kMinFitPoints * coarser);
  const std::vector<Sample> samples = samples_within(roughness, waviness, reach);
  const auto squares = [&](double log_length) {
    return fit_at(std::exp(log_length), samples, cutoff_um, dimensions).squares;
  };
  const auto [log_length, unused] =
      boost::math::tools::brent_find_minima(squares, std::log(0.3 * first_um), std::log(3.0 * first_um), 40);
  return fit_at(std::exp(log_length), samples, cutoff_um, dimensions);
}

/// Mean squares of the heights relative to their mean (nm^2) and of their gradients (nm^2/um^2).
struct MeanSquares {
  double height = 0.0;
  double gradient = 0.0;
};

/// Returns mean squares with a Hann window along both axes, which reduces the influence of an incomplete wave at the
/// border.
MeanSquares windowed_squares(const HeightMap& map) {
  const auto hann = [](std::size_t i, std::size_t points) {
    const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points));
    return points > 1 ? s * s * s * s : 1.0;  // the window applies to the power and is therefore squared
  };
  std::vector<double> wx(map.columns);
  std::vector<double> wy(map.rows);
  for (std::size_t i = 0; i < map.columns; ++i) wx[i] = hann(i, map.columns);
  for (std::size_t j = 0; j < map.rows; ++j) wy[j] = hann(j, map.rows);
  /// Returns the mean of value(column, row) over the grid without a margin of dx and dy points at its borders.
  const auto mean = [&](std::size_t dx, std::size_t dy, const auto& value) {
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t j = dy; j + dy < map.rows; ++j)
      for (std::size_t i = dx; i + dx < map.columns; ++i) {
        const double v = value(i, j);
        if (!std::isfinite(v)) continue;
        sum += wx[i] * wy[j] * v;
        weight += wx[i] * wy[j];
      }
    return weight > 0.0 ? sum / weight : 0.0;
  };
  const double middle = mean(0, 0, [&](std::size_t i, std::size_t j) { return map.at(i, j); });
  const auto slope_squares = [&](std::size_t dx, std::size_t dy, double pixel_um) {
    return mean(dx, dy, [&](std::size_t i, std::size_t j) {
      const double slope = (map.at(i + dx, j + dy) - map.at(i - dx, j - dy)) / (2.0 * pixel_um);
      return slope * slope;
    });
  };
  MeanSquares squares;
  squares.height =
      mean(0, 0, [&](std::size_t i, std::size_t j) { return (map.at(i, j) - middle) * (map.at(i, j) - middle); });
  squares.gradient = slope_squares(1, 0, map.x_pixel_um);
  if (!map.is_profile()) squares.gradient += slope_squares(0, 1, map.y_pixel_um);
  return squares;
}

/// Returns the map without a margin of half a cut-off at its borders. In this margin, the fraction of a wave's
/// amplitude that passes the filter differs from that in the interior. Along an axis that is shorter than three
/// cut-offs, no margin is removed. If the result would have fewer than two measured points, the whole map is returned.
HeightMap inner(const HeightMap& map, double cutoff_um) {
  const auto margin = [&](std::size_t points, double pixel_um) {
    return static_cast<double>(points) * pixel_um >= 3.0 * cutoff_um ? 0.5 * cutoff_um : 0.0;
  };
  HeightMap result = cropped(map, margin(map.columns, map.x_pixel_um), margin(map.rows, map.y_pixel_um));
  return measured_points(result) > 1 ? result : map;
}

/// Returns twice the standard error of the variance of a Gaussian texture that is measured on this map, relative to the
/// variance.
/// \param length_um correlation length of the texture
double doubt(const HeightMap& map, double length_um) {
  const double x = static_cast<double>(map.columns) * map.x_pixel_um;
  const double y = static_cast<double>(map.rows) * map.y_pixel_um;
  const double cell = length_um * std::sqrt(0.5 * std::numbers::pi);
  const double independent = std::max(1.0, x / cell) * (map.is_profile() ? 1.0 : std::max(1.0, y / cell));
  return 2.0 * std::sqrt(2.0 / independent);
}

/// Sets the waviness of the model to that of the waviness map, minus the roughness that passed the filter.
/// \param fit fit of the roughness; without it, no roughness is subtracted
void set_waviness(TextureModel& model, const HeightMap& waviness, const std::optional<Fit>& fit, double cutoff_um) {
  model.waviness_sq_nm = 0.0;
  model.waviness_length_um.reset();
  auto [variance, gradient] = windowed_squares(waviness);
  if (fit) {
    const FilteredGaussian passed(fit->length_um, cutoff_um, waviness.dimensions());
    const double roughness_nm2 = model.roughness_sq_nm * model.roughness_sq_nm;
    const double passed_nm2 = roughness_nm2 * passed.waviness();
    variance -= passed_nm2;
    gradient -= roughness_nm2 * passed.waviness_gradient();
    if (variance <= doubt(waviness, passed.waviness_length_um()) * passed_nm2) return;
  }
  if (variance <= kRoundingNm * kRoundingNm) return;
  // The period is limited to the range from the cut-off to twice the size of the map. Longer waves cannot be
  // distinguished from form, and shorter waves are roughness.
  const double extent = std::max(static_cast<double>(waviness.columns) * waviness.x_pixel_um,
                                 static_cast<double>(waviness.rows) * waviness.y_pixel_um);
  const double frequency = std::clamp(std::sqrt(std::max(0.0, gradient) / variance) / (2.0 * std::numbers::pi),
                                      std::min(0.5 / extent, 1.0 / cutoff_um), 1.0 / cutoff_um);
  model.waviness_sq_nm = std::sqrt(variance) / gaussian_transmission(frequency, cutoff_um);
  model.waviness_length_um = 1.0 / frequency;
}

/// Returns the variance that the model's waviness has in the roughness map, because the filter does not remove it
/// completely.
double waviness_left_nm2(const TextureModel& model, double cutoff_um) {
  if (!model.waviness_length_um) return 0.0;
  const double left = model.waviness_sq_nm * (1.0 - gaussian_transmission(1.0 / *model.waviness_length_um, cutoff_um));
  return left * left;
}

/// Returns the autocorrelation of the roughness map minus that of the remaining waviness.
Autocorrelation without_waviness(Autocorrelation roughness, const Autocorrelation& waviness, double left_nm2) {
  if (left_nm2 > 0.0)
    for (std::size_t i = 0; i < roughness.values_nm2.size(); ++i)
      roughness.values_nm2[i] -= left_nm2 / waviness.variance_nm2() * waviness.values_nm2[i];
  return roughness;
}

}  // namespace

TextureModel texture_model(const Split& split, double cutoff_um) {
  const HeightMap roughness = inner(split.roughness, cutoff_um);
  const HeightMap waviness = inner(split.waviness, cutoff_um);
  const Autocorrelation of_roughness = autocorrelation(roughness, cutoff_um);
  const Autocorrelation of_waviness = autocorrelation(waviness, cutoff_um);
  const double variance = of_roughness.variance_nm2();
  const int dimensions = roughness.dimensions();

  // First estimate: all waviness in the waviness map is assumed to have a single period, and no roughness is assumed to
  // have passed the filter.
  TextureModel model;
  set_waviness(model, waviness, std::nullopt, cutoff_um);
  const double left = waviness_left_nm2(model, cutoff_um);
  if (variance <= kExplained * left + kRoundingNm * kRoundingNm) return model;
  model.roughness_sq_nm = std::sqrt(variance - left);
  const std::optional<double> first = rough_length_um(without_waviness(of_roughness, of_waviness, left), dimensions);
  if (!first) return model;

  // Refined estimate: the roughness is fitted twice, starting with the first estimate of the correlation length and
  // then with the length of the first fit.
  Fit fit = fit_roughness(of_roughness, of_waviness, *first, cutoff_um, dimensions);
  fit = fit_roughness(of_roughness, of_waviness, fit.length_um, cutoff_um, dimensions);
  // The measured variance is used instead of the fitted one, because it is also correct for autocorrelations of other
  // shapes.
  const FilteredGaussian filtered(fit.length_um, cutoff_um, dimensions);
  model.roughness_sq_nm = std::sqrt(std::max(0.0, variance - fit.waviness_nm2) / filtered.roughness(0.0));
  model.correlation_length_um = fit.length_um;
  set_waviness(model, waviness, fit, cutoff_um);
  return model;
}

}  // namespace retrace::surface_models
