#pragma once

// Welds facets of neighbouring cells into a watertight piece of the back surface, with vertical walls where heights
// differ.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// A cell facet as it stands in the part, after the border has cut it: input of build_patch().
struct Tile {
  Polygon outline;
  HeightPlane plane;
  FacetRole role = FacetRole::retro_facet;
  std::uint32_t cell = 0;              ///< tiles of one cell are adjacent in the input
  bool owned = true;                   ///< false: only a neighbour that shapes walls and welds
  std::optional<Vec2> middle_mm = {};  ///< of CellFacet
};

/// One plane convex face of the back surface.
struct PatchFacet {
  Vec3 normal = Vec3::Zero();  ///< unit, out of the part
  double offset_mm = 0.0;      ///< normal . p for every point p of the plane
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  FacetRole role = FacetRole::retro_facet;
  std::optional<Vec2> middle_mm = {};  ///< of CellFacet
};

/// The consecutive facets of one cell and the box round them.
struct PatchCell {
  std::uint32_t first_facet = 0;
  std::uint32_t facet_count = 0;
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
  /// Index of the first cell of the element to which this cell belongs. If it is not set, the cell is an element of its
  /// own.
  std::optional<std::uint32_t> first_of_element = {};
};

/// A welded piece of the part's back surface, everything below the plate but the outer walls, in coordinates local to
/// the piece. Triangles of neighbouring facets share whole edges (no T-junctions).
struct SurfacePatch {
  std::vector<Vec3> vertices;
  std::vector<PatchFacet> facets;
  std::vector<std::uint32_t> corners;  ///< corners of the facets, counter-clockwise seen from outside
  std::vector<PatchCell> cells;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_facet;

  /// Where the surface ends: the walls that close it up to z = 0 where it lies below, and the lower borders of the
  /// plate's sides, with the part on the left seen from +z. A side begins on z = 0 or where the surface ends above it,
  /// and its ends are the highest vertices over their place.
  std::vector<std::vector<std::uint32_t>> border_walls;
  std::vector<std::vector<std::uint32_t>> border_rim;
};

/// Welds tiles into a surface and raises the vertical walls where neighbouring tiles differ in height. A wall belongs
/// to the deeper of its two tiles. Walls on the border of `block` (the area the array fills) get role border_wall,
/// others inner_wall. \param size_mm the size of an element, for tolerances
SurfacePatch build_patch(const std::vector<Tile>& tiles, const Rectangle& block, double size_mm);

}  // namespace retrace::geometry
