#pragma once

// Scatter from a measured height map: by diffraction at its own spectrum, or by its slopes where it is high against the
// wavelength.

#include <memory>
#include <string>
#include <vector>

#include "core/warning.h"
#include "surface_models/height_map.h"
#include "surface_models/scatter/phase_lobe.h"

namespace retrace::surface_models {

/// Most points of a map that scatters light: 2048 x 2048. Its spectrum takes about 100 bytes a point.
inline constexpr std::size_t kMostScatterPoints = std::size_t{1} << 22;

/// Scatter from a measured surface, taken as a sample of a larger one: statistics of the map, not its place on the
/// part.
///
/// - The specular share is that of Gaussian heights of the map's Sq, exp(-(4 pi n s cos t / w)^2) in reflection; a
///   warning says when the heights are not Gaussian.
/// - Where that phase squared is below kSlopePhase2 the rest is diffracted (PhaseLobe): once by the map's own PSD,
///   direction by direction; several times by a Gaussian of the same covariance (central limit theorem).
/// - From there on every place of the map is a facet: one is drawn among those that face the light, in proportion to
///   the cross-section it shows.
///
/// The map is levelled first. Its x and y are those of the event. Weights are 1 where light leaves to the right side.
class HeightMapScatter {
 public:
  /// \param map areal, at least 8 x 8 and at most kMostScatterPoints points, of an rms slope up to kSlopeOfNoModel;
  ///        missing points count as the mean
  /// \param wavelength_nm slopes of facets are taken over at least this distance, > 0
  /// \throw InputError
  HeightMapScatter(const HeightMap& map, double wavelength_nm);

  double sq_nm() const;

  /// \param event in the frame of the mean surface
  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// One less the same, to full precision where that is small.
  double scattered_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// Draws the direction of light, given that it scatters. Nothing if no direction can be found.
  std::optional<Vec2> draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                     RandomStream& random) const;
  double scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  /// The density before scaling to the scattered share.
  double unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  double unmasked_share(const Vec3&) const { return 1.0; }
  Warnings warnings(double index, double wavelength_nm) const;

 private:
  struct Texture;
  struct Band;
  std::shared_ptr<const Texture> texture_;  ///< never changed; copies of the model share it
};

}  // namespace retrace::surface_models
