#pragma once

// Light that the textures of facets scatter, diffracted together with the specular light: what heights that paths share
// make of the far field beyond its mean.

#include <Eigen/Core>
#include <complex>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/observers/aperture_kernel.h"
#include "raytrace/observers/coherent_group.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::raytrace {

/// The mean of |E - <E>|^2 in the far field of cells whose facets have heights of Gaussian statistics, over all such
/// heights. Every facet is a screen of phases where light meets it; two places of the entrance face are correlated as
/// far as their light has met the same places of facets (docs/theory/photometry.md).
///
/// What paths share at like places of the entrance face makes lobes, as wide as the wavelength over the correlation
/// length. What they share at unlike places - a path and its reverse meet the same points - makes fringes about the
/// direction back to the source, as wide as the wavelength over the cell.
class ScatteredField {
 public:
  ScatteredField() = default;
  /// \param coherency matrix of the incident light
  /// \param reach_cosine distance from the specular directions, in cosines, up to which lobes are computed
  /// \param groups all groups that will be passed to add()
  /// \param replicates number of replicates of resampled beams; 0 if there are none
  ScatteredField(double wavelength_mm, const Eigen::Matrix2cd& coherency, double reach_cosine,
                 const std::vector<CoherentGroup>& groups, std::uint32_t replicates);

  /// Adds the lobes and fringes of a group. A resampled beam interferes only with itself and has no fringes.
  /// \param with_fringes false to omit the fringes; the fringes of wide cells are negligible because they are finer
  ///        than the discs of source and receiver
  void add(const CoherentGroup& group, bool with_fringes);

  /// Returns the power of the scattering lobes per unit area of direction cosines.
  double lobes_per_cosines(const geometry::Vec2& cosines) const;
  /// Returns the power of the lobes per unit area of direction cosines, averaged with the kernel. Element 0 is the
  /// contribution of beams without a replicate. Element 1 + k is the contribution of replicate k, divided by the number
  /// of replicates.
  /// \param cosines_per_rad derivatives of the direction cosines by two rotation angles of the direction
  Eigen::ArrayXd lobes_by_replicate(const geometry::Vec2& cosines, const Eigen::Matrix2d& cosines_per_rad,
                                    const ApertureKernel& kernel) const;
  /// Returns the power of the scattering lobes within an ellipse of direction cosines.
  /// \param middle centre of the ellipse
  /// \param axes matrix that maps the unit disc to the ellipse
  double lobes_within(const geometry::Vec2& middle, const Eigen::Matrix2d& axes) const;
  /// Returns the power of the interference fringes per unit area of direction cosines. It is positive in bright fringes
  /// and negative in dark ones; the integral over all directions is 0. If the computation was cancelled, the result
  /// contains zeros.
  std::vector<double> fringes_per_cosines(std::span<const geometry::Vec2> cosines, const Cancellation* cancel) const;
  /// Returns the total power of the scattering lobes over all directions.
  double power() const { return power_; }

 private:
  /// A distance of two places and what all pairs of places so far apart have in common: lobes are their Fourier sum.
  struct Distance {
    geometry::Vec2 mm;
    std::complex<double> weight;
  };
  /// Distances along the radius of the grid, over half a turn.
  struct Ring {
    double radius_mm = 0.0;
    double weight_mm = 0.0;
    std::size_t angles = 0;
  };
  struct Shared;
  struct Moves;

  void add_lobe(const Shared& shared, const CoherentGroup& group, double copies);
  void add_fringes(const Shared& shared, double copies);

  double wave_number_ = 0.0;  ///< rad per mm
  Eigen::Matrix2cd coherency_ = Eigen::Matrix2cd::Zero();
  double shortest_mm_ = 0.0, longest_mm_ = 0.0;  ///< correlation lengths; 0: nothing scatters
  std::vector<Ring> rings_, coarse_rings_;
  std::vector<Distance> distances_;
  Eigen::ArrayXXcd replicate_weights_;  ///< weights of distances_ (rows) by replicate (columns)
  std::vector<field_lanes::Fringes> fringes_;
  double power_ = 0.0;
};

}  // namespace retrace::raytrace
