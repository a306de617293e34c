#pragma once

// An endless array as columns over convex cells, in which a ray finds its next facet or neighbour without a search
// tree.

#include <optional>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/elements/lattice.h"
#include "geometry/part/part.h"
#include "geometry/vec.h"

namespace retrace::raytrace {

/// An endless array as columns: each stands over one cell of the period, from the surface up. Over a cell the part is
/// the space above all planes of its facets, so that a straight line meets it as it meets any convex body and needs no
/// search. Coordinates are those of the lattice; where columns of different height meet stands a vertical wall.
class CellArray {
 public:
  struct Facet {
    geometry::Vec3 normal = geometry::Vec3::Zero();  ///< unit, out of the part
    double offset_mm = 0.0;                          ///< normal . p on the plane
    geometry::HeightPlane height;                    ///< the same plane
    geometry::FacetRole role = geometry::FacetRole::retro_facet;
    std::optional<geometry::Vec2> middle_mm = {};  ///< of CellFacet
  };
  /// What lies behind a stretch of an edge.
  struct Neighbour {
    std::uint32_t column = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< from this column's coordinates to the neighbour's
    double until_mm = 0.0;                             ///< end of the stretch along the edge
    bool is_level = true;                              ///< both surfaces have the same height all along it
  };
  struct Edge {
    geometry::Vec2 normal = geometry::Vec2::Zero();  ///< unit, out of the cell
    double offset_mm = 0.0;
    geometry::Vec2 along = geometry::Vec2::Zero();
    std::vector<Neighbour> neighbours;  ///< in the order along the edge, never empty
  };
  struct Column {
    std::vector<Facet> facets;
    std::vector<Edge> edges;

    /// Height of the surface. \param p a point of the cell
    double height(const geometry::Vec2& p) const;
  };
  /// A column where it reaches into the period that starts at the origin.
  struct Piece {
    std::uint32_t column = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< from the period's coordinates to the column's
  };

  /// The piece of a finite part that its borders do not matter to.
  struct Inner {
    geometry::Rectangle where_mm;  ///< a column that reaches in, and all those beside it, are whole
    geometry::Vec2 anchor_mm = geometry::Vec2::Zero();  ///< where on the part the lattice starts
  };

  /// Nothing for a single element, an array whose elements differ, one too small to have an inner piece, and cube
  /// corners with rounded rims.
  static std::optional<CellArray> make(const geometry::Part& part);

  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  const geometry::Vec2& period_mm() const { return period_mm_; }
  /// Nothing if the part is infinite.
  const std::optional<Inner>& inner() const { return inner_; }

 private:
  void find_neighbours(const geometry::Lattice& lattice, double tolerance_mm);
  void find_pieces(const geometry::Lattice& lattice, double tolerance_mm);

  std::vector<Column> columns_;
  std::vector<Piece> pieces_;
  geometry::Vec2 period_mm_ = geometry::Vec2::Zero();
  std::optional<Inner> inner_;
};

}  // namespace retrace::raytrace
