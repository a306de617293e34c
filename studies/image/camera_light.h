#pragma once

// Light of the lamp in camera pictures: the traced wavelengths, and the luminance of the returned light with
// diffraction.

#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/observers/camera.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

/// Minimum ratio of luminance to illuminance at which retroreflected light is regarded as visible, in cd/(lx m^2). The
/// ratio of a white matt surface is 0.32.
inline constexpr double kMinRetroreflected = 1e-3;

/// Light of the lamp as a receiver with one spectral response sees it.
class CameraLight {
 public:
  /// \param photometry light, dye, apertures and diffraction; the apertures are those of the lamp and the pupil
  /// \throw InputError in the same cases as Photometer
  CameraLight(const design::Design& design, const PhotometrySettings& photometry, std::size_t parts,
              PhotometricResponse response);

  /// Returns the optics at the traced wavelengths. The weights add up to 1.
  std::vector<raytrace::WeightedOptics> optics() const;
  bool has_diffraction() const { return photometer_.has_diffraction(); }
  const Photometer& photometer() const { return photometer_; }

  struct Returned {
    raytrace::ReturnCorrection correction;
    /// R_A in cd/(lx m^2) for the directions of lamp and eye as seen from the centre of the visible face. Empty if it
    /// was not computed.
    std::optional<double> r_a;
    double r_a_error = 0.0;      ///< standard error of `r_a` caused by the resampling of weak beams
    bool is_incomplete = false;  ///< true: significant light has not been diffracted, because the cells differ too much
  };
  /// Computes the light that returns to the eye, with diffraction if possible. Returns nothing if the computation was
  /// cancelled.
  /// \throw BudgetError if the exact engine needs too many beams
  std::optional<Returned> returned(const geometry::Part& part, const raytrace::CameraScene& scene, Progress* progress,
                                   const Cancellation* cancel) const;
  /// Returns the light of geometrical optics.
  Returned without_diffraction() const;

 private:
  class Grid;

  Photometer photometer_;
  double flux_ = 1.0;  ///< sum of the photometer's weights
};

}  // namespace retrace::studies
