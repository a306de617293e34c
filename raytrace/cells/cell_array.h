#pragma once

// Infinite arrays of elements, represented as columns over convex cells. In a column, a ray finds the next facet or the
// neighbouring column without a search tree.

#include <optional>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/elements/lattice.h"
#include "geometry/part/part.h"
#include "geometry/vec.h"

namespace retrace::raytrace {

/// An infinite array of elements, represented by columns. Each column is the space above one cell of the period. Over a
/// cell, the part is the space above all planes of its facets. It is therefore convex, and a ray finds its next facet
/// without a search tree. Coordinates are those of the lattice. Columns of different height are separated by vertical
/// walls.
class CellArray {
 public:
  struct Facet {
    geometry::Vec3 normal = geometry::Vec3::Zero();  ///< unit normal that points out of the part
    double offset_mm = 0.0;                          ///< normal . p for points p of the plane
    geometry::HeightPlane height;                    ///< the same plane as a function z(x, y)
    geometry::FacetRole role = geometry::FacetRole::retro_facet;
    std::optional<geometry::Vec2> centroid_mm = {};  ///< CellFacet::centroid_mm
  };
  /// Neighbouring column on the other side of an edge of a cell. An edge may have several neighbours, each along one
  /// interval of the edge.
  struct Neighbour {
    std::uint32_t column = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< shift from this column's coordinates to the neighbour's
    double until_mm = 0.0;                             ///< end of the interval along the edge
    bool is_flush = true;                              ///< true if both surfaces have equal heights along the interval
  };
  struct Edge {
    geometry::Vec2 normal = geometry::Vec2::Zero();  ///< unit normal that points out of the cell
    double offset_mm = 0.0;
    geometry::Vec2 along = geometry::Vec2::Zero();
    std::vector<Neighbour> neighbours;  ///< in order along the edge; never empty
  };
  struct Column {
    std::vector<Facet> facets;
    std::vector<Edge> edges;

    /// Returns the height of the surface.
    /// \param p a point of the cell
    double height(const geometry::Vec2& p) const;
  };
  /// Part of a column within the period that starts at the origin.
  struct ColumnFragment {
    std::uint32_t column = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< shift from the period's coordinates to the column's
  };

  /// Inner region of a finite part, in which the borders of the part have no effect.
  struct InnerRegion {
    geometry::Rectangle where_mm;  ///< region; all columns that overlap it, and their neighbours, are complete
    geometry::Vec2 anchor_mm = geometry::Vec2::Zero();  ///< origin of the lattice on the part
  };

  /// Returns the array, or nothing if it cannot be used. This is the case for a single element, elements that differ,
  /// arrays without an inner region, cube corners with rounded rims, and ruled cells with flat portions or more than
  /// 500 cells per period.
  static std::optional<CellArray> make(const geometry::Part& part);

  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<ColumnFragment>& fragments() const { return fragments_; }
  const geometry::Vec2& period_mm() const { return period_mm_; }
  /// Returns the inner region of a finite part, or nothing for an infinite part.
  const std::optional<InnerRegion>& inner() const { return inner_; }

 private:
  void find_neighbours(const geometry::Lattice& lattice, double tolerance_mm);
  void find_fragments(const geometry::Lattice& lattice, double tolerance_mm);

  std::vector<Column> columns_;
  std::vector<ColumnFragment> fragments_;
  geometry::Vec2 period_mm_ = geometry::Vec2::Zero();
  std::optional<InnerRegion> inner_;
};

}  // namespace retrace::raytrace
