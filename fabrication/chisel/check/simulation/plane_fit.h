#pragma once

// Fits a least-squares plane to the measured heights of a facet. The result is the mean offset and the tilts.

#include <vector>

#include "fabrication/chisel/check/simulation/facet_figures.h"

namespace retrace::fabrication {

/// Least-squares fit of a plane to heights above a facet. It computes the mean and the slopes of FacetFigures.
class PlaneFit {
 public:
  /// Adds a measured height.
  /// \param up_mm distance from the root or the apex, up the facet
  /// \param along_mm position along the root, or across the facet of a cube corner
  void add(double up_mm, double along_mm, double height_mm) { points_.push_back({up_mm, along_mm, height_mm}); }
  void fit(FacetFigures& figures) const;

 private:
  std::vector<geometry::Vec3> points_;
};

}  // namespace retrace::fabrication
