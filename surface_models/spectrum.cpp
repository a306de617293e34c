#include "surface_models/spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/length_units.h"
#include "surface_models/fft.h"
#include "surface_models/height_parameters.h"

namespace retrace::surface_models {
namespace {

constexpr std::size_t kMinPoints = 8;
/// Criteria for a peak: ratio of its density to the median of its surroundings, and height above it in median
/// deviations. In the spectrum of a single line of noise, the densities have an exponential distribution. They exceed
/// 35 deviations with a probability of 1 in 2e7. The mean over many lines scatters less, so weaker peaks are detected.
constexpr double kPeakHeight = 3.0;
constexpr double kPeakDeviations = 35.0;
constexpr double kMinRelativePeakPower = 0.01;
/// kLobe is the number of bins on each side that the main lobe of a Hann window occupies. kSurroundings is the number
/// of further bins on each side with which a peak is compared.
constexpr std::size_t kLobe = 2;
constexpr std::size_t kSurroundings = 12;

/// Returns the periodic Hann window, sampled at the centres of the intervals. No sample is 0.
std::vector<double> hann(std::size_t points) {
  std::vector<double> w(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points));
    w[i] = s * s;
  }
  return w;
}

/// Writes the values `at(i)`, minus their weighted mean and times the window, to the field. Missing points become 0.
/// \return sum of the squared weights of measured points, or 0 if less than half of the points are measured
template <class At>
double put_windowed(std::span<double> field, const std::vector<double>& window, At at) {
  double sum = 0.0;
  double weight = 0.0;
  double squares = 0.0;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double z = at(i);
    if (!std::isfinite(z)) continue;
    ++measured;
    sum += window[i] * z;
    weight += window[i];
    squares += window[i] * window[i];
  }
  if (2 * measured < window.size()) return 0.0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double z = at(i);
    field[i] = std::isfinite(z) ? window[i] * (z - sum / weight) : 0.0;
  }
  return squares;
}

/// Densities around a bin, compared with the line through the medians of the densities on both sides. The bins that the
/// main lobe of the bin's own peak occupies are excluded.
struct Surroundings {
  double middle = 0.0;     ///< value of the line at the bin
  double deviation = 0.0;  ///< median deviation from the line
};

Surroundings surroundings(const std::vector<double>& density, std::size_t k) {
  const std::size_t low = k > kSurroundings + kLobe ? k - kSurroundings - kLobe : 0;
  const std::size_t high = std::min(density.size(), k + kSurroundings + kLobe + 1);
  std::vector<double> below;
  std::vector<double> above;
  for (std::size_t i = low; i + kLobe < k; ++i) below.push_back(density[i]);
  for (std::size_t i = k + kLobe + 1; i < high; ++i) above.push_back(density[i]);
  if (below.empty() && above.empty()) return {};
  const double left = median(below.empty() ? above : below);
  const double right = median(above.empty() ? below : above);
  // The median of a side is assigned to the centre of this side.
  const double slope = (right - left) / static_cast<double>(kSurroundings + 2 * kLobe + 1);
  const double middle = 0.5 * (left + right);
  std::vector<double> deviations;
  for (std::size_t i = low; i < high; ++i)
    if (i + kLobe < k || i > k + kLobe)
      deviations.push_back(std::abs(density[i] - middle - slope * (static_cast<double>(i) - static_cast<double>(k))));
  return {middle, median(std::move(deviations))};
}

bool is_highest_in_its_lobe(const std::vector<double>& density, std::size_t k) {
  for (std::size_t i = k > kLobe ? k - kLobe : 0; i < std::min(density.size(), k + kLobe + 1); ++i)
    if (density[i] > density[k] || (density[i] == density[k] && i < k)) return false;
  return true;
}

/// Returns the position of a spectral line between the bins. With a Hann window, the amplitudes a and b of the two
/// highest bins determine the offset: (2 b - a) / (a + b) (Grandke, IEEE Trans. Instrum. Meas. 32, 350, 1983).
double offset_of(const std::vector<double>& density, std::size_t k, double floor) {
  const auto line = [&](std::size_t i) { return std::max(0.0, density[i] - floor); };
  const double below = k > 0 ? line(k - 1) : 0.0;
  const double above = k + 1 < density.size() ? line(k + 1) : 0.0;
  const double ratio = std::sqrt(std::max(below, above) / line(k));
  const double offset = std::clamp((2.0 * ratio - 1.0) / (1.0 + ratio), 0.0, 0.5);
  return above >= below ? offset : -offset;
}

}  // namespace

Spectrum line_spectrum(const HeightMap& map, Axis axis) {
  const bool along_x = axis == Axis::x;
  const std::size_t points = along_x ? map.columns : map.rows;
  const std::size_t lines = along_x ? map.rows : map.columns;
  const double pixel_mm = (along_x ? map.x_pixel_um : map.y_pixel_um) * kMmPerUm;
  if (points < kMinPoints) return {};

  const std::vector<double> window = hann(points);
  RealFft fft(1, points);
  std::vector<double> sum(fft.spectrum_columns(), 0.0);
  std::size_t used = 0;
  for (std::size_t line = 0; line < lines; ++line) {
    const double squares =
        put_windowed(fft.field(), window, [&](std::size_t i) { return along_x ? map.at(i, line) : map.at(line, i); });
    if (squares == 0.0) continue;
    fft.forward();
    ++used;
    for (std::size_t k = 1; k < sum.size(); ++k) sum[k] += std::norm(fft.spectrum()[k]) * pixel_mm / squares;
  }
  Spectrum spectrum;
  if (used == 0) return spectrum;
  for (std::size_t k = 1; k < sum.size(); ++k) {
    spectrum.frequency_per_mm.push_back(static_cast<double>(k) / (static_cast<double>(points) * pixel_mm));
    // Positive and negative frequencies are combined. If the number of points is even, the highest frequency occurs
    // only once.
    const double sides = 2 * k == points ? 1.0 : 2.0;
    spectrum.density.push_back(sides * sum[k] / static_cast<double>(used));
  }
  return spectrum;
}

Spectrum radial_spectrum(const HeightMap& map) {
  if (std::min(map.columns, map.rows) < kMinPoints) return {};
  const std::vector<double> wx = hann(map.columns);
  const std::vector<double> wy = hann(map.rows);
  std::vector<double> window;
  window.reserve(map.heights_nm.size());
  for (const double y : wy)
    for (const double x : wx) window.push_back(x * y);
  RealFft fft(map.rows, map.columns);
  const double squares = put_windowed(fft.field(), window, [&](std::size_t i) { return map.heights_nm[i]; });
  if (squares == 0.0) return {};
  fft.forward();

  const double dx_mm = map.x_pixel_um * kMmPerUm;
  const double dy_mm = map.y_pixel_um * kMmPerUm;
  const double fx = 1.0 / (static_cast<double>(map.columns) * dx_mm);
  const double fy = 1.0 / (static_cast<double>(map.rows) * dy_mm);
  const double ring = std::min(fx, fy);
  // Rings beyond the lower of the two highest frequencies would be incomplete.
  const auto rings = static_cast<std::size_t>(0.5 / std::max(dx_mm, dy_mm) / ring);
  std::vector<double> sum(rings + 1, 0.0);
  std::vector<double> count(rings + 1, 0.0);
  for (std::size_t j = 0; j < fft.rows(); ++j)
    for (std::size_t k = 0; k < fft.spectrum_columns(); ++k) {
      const double v = static_cast<double>(std::min(j, fft.rows() - j)) * fy;
      const auto r = static_cast<std::size_t>(std::lround(std::hypot(static_cast<double>(k) * fx, v) / ring));
      if (r > rings) continue;
      sum[r] += std::norm(fft.spectrum()[j * fft.spectrum_columns() + k]) * dx_mm * dy_mm / squares;
      count[r] += 1.0;
    }
  Spectrum spectrum;
  for (std::size_t r = 1; r <= rings; ++r) {
    spectrum.frequency_per_mm.push_back(static_cast<double>(r) * ring);
    spectrum.density.push_back(sum[r] / count[r]);
  }
  return spectrum;
}

std::vector<SpectralPeak> peaks_of(const Spectrum& spectrum, Axis axis) {
  std::vector<SpectralPeak> peaks;
  if (spectrum.density.empty()) return peaks;
  const double step = spectrum.frequency_per_mm.front();
  for (std::size_t k = 0; k < spectrum.density.size(); ++k) {
    if (!is_highest_in_its_lobe(spectrum.density, k)) continue;
    const auto [floor, deviation] = surroundings(spectrum.density, k);
    if (!(spectrum.density[k] > std::max(kPeakHeight * floor, floor + kPeakDeviations * deviation))) continue;
    double power = 0.0;
    for (std::size_t i = k > kLobe ? k - kLobe : 0; i < std::min(spectrum.density.size(), k + kLobe + 1); ++i)
      power += std::max(0.0, spectrum.density[i] - floor) * step;
    const double frequency = spectrum.frequency_per_mm[k] + offset_of(spectrum.density, k, floor) * step;
    peaks.push_back({axis, frequency, std::sqrt(power)});
  }
  return peaks;
}

std::vector<SpectralPeak> dominant_peaks(const HeightMap& map) {
  std::vector<SpectralPeak> peaks;
  for (const Axis axis : {Axis::x, Axis::y})
    for (const SpectralPeak& peak : peaks_of(line_spectrum(map, axis), axis)) peaks.push_back(peak);
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const SpectralPeak& a, const SpectralPeak& b) { return a.sq_nm > b.sq_nm; });
  std::erase_if(peaks, [&](const SpectralPeak& peak) {
    return peak.sq_nm * peak.sq_nm < kMinRelativePeakPower * peaks.front().sq_nm * peaks.front().sq_nm;
  });
  if (peaks.size() > kMaxPeaks) peaks.resize(kMaxPeaks);
  return peaks;
}

}  // namespace retrace::surface_models
