#pragma once

// Far field of the light that textures of facets scatter. It includes the interference of light on different paths that
// meet the same points of a texture.

#include <Eigen/Core>
#include <complex>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/aperture_kernel.h"
#include "raytrace/observers/coherent_group.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::raytrace {

/// Mean of |E - <E>|^2 in the far field, over all textures whose heights have Gaussian statistics. A texture changes
/// the phase of the light that meets it. The phases at two points of the entrance face are correlated if their light
/// has met the same points of facets (docs/theory/photometry.md).
///
/// Correlations of nearby points of the entrance face cause lobes. The angular width of a lobe is the wavelength
/// divided by the correlation length. Correlations of distant points, for example of a path and its reverse, cause
/// interference fringes about the direction to the source (coherent backscattering). The angular width of a fringe is
/// the wavelength divided by the cell size.
///
/// A resampled beam represents many weak beams (PopulationControl). Resampling is repeated in independent replicates,
/// whose spread gives the standard error.
class ScatteredField {
 public:
  ScatteredField() = default;
  /// \param coherency matrix of the incident light
  /// \param reach_cosine maximum distance from the specular directions, in direction cosines, at which lobes are
  ///        accurate. It determines the fineness of the grid of distances.
  /// \param groups all groups that will be passed to add()
  /// \param replicates number of replicates of resampled beams; 0 if there are none
  ScatteredField(double wavelength_mm, const Eigen::Matrix2cd& coherency, double reach_cosine,
                 const std::vector<CoherentGroup>& groups, std::uint32_t replicates);

  /// Adds the lobes and fringes of a group. A resampled beam has no fringes, because it does not interfere with others.
  /// \param with_fringes if false, fringes are omitted; this is used for wide cells, whose fringes are finer than the
  ///        discs of source and receiver
  void add(const CoherentGroup& group, bool with_fringes);

  /// Returns the power of the scattering lobes per unit area of direction cosines.
  double lobes_per_cosines(const geometry::Vec2& cosines) const;
  /// Returns the power of the lobes per unit area of direction cosines, averaged with the kernel over the discs of
  /// source and receiver. Element 0 is the power of beams that were not resampled. Element 1 + k is the power of
  /// replicate k divided by the number of replicates.
  /// \param cosines_per_rad derivatives of the direction cosines with respect to two angles that rotate the direction
  Eigen::ArrayXd lobes_by_replicate(const geometry::Vec2& cosines, const Eigen::Matrix2d& cosines_per_rad,
                                    const ApertureKernel& kernel) const;
  /// Returns the power of the lobes within an ellipse in the plane of direction cosines.
  /// \param centre centre of the ellipse
  /// \param axes matrix that maps the unit disc to the ellipse
  double lobes_within(const geometry::Vec2& centre, const Eigen::Matrix2d& axes) const;
  /// Returns the power of the interference fringes per unit area of direction cosines. Bright fringes are positive and
  /// dark fringes are negative. The integral over all directions is 0. If the computation was cancelled, the remaining
  /// elements are 0.
  std::vector<double> fringes_per_cosines(std::span<const geometry::Vec2> cosines, const Cancellation* cancel) const;
  /// Returns the power of the lobes, integrated over all directions.
  double power() const { return power_; }

 private:
  /// A distance vector between two points of the entrance face. Its weight is the sum of the correlations of all pairs
  /// of points at this distance, multiplied by the quadrature weight. The lobes are the Fourier sum over all distances.
  struct Distance {
    geometry::Vec2 mm;
    std::complex<double> weight;
  };
  /// Quadrature points of distance vectors with one length. In the grid of the lobes they cover a half circle, because
  /// opposite distances contribute complex conjugates. In the grid of the fringes they cover the full circle.
  struct Ring {
    double radius_mm = 0.0;
    double weight_mm = 0.0;  ///< weight of the radius in the Gauss quadrature
    std::size_t angles = 0;  ///< number of points
  };
  struct Shared;  ///< map between the points of two polygons whose light has met the same points of facets
  struct Moves;   ///< displacements between the points that such a map connects

  /// Adds the contribution of two polygons if the map is the identity.
  /// \param copies number of equal contributions: number of cells, times 2 for two different polygons
  void add_lobe(const Shared& shared, const CoherentGroup& group, double copies);
  /// Adds the contribution of two polygons if the map is not the identity. The parameter is that of add_lobe().
  void add_fringes(const Shared& shared, double copies);

  double wave_number_ = 0.0;  ///< rad per mm
  Eigen::Matrix2cd coherency_ = Eigen::Matrix2cd::Zero();
  double shortest_mm_ = 0.0, longest_mm_ = 0.0;  ///< correlation lengths; 0 if there is no scattering
  std::vector<Ring> rings_, coarse_rings_;
  std::vector<Distance> distances_;
  Eigen::ArrayXXcd replicate_weights_;  ///< row k, column j: contribution of replicate j to distances_[k].weight
  std::vector<field_lanes::Fringes> fringes_;
  double power_ = 0.0;
};

}  // namespace retrace::raytrace
