#pragma once

// Measures every facet that the cuts of an element leave: distance, angle, root residue and volume against the design.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/chisel/check/prediction.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"

namespace retrace::fabrication {

/// A place of a facet where what is left differs most from what should be.
struct FacetDeviation {
  double nm = 0.0;        ///< along the design's normal, above what is predicted; negative: too much was removed
  std::int32_t line = 0;  ///< NC line of the move that made the surface there
};

/// What the sweeps of one element leave of one of its facets. The surface is the envelope of the tool's planes, taken
/// along lines normal to the design's facet at the corners of that envelope and between them.
struct FacetFigures {
  bool is_ploughed = false;
  double distance_nm = 0.0;    ///< largest deviation from the prediction outside of the strip along the root, unsigned
  FacetDeviation highest;      ///< outside of the strip
  FacetDeviation deepest;      ///< likewise
  FacetDeviation root;         ///< left at the root, up the other facet
  double mean_nm = 0.0;        ///< of the deviations from the design outside of the strip
  double mean_up_mm = 0.0;     ///< where that mean lies: from the root
  double mean_along_mm = 0.0;  ///< and along it
  double slope_up = 0.0;       ///< of the plane through the surface against the design: up the slope
  double slope_along = 0.0;    ///< and along the root
  double residual_mm3 = 0.0;   ///< volume that is left above the design's facet, less what was removed below it
};

struct ElementFigures {
  bool is_cut = false;
  std::vector<FacetFigures> facets;  ///< none if it is not cut
};

/// Of a prism. \param poses machine_from_workpiece for each Sweep::pose
/// \param is_one_facet_ploughed the strategy ploughs the facet that it does not plunge
/// \param tolerance_mm of facets: a layer that thin on one of them is not told as what is left at the root
ElementFigures element_figures(const Groove& groove, std::span<const SweptVolume> sweeps,
                               std::span<const RigidMotion> poses, const ToolWedge& wedge, const Prediction& prediction,
                               bool is_one_facet_ploughed, double tolerance_mm);

/// Of a cube corner: the surface along lines normal to each facet over the whole of it, close to the dihedral edges and
/// on both sides of where the leading edge stands with its tip in the apex.
/// \param is_hexagonal the facets are squares of half the edges' length, not triangles up to the blank's face
/// \param nose_angle_deg of the tool \param prediction how the facets stand to it
ElementFigures cavity_figures(const Groove& cavity, bool is_hexagonal, std::span<const SweptVolume> sweeps,
                              std::span<const RigidMotion> poses, const ToolWedge& wedge, double nose_angle_deg,
                              const Prediction& prediction);

}  // namespace retrace::fabrication
