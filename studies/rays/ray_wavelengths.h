#pragma once

// Selects the wavelength at which each ray of a source is traced. Internal to studies/rays.

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "design/optical_model.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Assigns a wavelength to each ray, and the index of the optical properties at this wavelength.
class RayWavelengths {
 public:
  /// Function that adds optical properties for one more wavelength.
  /// \return index of these properties
  using Add = std::function<std::uint32_t(double wavelength_nm)>;

  /// \param light light of the design, for rays without wavelengths
  /// \param by_eye true: spectra are weighted by the response of the eye, because the power of rays is luminous flux
  RayWavelengths(const RaySetInfo& info, const std::vector<design::SpectralOptics>& light, bool by_eye,
                 std::uint32_t seed, Add add);

  /// Sets the wavelength of a ray. If each ray of the set has its own wavelength, it is rounded to 0.1 nm.
  /// \return index of the optical properties
  std::uint32_t assign(SetRay& ray, std::uint64_t number);
  /// Returns true if the rays have more than one wavelength.
  bool has_several() const;

  double shortest_nm() const { return shortest_nm_; }
  double longest_nm() const { return longest_nm_; }

 private:
  /// Wavelengths of a spectrum, with the cumulative sums of their weights.
  struct Choice {
    std::vector<double> wavelengths_nm;
    std::vector<double> cumulative;
  };
  static Choice choice_of(const materials::Spectrum& spectrum);
  std::uint32_t optics_at(double wavelength_nm);

  RaySpectrum kind_;
  double one_nm_ = 0.0;
  /// One entry for each spectral table of the set, or one entry for the light of the design.
  std::vector<Choice> choices_;
  std::uint32_t seed_;
  Add add_;
  std::map<double, std::uint32_t> known_;
  double last_nm_ = 0.0;
  std::uint32_t last_ = 0;  ///< index of the optical properties at `last_nm_`
  double shortest_nm_ = 0.0;
  double longest_nm_ = 0.0;
};

}  // namespace retrace::studies
