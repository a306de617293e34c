#include "studies/rays/ray_wavelengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "materials/io/spectrum_reader.h"

namespace retrace::studies {
namespace {

// Philox stream of random wavelengths.
constexpr std::uint32_t kWavelengthStream = 18;
// Number of steps per nm to which wavelengths of rays are rounded. Optical properties are computed one time for each
// rounded wavelength.
constexpr double kStepsPerNm = 10.0;

/// Returns the spectrum of a table. A table with one sample is a spectral line.
/// \param efficiency luminous efficiency by which the power is weighted; null: not weighted
materials::Spectrum spectrum_of(const materials::SpectralCurve& table, const materials::SpectralCurve* efficiency) {
  if (table.values.size() == 1)
    return materials::line_spectrum({{table.wavelengths_nm.front(), table.values.front()}}, efficiency);
  return materials::resolved_spectrum(table, efficiency);
}

}  // namespace

RayWavelengths::Choice RayWavelengths::choice_of(const materials::Spectrum& spectrum) {
  Choice choice{spectrum.wavelengths_nm, {}};
  double sum = 0.0;
  for (const double weight : spectrum.weights) choice.cumulative.push_back(sum += weight);
  return choice;
}

RayWavelengths::RayWavelengths(const RaySetInfo& info, const std::vector<design::SpectralOptics>& light, bool by_eye,
                               std::uint32_t seed, Add add)
    : kind_(info.spectrum), one_nm_(info.wavelength_nm), seed_(seed), add_(std::move(add)) {
  if (kind_ == RaySpectrum::unknown) {
    materials::Spectrum of_design;
    for (const design::SpectralOptics& at : light) {
      of_design.wavelengths_nm.push_back(at.wavelength_nm);
      of_design.weights.push_back(at.weight);
    }
    choices_.push_back(choice_of(of_design));
  }
  if (kind_ != RaySpectrum::one_table && kind_ != RaySpectrum::table_of_each) return;
  const materials::CieTable cie = materials::shipped_cie_table();
  for (std::size_t k = 0; k < info.tables.size(); ++k) try {
      choices_.push_back(choice_of(spectrum_of(info.tables[k], by_eye ? &cie.photopic_efficiency : nullptr)));
    } catch (const InputError& error) {
      throw InputError(fmt::format("spectral table {} {}", k + 1, error.what()));
    }
}

bool RayWavelengths::has_several() const {
  switch (kind_) {
    case RaySpectrum::one_wavelength: return false;
    case RaySpectrum::unknown: return choices_.front().wavelengths_nm.size() > 1;
    case RaySpectrum::wavelength_of_each:
    case RaySpectrum::one_table:
    case RaySpectrum::table_of_each: break;
  }
  return true;
}

std::uint32_t RayWavelengths::optics_at(double wavelength_nm) {
  if (wavelength_nm == last_nm_) return last_;
  last_nm_ = wavelength_nm;
  if (const auto found = known_.find(wavelength_nm); found != known_.end()) return last_ = found->second;
  shortest_nm_ = known_.empty() ? wavelength_nm : std::min(shortest_nm_, wavelength_nm);
  longest_nm_ = std::max(longest_nm_, wavelength_nm);
  return last_ = known_[wavelength_nm] = add_(wavelength_nm);
}

std::uint32_t RayWavelengths::assign(SetRay& ray, std::uint64_t number) {
  if (kind_ == RaySpectrum::one_wavelength) ray.wavelength_nm = one_nm_;
  if (kind_ == RaySpectrum::wavelength_of_each)
    return optics_at(std::round(ray.wavelength_nm * kStepsPerNm) / kStepsPerNm);
  if (!choices_.empty()) {
    const Choice& choice = choices_[kind_ == RaySpectrum::table_of_each ? ray.table - 1 : 0];
    ray.wavelength_nm = choice.wavelengths_nm.front();
    if (choice.wavelengths_nm.size() == 1) return optics_at(ray.wavelength_nm);
    const auto words = philox({seed_, kWavelengthStream}, static_cast<std::uint32_t>(number),
                              static_cast<std::uint32_t>(number >> 32));
    const double u = unit_interval(words[0]) * choice.cumulative.back();
    const auto found = std::upper_bound(choice.cumulative.begin(), choice.cumulative.end() - 1, u);
    ray.wavelength_nm = choice.wavelengths_nm[static_cast<std::size_t>(found - choice.cumulative.begin())];
  }
  return optics_at(ray.wavelength_nm);
}

}  // namespace retrace::studies
