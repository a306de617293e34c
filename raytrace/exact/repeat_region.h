#pragma once

// A region of a part of zones, in which cells are those of a lattice: where a beam and its copies, whole periods apart,
// meet the same.

#include <array>
#include <vector>

#include "geometry/polygon.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

/// A cell of the back surface in its place, seen from above.
struct PlacedCell {
  geometry::Rectangle box_mm;
  CellPlace place;  ///< its id is the same for all cells that are alike
  double area_mm2 = 0.0;
};

class RepeatRegion {
 public:
  /// \param outline convex, counter-clockwise \param periods_mm across each other \param cells of the whole part \param
  /// near_mm by which places may differ and be one
  RepeatRegion(geometry::Polygon outline, const std::array<Vec2, 2>& periods_mm, const std::vector<PlacedCell>& cells,
               double near_mm);

  const geometry::Polygon& outline_mm() const { return outline_mm_; }
  bool repeats() const { return !sides_.empty(); }

  /// What an entrance above the region is divided into: tiles that repeat by whole periods.
  struct Tiles {
    geometry::Polygon first;  ///< that lies wholly within the outline ...
    BeamPlaces inner;         ///< ... and by what it is moved to be one of all that do, itself included
    std::vector<geometry::Polygon> at_border;
  };
  /// \param most_step_mm sides of tiles, or less
  std::vector<Tiles> tiles(const Vec2& most_step_mm) const;

  /// As EqualPlaces::divided(): those in the middle of the region meet the same, all others each something of its own.
  std::vector<BeamPlaces> divided(const BeamPlaces& places, const geometry::Rectangle& sweep) const;

 private:
  /// All cells where normal . p <= offset_mm, of all sides, are the lattice's.
  struct Side {
    Vec2 normal;
    double offset_mm = 0.0;
  };

  std::vector<PlacedCell> cells_of_a_period(const std::vector<PlacedCell>& cells) const;
  bool is_of_lattice(const PlacedCell& cell, const std::vector<PlacedCell>& of_a_period) const;
  void leave_out(const geometry::Rectangle& box_mm);
  bool holds(const geometry::Rectangle& box_mm, const Vec2& by) const;

  geometry::Polygon outline_mm_;
  std::array<Vec2, 2> periods_mm_;
  std::vector<Side> sides_;  ///< none: it does not repeat
  double near_mm_;
};

}  // namespace retrace::raytrace
