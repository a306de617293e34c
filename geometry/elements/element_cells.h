#pragma once

// Geometry of single elements. A prism or cube corner consists of plane facets over polygons in the xy plane. Errors of
// angle and cant change the planes of the facets.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// Type of a face of the part. The energy ledger groups the light that leaves the part by the role of the face through
/// which it leaves.
enum class FacetRole : std::uint8_t {
  entrance,     ///< flat face at z = +thickness
  retro_facet,  ///< a facet of an element
  flat_back,    ///< flat surface on z = 0: land between elements, margin, or omitted element
  inner_wall,   ///< vertical wall between cells of different depth
  border_wall,  ///< vertical wall that closes the cut where the border of the array cuts elements
  side          ///< side of the plate
};

/// Plane as a height over the part's xy plane: z = height_mm + slope . (x, y).
struct HeightPlane {
  double height_mm = 0.0;
  Vec2 slope = Vec2::Zero();

  double at(const Vec2& p) const { return height_mm + slope.dot(p); }
};

/// Facet of an element: its outline in plan and its plane.
struct CellFacet {
  Polygon outline;
  HeightPlane plane;
  bool is_edge = false;  ///< true for a strip of a rounded or chamfered edge, and for a flank of a scratch
  /// (x, y) of the centroid of the complete facet, before edges, scratches and borders remove parts of it. The facet's
  /// form error is defined relative to this point. Land and edges have no value.
  std::optional<Vec2> centroid_mm = {};
  /// True for a horizontal portion of a ruled cell: a truncated top or a flat groove bottom. It is not a retro facet.
  bool is_flat = false;
};

/// An element, or a flat area on z = 0 without elements (land). The order of an element's facets is the order of
/// ElementPlanes::planes.
struct Cell {
  bool is_element = true;
  Polygon outline;
  std::vector<CellFacet> facets;
  Vec2 at_mm = Vec2::Zero();  ///< lower left corner of a prism, apex of a cube corner
  bool rotated = false;
};

/// Returns a right triangular prism.
/// \param corner_mm lower left corner
/// \param rotated true: the prism is rotated by 90 degrees about z, so that its roof edge is along x; base and width
///     must be equal
Cell rtp_cell(const RtpElement& element, const AngleErrors& errors, const Vec2& corner_mm, bool rotated = false);

/// Returns a full cube corner with its apex below `centre_mm`. Without errors and cant, its three highest rim points
/// are on z = 0.
Cell hexagonal_cube_cell(const HexagonalCube& element, const AngleErrors& errors, const Vec2& centre_mm);

/// Returns a triangular cube corner with its apex below `centre_mm`. Without errors and cant, its rim is on z = 0.
/// \param rotated true: the element, including errors and cant, is rotated by 180 degrees about z
Cell triangular_cube_cell(const TriangularCube& element, const AngleErrors& errors, const Vec2& centre_mm,
                          bool rotated = false);

/// Returns a regular polygon with the area of a circle. The polygon has all symmetries of a cube corner with its
/// default orientation. Three of its sides are parallel to the contour lines of the facets.
Polygon polygon_of_circle(const Vec2& centre_mm, double diameter_mm);

/// Returns the facets of a cube corner with a circular face. Its apex is below `centre_mm`.
Cell round_cube_cell(const RoundCube& element, const AngleErrors& errors, const Vec2& centre_mm);

/// Returns one element that is not rotated. Its lower left corner (prism) or its apex (cube corner) is at the origin.
/// For ruled cells, this is the largest cell.
Cell element_cell(const Element& element, const AngleErrors& errors = {});

/// Returns the cells in which an array's elements differ, apart from rotations about z: all cells of a ruled pattern,
/// and element_cell() for the other kinds of elements.
std::vector<Cell> distinct_cells(const Element& element, const AngleErrors& errors = {});

/// Returns an element at the position and rotation of `cell`, with the given errors.
/// \pre cell.is_element
Cell element_in_place_of(const Cell& cell, const Element& element, const AngleErrors& errors);

/// Returns the depth of an element from z = 0 to its root or apex.
double element_depth_mm(const Element& element, const AngleErrors& errors = {});

/// Returns the cant of a cube corner. A prism has no cant.
Cant cant_of(const Element& element);

/// Returns the largest angle between a facet of an element and the xy plane.
double steepest_facet_deg(const Element& element, const AngleErrors& errors);

/// Returns the height above z = 0 to which errors or cant raise the highest point of an element's rim. Returns 0 if the
/// rim is not above z = 0.
double element_top_mm(const Element& element, const AngleErrors& errors);

/// Returns the outline of one element's aperture, shifted such that its bounding box begins at the origin.
Polygon aperture_outline(const Element& element);

}  // namespace retrace::geometry
