#pragma once

// Closed forms of surface finish in turning: cusp height, Ra and Rq from nose radius, feed and curvature.

#include "fabrication/turning/tool.h"

namespace retrace::fabrication::turning {

/// Nose radius as it shows in the cross-section along the feed: that of the nose circle's projection, an ellipse with
/// half axes b = r cos(skew) along the feed and a = r cos(rake) upwards, at its lowest point: b^2 / a (Sohn, Naples,
/// eqs. 2 and 3; exact for a flat).
double effective_radius_mm(const TurningTool& tool);

/// Height of cusps of a parabola of that radius at pitch f, and the deviations from their mean (closed forms).
struct FinishFigures {
  double peak_to_valley_nm = 0.0;  ///< f^2 / (8 r)
  double ra_nm = 0.0;              ///< f^2 / (18 sqrt(3) r) = f^2 / (31.18 r)
  double rq_nm = 0.0;              ///< f^2 / (12 sqrt(5) r)
  double rq_of_paper_nm = 0.0;     ///< f^2 / (24 r): Sohn, Naples, eq. 4, which is the mean height of the cusps
};

/// \param feed_mm between positions of the nose, along the surface's slope \param curvature_per_mm k of the surface
/// across the cuts, positive in a valley: the nose's middle runs on the parallel curve, so that places where it touches
/// lie f / (1 - r k) apart, and r is replaced by r (1 - r k) \pre feed_mm > 0, r k < 1: the nose fits into the valley
FinishFigures finish_figures(double effective_radius_mm, double feed_mm, double curvature_per_mm = 0.0);

/// The same of the ellipse itself on a flat, by integration: no expansion in the feed. \pre feed < 2 b
FinishFigures exact_finish(const TurningTool& tool, double feed_mm);

/// The feed whose cusps have that height: sqrt(8 r h).
double feed_for_scallop_mm(double effective_radius_mm, double scallop_nm);

}  // namespace retrace::fabrication::turning
