#pragma once

// Lays convex polygons with values over each other into disjoint pieces with summed values, as the footprint needs it.

#include <memory>
#include <vector>

#include "raytrace/exact/flat_polygon.h"

namespace retrace::raytrace {

/// A convex polygon, counter-clockwise, and what holds all over it.
struct ValuedPolygon {
  FlatPolygon polygon;
  double value = 0.0;
};

/// Lays convex polygons over each other: keeps disjoint ones whose values add where the given ones overlap. The sum of
/// area times value is kept to rounding.
class Overlay {
 public:
  /// \param size_mm the scale for tolerances: corners within 1e-11 of it are one, pieces below 1e-13 of its square are
  ///        rounding and left out
  explicit Overlay(double size_mm);
  ~Overlay();

  /// \pre `polygon` is convex and counter-clockwise
  void insert(const FlatPolygon& polygon, double value);

  /// The disjoint polygons. Which they are depends on the order of insertion, not on anything else.
  std::vector<ValuedPolygon> pieces() const;

 private:
  struct Hidden;
  std::unique_ptr<Hidden> hidden_;
};

/// Joins disjoint convex polygons across whole common edges where the values agree within `value_tolerance` and the
/// union is convex. \param size_mm as for Overlay
std::vector<ValuedPolygon> fused(const std::vector<ValuedPolygon>& pieces, double size_mm, double value_tolerance);

}  // namespace retrace::raytrace
