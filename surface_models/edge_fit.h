#pragma once

// Radius or chamfer of the edge between two facets, fitted to a measured profile across it.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

enum class EdgeShape { radius, chamfer };

/// The edge between two plane facets, as a profile across it shows it.
struct EdgeFit {
  double radius_um = 0.0;            ///< of the circle tangent to both facets that fits best
  double chamfer_um = 0.0;           ///< width across the flat that fits best in place of the circle
  double radius_residual_nm = 0.0;   ///< root mean square, vertical, over the degrees of freedom
  double chamfer_residual_nm = 0.0;  ///< the same with the flat
  double dihedral_deg = 0.0;  ///< angle between the facets, on the side of the material, 0..360; above 180: a valley
  EdgeShape better = EdgeShape::radius;  ///< the shape of the lower residual
  std::vector<double> residual_nm;       ///< heights less the better shape; NaN where nothing was measured
};

/// Fewest measured points of a profile that an edge is fitted to.
inline constexpr std::size_t kLeastEdgePoints = 16;

/// Fits both shapes to a profile by least squares in height: facets, circle or flat all at once (Levenberg and
/// Marquardt). A convex edge or a valley; the facets must reach over at least a fifth of the profile at either end, be
/// steeper against each other than 0.5 degrees and not overhang.
/// \param heights_nm at multiples of pixel_um, NaN where missing
/// \throw std::invalid_argument if there are too few points or no edge between two facets
EdgeFit fit_edge(const std::vector<double>& heights_nm, double pixel_um);

}  // namespace retrace::surface_models
