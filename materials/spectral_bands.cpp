#include "materials/spectral_bands.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace retrace::materials {
namespace {

constexpr std::size_t kIntervalsOfBand = 64;

/// Flux below a wavelength, as a piecewise linear function. The flux of a sample is spread evenly between the midpoints
/// to its neighbours.
class FluxBelow {
 public:
  explicit FluxBelow(const Spectrum& flux) {
    const std::vector<double>& at = flux.wavelengths_nm;
    edges_nm_.push_back(at.front());
    for (std::size_t k = 1; k < at.size(); ++k) edges_nm_.push_back(0.5 * (at[k - 1] + at[k]));
    edges_nm_.push_back(at.back());
    sums_.push_back(0.0);
    for (const double weight : flux.weights) sums_.push_back(sums_.back() + weight);
  }

  /// Returns the wavelength below which the given fraction of the flux lies.
  double wavelength_nm(double fraction) const {
    const double flux = std::clamp(fraction, 0.0, 1.0) * sums_.back();
    const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, flux);
    const auto k = static_cast<std::size_t>(above - sums_.begin());
    const double within = sums_[k] > sums_[k - 1] ? (flux - sums_[k - 1]) / (sums_[k] - sums_[k - 1]) : 0.0;
    return std::lerp(edges_nm_[k - 1], edges_nm_[k], std::min(1.0, within));
  }

 private:
  std::vector<double> edges_nm_, sums_;
};

}  // namespace

std::vector<std::vector<double>> spectral_bands(const Spectrum& traced, const Spectrum& flux) {
  const FluxBelow below(flux);
  const double all = std::accumulate(traced.weights.begin(), traced.weights.end(), 0.0);
  std::vector<std::vector<double>> bands;
  double first = 0.0;
  for (const double weight : traced.weights) {
    std::vector<double>& band = bands.emplace_back();
    for (std::size_t k = 0; k <= kIntervalsOfBand; ++k)
      band.push_back(
          below.wavelength_nm((first + weight * static_cast<double>(k) / static_cast<double>(kIntervalsOfBand)) / all));
    first += weight;
  }
  return bands;
}

}  // namespace retrace::materials
