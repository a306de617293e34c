#pragma once

// Overlay of convex polygons with values. The result is a set of disjoint polygons with summed values, which is used
// for footprints (the regions of the entrance face from which light returns).

#include <memory>
#include <vector>

#include "raytrace/exact/flat_polygon.h"

namespace retrace::raytrace {

/// A convex, counter-clockwise polygon and a value that is constant over it.
struct ValuedPolygon {
  FlatPolygon polygon;
  double value = 0.0;
};

/// Overlay of convex polygons. It stores disjoint polygons. Where inserted polygons overlap, their values are added.
/// The sum of area times value is preserved except for rounding.
class Overlay {
 public:
  /// \param size_mm length scale of tolerances: corners closer than 1e-11 size_mm are merged, and polygons with an area
  ///        below 1e-13 size_mm^2 are omitted as rounding errors
  explicit Overlay(double size_mm);
  ~Overlay();

  /// \pre `polygon` is convex and counter-clockwise
  void insert(const FlatPolygon& polygon, double value);

  /// Returns the disjoint polygons. The subdivision depends on the order of insertion.
  std::vector<ValuedPolygon> polygons() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Joins disjoint convex polygons that have a whole edge in common. Their values must agree within `value_tolerance`,
/// and their union must be convex.
/// \param size_mm as for Overlay
std::vector<ValuedPolygon> fused(const std::vector<ValuedPolygon>& pieces, double size_mm, double value_tolerance);

}  // namespace retrace::raytrace
