#pragma once

// Least-squares plane through the measured heights of a facet: its mean offset and tilts.

#include <vector>

#include "fabrication/chisel/check/simulation/facet_figures.h"

namespace retrace::fabrication {

/// The plane through heights over a facet, by least squares: what FacetFigures says of it.
class PlaneFit {
 public:
  /// \param up_mm up the slope from the root or the apex \param along_mm along a level line of the facet
  void add(double up_mm, double along_mm, double height_mm) { points_.push_back({up_mm, along_mm, height_mm}); }
  void fit(FacetFigures& figures) const;

 private:
  std::vector<geometry::Vec3> points_;
};

}  // namespace retrace::fabrication
