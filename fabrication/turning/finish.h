#pragma once

// Computes the surface finish of turning by closed forms: cusp height, Ra and Rq from nose radius, feed and curvature.

#include "fabrication/turning/tool.h"

namespace retrace::fabrication::turning {

/// Returns the effective nose radius in the cross-section along the feed. The projection of the nose circle is an
/// ellipse with the half axes b = r cos(skew) along the feed and a = r cos(rake) upwards. Its radius of curvature at
/// the lowest point is b^2 / a (Sohn, Naples, eqs. 2 and 3; exact for a flat).
double effective_radius_mm(const TurningTool& tool);

/// Surface finish that a nose leaves at the feed f, in closed form. The nose is approximated by a parabola with the
/// radius of curvature r.
struct FinishFigures {
  double peak_to_valley_nm = 0.0;  ///< f^2 / (8 r)
  double ra_nm = 0.0;              ///< f^2 / (18 sqrt(3) r) = f^2 / (31.18 r)
  double rq_nm = 0.0;              ///< f^2 / (12 sqrt(5) r)
  double rq_of_paper_nm = 0.0;     ///< f^2 / (24 r): "Rq" of Sohn and Naples, eq. 4; actually the mean height of cusps
};

/// Computes the surface finish. The centre of the nose moves on a parallel curve of the surface. Points of contact are
/// therefore f / (1 - r k) apart, and r is replaced by r (1 - r k).
/// \param feed_mm distance f between positions of the nose, along the slope of the surface
/// \param curvature_per_mm curvature k of the surface across the cuts, positive in a valley
/// \pre feed_mm > 0; r k < 1, so that the nose fits into the valley
FinishFigures finish_figures(double effective_radius_mm, double feed_mm, double curvature_per_mm = 0.0);

/// Computes the surface finish on a flat surface by integration over the ellipse of effective_radius_mm(), without
/// expansion in the feed.
/// \pre feed < 2 b
FinishFigures exact_finish(const TurningTool& tool, double feed_mm);

/// Returns the feed that gives a cusp height: sqrt(8 r h).
double feed_for_scallop_mm(double effective_radius_mm, double scallop_nm);

}  // namespace retrace::fabrication::turning
