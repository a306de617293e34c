#pragma once

// A region of the part in which cells repeat periodically. A part with zones has several such regions. Copies of a beam
// that are shifted by whole periods within a region meet identical facets.

#include <array>
#include <vector>

#include "geometry/polygon.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

/// A cell of the back surface at its position in the part, projected along z.
struct PlacedCell {
  geometry::Rectangle box_mm;
  CellInstance instance;  ///< identical cells have the same id
  double area_mm2 = 0.0;
};

class PeriodicRegion {
 public:
  /// \param outline convex, counter-clockwise
  /// \param periods_mm two lattice vectors at right angles
  /// \param cells cells of the whole part
  /// \param near_mm tolerance for equal positions
  PeriodicRegion(geometry::Polygon outline, const std::array<Vec2, 2>& periods_mm, const std::vector<PlacedCell>& cells,
                 double near_mm);

  const geometry::Polygon& outline_mm() const { return outline_mm_; }
  bool is_periodic() const { return !sides_.empty(); }

  /// Tiles (rectangular pieces of the entrance face above the region) that are whole periods apart from each other. All
  /// tiles inside the region receive equal light and act on it in the same way.
  struct Tiles {
    geometry::Polygon first;  ///< first tile found that is completely within the outline
    InstanceOffsets inner;    ///< displacements from `first` to all repetitions within the outline, including 0
    std::vector<geometry::Polygon> at_border;
  };
  /// \param max_step_mm approximate side lengths of a tile; each period is divided into a whole number of tiles
  std::vector<Tiles> tiles(const Vec2& max_step_mm) const;

  /// Divides the copies of a beam into groups, see TranslationalSymmetry::divided(). All copies whose sweep is inside
  /// the region form one group. Each other copy forms a group of its own.
  std::vector<InstanceOffsets> divided(const InstanceOffsets& places, const geometry::Rectangle& sweep) const;

 private:
  /// Side of the convex area in which all cells repeat. A point p is in this area if normal . p <= offset_mm for all
  /// sides.
  struct Side {
    Vec2 normal;
    double offset_mm = 0.0;
  };

  std::vector<PlacedCell> cells_of_a_period(const std::vector<PlacedCell>& cells) const;
  bool is_of_lattice(const PlacedCell& cell, const std::vector<PlacedCell>& of_a_period) const;
  void exclude(const geometry::Rectangle& box_mm);
  bool contains(const geometry::Rectangle& box_mm, const Vec2& by) const;

  geometry::Polygon outline_mm_;
  std::array<Vec2, 2> periods_mm_;
  std::vector<Side> sides_;  ///< empty if the region does not repeat
  double near_mm_;
};

}  // namespace retrace::raytrace
