#pragma once

// Joins the facets of neighbouring cells into a watertight patch of the back surface. Vertical walls are added where
// the heights of neighbouring facets differ.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Facet of a cell in the part, already cut by the part's border. Input of build_patch().
struct Tile {
  Polygon outline;
  HeightPlane plane;
  FacetRole role = FacetRole::retro_facet;
  std::uint32_t cell = 0;  ///< cell of the tile; tiles of one cell must be consecutive in the input
  /// if false, the tile is not output; it only provides walls and shared vertices for its neighbours
  bool is_output = true;
  std::optional<Vec2> centroid_mm = {};  ///< position defined by CellFacet::centroid_mm
};

/// A plane, convex face of the back surface.
struct PatchFacet {
  Vec3 normal = Vec3::Zero();  ///< unit vector, out of the part
  double offset_mm = 0.0;      ///< normal . p for all points p of the plane
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  FacetRole role = FacetRole::retro_facet;
  std::optional<Vec2> centroid_mm = {};  ///< as CellFacet::centroid_mm
};

/// Consecutive facets of one cell, and their bounding box.
struct PatchCell {
  std::uint32_t first_facet = 0;
  std::uint32_t facet_count = 0;
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
  /// Index of the first cell of the element to which this cell belongs. If the index is not set, the cell is a complete
  /// element.
  std::optional<std::uint32_t> first_of_element = {};
};

/// Connected patch of the part's back surface, in local coordinates. It contains all faces below the plate except the
/// outer walls. Triangles of neighbouring facets share complete edges (no T-junctions).
struct SurfacePatch {
  std::vector<Vec3> vertices;
  std::vector<PatchFacet> facets;
  std::vector<std::uint32_t> corners;  ///< corners of the facets, counter-clockwise as seen from outside
  std::vector<PatchCell> cells;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_facet;

  /// Borders of the surface. `border_walls` contains the vertical walls between the surface and z = 0, where the
  /// surface is below z = 0. `border_rim` contains the lower borders of the plate's sides. A side begins at z = 0, or
  /// at the surface where the surface is above z = 0. The vertices of a rim are ordered such that the part is on the
  /// left as seen from +z. The first and the last vertex of a rim are the highest vertices at their (x, y).
  std::vector<std::vector<std::uint32_t>> border_walls;
  std::vector<std::vector<std::uint32_t>> border_rim;
};

/// Borders of a part with an outline, in coordinates of the patch.
struct PatchRim {
  std::vector<std::vector<Vec2>> borders;  ///< closed polygons; walls on their sides are border walls
  /// Convex hull of a part with notches or holes; empty for other parts. Sides of the part that are not on the hull
  /// become facets of the patch.
  Polygon hull;
  double top_mm = 0.0;  ///< height of the entrance face, at which these facets end
};

/// Joins tiles into a surface, and adds vertical walls where neighbouring tiles differ in height. A wall belongs to the
/// deeper of its two tiles. Walls on the border of `block` get the role border_wall, other walls get inner_wall.
/// \param block area that the array fills
/// \param size_mm size of an element, for tolerances
/// \param rim borders of a part with an outline
SurfacePatch build_patch(const std::vector<Tile>& tiles, const Rectangle& block, double size_mm,
                         const PatchRim& rim = {});

}  // namespace retrace::geometry
