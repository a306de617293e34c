#pragma once

// Measures the machined facets of an element relative to the design: distance, angle, residual material at the root,
// and residual volume.

#include <cstdint>
#include <span>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/prediction.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"

namespace retrace::fabrication {

/// Largest deviation of a machined facet from the predicted surface.
struct FacetDeviation {
  double nm = 0.0;        ///< deviation from the prediction along the design normal; negative if too much was removed
  std::int32_t line = 0;  ///< NC line of the move that produced the surface at this point
};

/// Deviations of one machined facet. The machined surface is the envelope of the tool's planes. It is measured along
/// lines normal to the designed facet, at the corners of the envelope and between them.
struct FacetFigures {
  bool is_ploughed = false;
  double distance_nm = 0.0;    ///< largest absolute deviation from the prediction, outside of the strip at the root
  FacetDeviation highest;      ///< largest positive deviation outside of the strip
  FacetDeviation deepest;      ///< largest negative deviation outside of the strip
  FacetDeviation root;         ///< residual material at the root, measured along the other facet
  double mean_nm = 0.0;        ///< mean deviation from the design, outside of the strip
  double mean_up_mm = 0.0;     ///< mean distance of the measured points from the root
  double mean_along_mm = 0.0;  ///< mean position of the measured points along the root
  double slope_up = 0.0;       ///< slope of the fitted plane relative to the design, in the direction up the facet
  double slope_along = 0.0;    ///< slope of the fitted plane relative to the design, along the root
  /// Volume of residual material above the designed facet, minus the volume removed below it.
  double residual_mm3 = 0.0;
};

struct ElementFigures {
  bool is_cut = false;
  std::vector<FacetFigures> facets;  ///< empty if the element is not cut
};

/// Measures the facets of a prism.
/// \param poses machine_from_workpiece for each SweptVolume::pose
/// \param is_one_facet_ploughed true if the strategy plunges one facet and ploughs the other facet
/// \param tolerance_mm tolerance of facets. A layer of this thickness on a facet is not counted as residual material at
///        the root
ElementFigures element_figures(const PrismGroove& groove, std::span<const SweptVolume> sweeps,
                               std::span<const RigidMotion> poses, const ToolWedge& wedge, const Prediction& prediction,
                               bool is_one_facet_ploughed, double tolerance_mm);

/// Measures the facets of a cube corner. The measuring lines are normal to each facet. They cover the whole facet and
/// the strips along the dihedral edges. Additional lines are placed on both sides of the tool's leading edge, at its
/// position when the tip is at the apex.
/// \param nose_angle_deg nose angle of the tool
/// \param prediction predicted errors and poses of this element
ElementFigures cavity_figures(const CubeCavity& cavity, std::span<const SweptVolume> sweeps,
                              std::span<const RigidMotion> poses, const ToolWedge& wedge, double nose_angle_deg,
                              const Prediction& prediction);

}  // namespace retrace::fabrication
