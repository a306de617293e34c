#pragma once

// Internal to studies/rays: at which wavelength each ray of a source is traced.

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "studies/design/optical_model.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Gives each ray its wavelength and the number of the optics at it.
class RayWavelengths {
 public:
  /// Adds optics at a wavelength to those that are traced. \return their number
  using Add = std::function<std::uint32_t(double wavelength_nm)>;

  /// \param light of the design, for rays that have no wavelengths \param by_eye spectra are weighed by the eye, as
  /// the power of rays is luminous flux
  RayWavelengths(const RaySetInfo& info, const std::vector<SpectralOptics>& light, bool by_eye, std::uint32_t seed,
                 Add add);

  /// Sets the wavelength of a ray; that of a set of single wavelengths is rounded to 0.1 nm. \return its optics
  std::uint32_t settle(SetRay& ray, std::uint64_t number);
  /// Whether rays have more than one.
  bool are_several() const;

  double shortest_nm() const { return shortest_nm_; }
  double longest_nm() const { return longest_nm_; }

 private:
  /// Wavelengths of a spectrum, and the sums of their weights.
  struct Choice {
    std::vector<double> wavelengths_nm;
    std::vector<double> cumulative;
  };
  static Choice choice_of(const materials::Spectrum& spectrum);
  std::uint32_t optics_at(double wavelength_nm);

  RaySpectrum kind_;
  double one_nm_ = 0.0;
  std::vector<Choice> choices_;  ///< by table; of the design's light: one
  std::uint32_t seed_;
  Add add_;
  std::map<double, std::uint32_t> known_;
  double last_nm_ = 0.0;
  std::uint32_t last_ = 0;  ///< of `last_nm_`
  double shortest_nm_ = 0.0;
  double longest_nm_ = 0.0;
};

}  // namespace retrace::studies
