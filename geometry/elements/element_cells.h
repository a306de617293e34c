#pragma once

// The elements themselves, seen from above: prisms and cube corners as planes over polygons, with their errors of angle
// and cant.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// What a face of the part is there for; the ledger books light that leaves by the role of the face it left through.
enum class FacetRole : std::uint8_t {
  entrance,     ///< flat face at z = +thickness
  retro_facet,  ///< a facet of an element
  flat_back,    ///< flat land, margin or omitted element on z = 0
  inner_wall,   ///< vertical wall between cells of different depth
  border_wall,  ///< vertical wall that closes what the border of the array cuts
  side          ///< side of the plate
};

/// A plane as a height over the part's xy plane: z = height_mm + slope . (x, y).
struct HeightPlane {
  double height_mm = 0.0;
  Vec2 slope = Vec2::Zero();

  double at(const Vec2& p) const { return height_mm + slope.dot(p); }
};

/// One facet of an element seen from above: its outline and the plane it lies in.
struct CellFacet {
  Polygon outline;
  HeightPlane plane;
  bool is_edge = false;  ///< a strip of a rounded or chamfered edge, or a flank of a scratch
  /// Over which the centroid of the whole facet lies, whatever edges, scratches and borders take of it: the origin of
  /// what its form is told in. None of land and edges.
  std::optional<Vec2> middle_mm = {};
};

/// An element (its facets in the contract's order), or a piece of flat land (on z = 0).
struct Cell {
  bool is_element = true;
  Polygon outline;
  std::vector<CellFacet> facets;
  Vec2 at_mm = Vec2::Zero();  ///< an element's corner or centre
  bool rotated = false;
};

/// A right triangular prism with its lower left corner at `corner_mm`; `rotated` by 90 degrees about z it has its roof
/// edge along x (base = width then).
Cell rtp_cell(const RtpElement& element, const AngleErrors& errors, const Vec2& corner_mm, bool rotated = false);

/// A full cube corner with its apex over `centre_mm` and, without errors and cant, its three highest rim points on z =
/// 0.
Cell hexagonal_cube_cell(const HexagonalCube& element, const AngleErrors& errors, const Vec2& centre_mm);

/// A triangular cube corner with its apex over `centre_mm` and, without errors and cant, its rim on z = 0; `rotated` by
/// 180 degrees about z, errors and cant included.
Cell triangular_cube_cell(const TriangularCube& element, const AngleErrors& errors, const Vec2& centre_mm,
                          bool rotated = false);

/// One element, unrotated, with its lower left corner (RTP) or its apex (cube corners) at the origin.
Cell element_cell(const Element& element, const AngleErrors& errors = {});

/// The element that stands in the place of `cell`, with its own errors. \pre cell.is_element
Cell element_in_place_of(const Cell& cell, const Element& element, const AngleErrors& errors);

/// Depth of an element from z = 0 to its root or apex.
double element_depth_mm(const Element& element, const AngleErrors& errors = {});

/// The cant of a cube corner; none for prisms.
Cant cant_of(const Element& element);

/// Largest angle between a facet of an element and the xy plane.
double steepest_facet_deg(const Element& element, const AngleErrors& errors);

/// How far its errors or its cant lift the rim of an element above z = 0; 0 if they do not.
double element_top_mm(const Element& element, const AngleErrors& errors);

/// The outline of one element's aperture, its bounding box starting at the origin.
Polygon aperture_outline(const Element& element);

}  // namespace retrace::geometry
