#pragma once

// Fits the radius or chamfer of the edge between two facets to a measured profile across the edge.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

enum class EdgeShape { radius, chamfer };

/// Edge between two plane facets, from a profile across it.
struct EdgeFit {
  double radius_um = 0.0;            ///< radius of the best-fitting circle that is tangent to both facets
  double chamfer_um = 0.0;           ///< width of the best-fitting flat, measured across the edge
  double radius_residual_nm = 0.0;   ///< rms vertical residual of the circle; divisor: degrees of freedom
  double chamfer_residual_nm = 0.0;  ///< rms vertical residual of the flat; divisor: degrees of freedom
  double dihedral_deg = 0.0;  ///< angle between the facets, on the side of the material, 0..360; above 180: a valley
  EdgeShape better = EdgeShape::radius;  ///< shape with the lower residual
  std::vector<double> residual_nm;       ///< measured heights minus the better shape; NaN where nothing was measured
};

/// Minimum number of measured points in a profile for a fit.
inline constexpr std::size_t kMinEdgePoints = 16;

/// Fits a circle and a flat to a profile, by least squares in height. Each fit determines the facets and the shape
/// simultaneously (Levenberg-Marquardt). The edge may be convex or a valley. Each facet must occupy at least a fifth of
/// the profile. The facets must differ in slope by at least 0.5 degrees and must not overhang.
/// \param heights_nm heights at multiples of pixel_um; NaN where missing
/// \throw std::invalid_argument if there are too few points or no edge between two facets
EdgeFit fit_edge(const std::vector<double>& heights_nm, double pixel_um);

}  // namespace retrace::surface_models
