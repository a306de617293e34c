#pragma once

// Scatter from a measured height map. It is computed as diffraction by the spectrum of the map. If the heights are
// large compared with the wavelength, it is computed from the slopes of the map instead.

#include <memory>

#include "core/warning.h"
#include "surface_models/height_map.h"
#include "surface_models/scatter/phase_lobe.h"

namespace retrace::surface_models {

/// Maximum number of points of a map that scatters light: 2048 x 2048. The spectrum needs about 100 bytes per point.
inline constexpr std::size_t kMaxScatterPoints = std::size_t{1} << 22;

/// Scatter from a measured surface. The map is a sample of a larger surface: only its statistics are used, not its
/// position on the part.
///
/// - The specular fraction is computed as for Gaussian heights with the map's Sq, exp(-(4 pi n s cos t / w)^2) in
/// reflection. There is a warning if the heights are not Gaussian.
/// - If the squared phase is below kSlopePhase2, the rest of the light is diffracted (PhaseLobe). Light that is
/// diffracted once follows the map's own PSD (power spectral density). Light that is diffracted several times follows a
/// Gaussian with the same covariance (central limit theorem).
/// - Otherwise, each point of the map acts as a facet. A facet that faces the light is drawn with a probability
/// proportional to its projected area.
///
/// The mean plane of the map is subtracted first. The x and y axes of the map are the axes of the texture
/// (ScatterEvent). Weights are 1 if light leaves to the correct side.
class HeightMapScatter {
 public:
  /// \param map areal map with at least 8 x 8 and at most kMaxScatterPoints points, and an rms slope of at most
  ///     kMaxModelledSlope; missing points are replaced by the mean
  /// \param wavelength_nm minimum distance over which slopes of facets are computed, > 0
  /// \throw InputError if the map is outside these limits
  HeightMapScatter(const HeightMap& map, double wavelength_nm);

  double sq_nm() const;

  /// \param event in the frame of the mean surface
  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// Returns 1 - specular_fraction(), with full precision even if the result is small.
  double scattered_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// Draws the direction of light, given that it is scattered. Returns nothing if no direction is found.
  std::optional<Vec2> draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                     RandomStream& random) const;
  double scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  /// Returns the density before it is scaled to the scattered fraction.
  double unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  double unmasked_fraction(const Vec3&) const { return 1.0; }
  Warnings warnings(double index, double wavelength_nm) const;

 private:
  struct Texture;
  struct Band;
  std::shared_ptr<const Texture> texture_;  ///< constant; shared by copies of the model
};

}  // namespace retrace::surface_models
