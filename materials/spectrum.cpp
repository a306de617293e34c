#include "materials/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace retrace::materials {
namespace {

/// Minimum fraction of the flux that is not ignored. Smaller fractions have no visible effect on a mean, but would make
/// the recurrence ill-conditioned.
constexpr double kMinFraction = 1e-15;

/// Returns the fluxes divided by their sum.
/// \throw InputError if all `fluxes` are 0
Spectrum normalised(const std::vector<double>& wavelengths_nm, const std::vector<double>& fluxes, bool is_luminous) {
  const double largest = *std::max_element(fluxes.begin(), fluxes.end());
  if (!(largest > 0.0))
    throw InputError(is_luminous ? "the spectrum contains no visible light (380 to 780 nm); use weighting = "
                                   "\"radiant\" to count all wavelengths by their power"
                                 : "the spectrum has no power at any wavelength");
  Spectrum spectrum;
  for (std::size_t k = 0; k < fluxes.size(); ++k) {
    const double weight = fluxes[k] / largest;
    if (weight < kMinFraction) continue;
    spectrum.wavelengths_nm.push_back(wavelengths_nm[k]);
    spectrum.weights.push_back(weight);
  }
  const double total = std::accumulate(spectrum.weights.begin(), spectrum.weights.end(), 0.0);
  for (double& weight : spectrum.weights) weight /= total;
  return spectrum;
}

double efficiency_at(const SpectralCurve* efficiency, double wavelength_nm) {
  return efficiency != nullptr ? efficiency->at(wavelength_nm) : 1.0;
}

/// Returns the given wavelengths and the multiples of 5 nm between them. The CIE tables use these multiples.
std::vector<double> refined(const std::vector<double>& given_nm) {
  constexpr double kStepNm = 5.0;
  std::vector<double> all = given_nm;
  for (double w = kStepNm * std::ceil(given_nm.front() / kStepNm); w < given_nm.back(); w += kStepNm) all.push_back(w);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Coefficients alpha and sqrt(beta) of the recurrence of the polynomials that are orthonormal for the points x and
/// their weights.
struct Recurrence {
  Eigen::VectorXd diagonal;
  Eigen::VectorXd off_diagonal;
};

Recurrence stieltjes(const Eigen::ArrayXd& x, const Eigen::ArrayXd& weights, Eigen::Index count) {
  Recurrence r{Eigen::VectorXd(count), Eigen::VectorXd(count - 1)};
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(x.size());
  Eigen::ArrayXd current = Eigen::ArrayXd::Constant(x.size(), 1.0 / std::sqrt(weights.sum()));
  double norm = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    r.diagonal[k] = (weights * x * current.square()).sum();
    if (k + 1 == count) break;
    const Eigen::ArrayXd next = (x - r.diagonal[k]) * current - norm * before;
    norm = std::sqrt((weights * next.square()).sum());
    r.off_diagonal[k] = norm;
    before = current;
    current = next / norm;
  }
  return r;
}

/// Appends the nodes of one span, which has the fraction `share` of the flux. The first node may equal the last node of
/// the previous span.
void append(Spectrum& rule, const Spectrum& nodes, double share) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (rule.size() == 0 || nodes.wavelengths_nm[k] > rule.wavelengths_nm.back()) {
      rule.wavelengths_nm.push_back(nodes.wavelengths_nm[k]);
      rule.weights.push_back(0.0);
    }
    rule.weights.back() += share * nodes.weights[k];
  }
}

/// Returns the power of two that scales the largest power to about 1. Sums then stay finite for any unit.
double exact_scale(double largest) {
  constexpr int most = 1000;  // limit for very small numbers, for which the power of two would not be finite
  return largest > 0.0 ? std::ldexp(1.0, std::min(most, -std::ilogb(largest))) : 1.0;
}

}  // namespace

double SpectralCurve::at(double wavelength_nm) const {
  if (wavelengths_nm.empty() || wavelength_nm < wavelengths_nm.front() || wavelength_nm > wavelengths_nm.back())
    return 0.0;
  const auto above = std::lower_bound(wavelengths_nm.begin(), wavelengths_nm.end(), wavelength_nm);
  const auto k = static_cast<std::size_t>(above - wavelengths_nm.begin());
  if (wavelengths_nm[k] == wavelength_nm) return values[k];
  const double t = (wavelength_nm - wavelengths_nm[k - 1]) / (wavelengths_nm[k] - wavelengths_nm[k - 1]);
  return std::lerp(values[k - 1], values[k], t);
}

double Spectrum::centroid_nm() const {
  return std::inner_product(weights.begin(), weights.end(), wavelengths_nm.begin(), 0.0);
}

Spectrum monochromatic(double wavelength_nm) {
  return {{wavelength_nm}, {1.0}};
}

Spectrum resolved_spectrum(const SpectralCurve& power, const SpectralCurve* efficiency) {
  const std::vector<double> w = refined(power.wavelengths_nm);
  const double scale = exact_scale(*std::ranges::max_element(power.values));
  std::vector<double> fluxes(w.size());
  for (std::size_t k = 0; k < w.size(); ++k) {
    const double width_nm = 0.5 * (w[std::min(k + 1, w.size() - 1)] - w[k > 0 ? k - 1 : 0]);
    fluxes[k] = width_nm * (scale * power.at(w[k])) * efficiency_at(efficiency, w[k]);
  }
  return normalised(w, fluxes, efficiency != nullptr);
}

Spectrum line_spectrum(const std::vector<SpectralLine>& lines, const SpectralCurve* efficiency) {
  std::vector<double> wavelengths_nm;
  std::vector<double> fluxes;
  const double scale = exact_scale(std::ranges::max_element(lines, {}, &SpectralLine::power)->power);
  for (const SpectralLine& line : lines) {
    wavelengths_nm.push_back(line.wavelength_nm);
    fluxes.push_back(scale * line.power * efficiency_at(efficiency, line.wavelength_nm));
  }
  return normalised(wavelengths_nm, fluxes, efficiency != nullptr);
}

Spectrum gauss_rule(const Spectrum& spectrum, std::size_t nodes) {
  if (spectrum.size() <= nodes) return spectrum;
  const auto points = static_cast<Eigen::Index>(spectrum.size());
  const double low = spectrum.wavelengths_nm.front();
  const double high = spectrum.wavelengths_nm.back();
  const double centre = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  // On [-1, 1] the coefficients of the recurrence are of the order of 1.
  const Eigen::ArrayXd x = (Eigen::Map<const Eigen::ArrayXd>(spectrum.wavelengths_nm.data(), points) - centre) / half;
  const Eigen::ArrayXd weights = Eigen::Map<const Eigen::ArrayXd>(spectrum.weights.data(), points);
  const Recurrence r = stieltjes(x, weights, static_cast<Eigen::Index>(nodes));
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi;
  jacobi.computeFromTridiagonal(r.diagonal, r.off_diagonal);
  Spectrum rule;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(nodes); ++k) {
    rule.wavelengths_nm.push_back(std::clamp(centre + half * jacobi.eigenvalues()[k], low, high));
    rule.weights.push_back(jacobi.eigenvectors()(0, k) * jacobi.eigenvectors()(0, k));
  }
  return rule;
}

Spectrum traced_spectrum(const Spectrum& spectrum, std::size_t parts) {
  constexpr std::size_t kNodesOfPart = 2;
  if (spectrum.size() <= kNodesOfPart * parts) return spectrum;
  const double share = 1.0 / static_cast<double>(parts);
  Spectrum rule;
  Spectrum part;
  double room = share;
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    // A sample on the border of two spans is divided between them.
    double left = spectrum.weights[k];
    while (left >= room && k + 1 < spectrum.size()) {
      if (room > 0.0) {
        part.wavelengths_nm.push_back(spectrum.wavelengths_nm[k]);
        part.weights.push_back(room / share);
      }
      append(rule, gauss_rule(part, kNodesOfPart), share);
      left -= room;
      part = {};
      room = share;
    }
    if (!(left > 0.0)) continue;
    part.wavelengths_nm.push_back(spectrum.wavelengths_nm[k]);
    part.weights.push_back(left / share);
    room -= left;
  }
  append(rule, gauss_rule(part, kNodesOfPart), share);
  return rule;
}

}  // namespace retrace::materials
