#pragma once

// The part that is traced: a plate with a back surface of elements. The back surface is stored as a few distinct
// patches, each of which is placed many times.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/part/surface_patch.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

class FacetPlanes;

/// Placement of a patch of the back surface in the part frame.
struct Placement {
  std::uint32_t patch = 0;
  Vec2 offset_mm = Vec2::Zero();
  double height_mm = 0.0;  ///< shift along z; 0 unless the part has a substrate
};

/// Elements of one zone of a part.
struct ZoneElements {
  std::int64_t full = 0;
  std::int64_t partial = 0;  ///< elements that a border of the zone cuts
  double area_mm2 = 0.0;     ///< area in plan
  std::size_t cells = 0;     ///< number of cells of the zone in the patch; the cells are stored zone by zone
};

/// Region of the plate in which the elements form a periodic lattice.
struct LatticeRegion {
  Polygon outline;                 ///< convex, counter-clockwise
  std::array<Vec2, 2> periods_mm;  ///< two lattice vectors at right angles to each other
};

/// Opening in an opaque plane above the entrance face, such as the edge of a mount.
struct FaceOpening {
  Polygon outline;         ///< convex border of the opening, counter-clockwise
  double height_mm = 0.0;  ///< height of the plane of the opening above the entrance face, >= 0
};

/// Solid part in the part frame. It is a plate 0 <= z <= thickness with the flat entrance face z = thickness and the
/// elements below the plate. The rims of the elements are on z = 0 unless errors of angle or cant move them.
/// The sides of a finite part are vertical walls over a convex outline, and the back surface bounds it at the bottom.
/// An infinite part repeats with a rectangular period.
///
/// The back surface is stored as few distinct patches and many placements. A large array then needs only the memory of
/// its distinct patches (interior, borders, corners).
struct Part {
  PartSpec spec;
  double thickness_mm = 0.0;
  double element_depth_mm = 0.0;  ///< the back surface is within -element_depth_mm <= z <= top_mm
  double top_mm = 0.0;            ///< highest point of the back surface; 0 for nominal facets
  double size_mm = 0.0;           ///< size of an element in plan; scale for tolerances
  std::vector<SurfacePatch> patches;
  std::vector<Placement> placements;
  /// Convex outline of a finite part, counter-clockwise; empty for an infinite part. For a part with notches or holes,
  /// it is the convex hull.
  Polygon outline;
  /// Convex polygons that make up the entrance face of a part with notches or holes. For other parts it is empty, and
  /// the outline is the entrance face. The sides that are not on the hull are then facets of the back surface, with the
  /// role `side`, and `top_mm` is the height of the entrance face.
  std::vector<Polygon> entrance_pieces;
  /// Convex area of the entrance face inside the chamfer. Light that meets the face outside this area is blocked.
  /// Empty: there is no chamfer.
  Polygon clear_face;
  /// Opening of the mount. Incident and returning light must pass through it.
  std::optional<FaceOpening> mount;
  /// Period of an infinite part. The surface covers [-periods_beyond, 1 + periods_beyond] periods in x and y.
  std::optional<Vec2> period_mm;
  int periods_beyond = 0;  ///< number of additional periods of an infinite part on each side
  /// Region of a finite array of equal elements in which the surface equals the surface of the infinite lattice. A
  /// period of the lattice begins at `lattice_anchor_mm`.
  std::optional<Rectangle> lattice_region_mm;
  Vec2 lattice_anchor_mm = Vec2::Zero();
  std::int64_t elements_full = 0;  ///< number of complete elements; for an infinite part, per period
  std::int64_t elements_partial = 0;
  std::vector<ZoneElements> zones;  ///< set only if the part has zones
  /// Regions that together cover the plate. They are set only if the part has zones or an outline.
  std::vector<LatticeRegion> lattice_regions;
  double entrance_area_mm2 = 0.0;     ///< area of the entrance face; for an infinite part, of one period
  double retro_facet_area_mm2 = 0.0;  ///< area of the retro facets; for an infinite part, in one period

  /// Returns a number that identifies the element to which a cell belongs. Cells of one element have the same number,
  /// and cells of different elements have different numbers.
  /// \pre `patch` is stored in `patches`, and `cell` is stored in `patch.cells`
  std::uint64_t element_id(const SurfacePatch& patch, const PatchCell& cell) const {
    const auto p = static_cast<std::uint64_t>(&patch - patches.data());
    const auto own = static_cast<std::uint64_t>(&cell - patch.cells.data());
    return (p << 32) | cell.first_of_element.value_or(static_cast<std::uint32_t>(own));
  }
};

/// Builds the part.
/// \param origin_mm shift in the plane (finite parts only), for tests of numerical robustness
/// \pre the specification is consistent (design::parse_design() checks it)
/// \throw InputError if the part contains no complete element, or if a rim reaches the entrance face
Part build_part(const PartSpec& spec, const Vec2& origin_mm = Vec2::Zero());

/// Builds a finite part as build_part(spec) does, but with individual facets for each element. Elements that are not
/// given are replaced by flat land. Outlines are nominal, and vertical walls connect neighbours of different height.
/// \pre spec.array.extent is finite; the facets slope in the same directions as nominal facets
/// \throw InputError in the same cases as build_part(spec), and if planes belong to no complete element of the array
Part build_part(const PartSpec& spec, const FacetPlanes& planes);

/// Returns convex polygons that make up the entrance face of a finite part.
std::vector<Polygon> entrance_polygons(const Part& part);

/// Returns the area of a facet in mm2.
double facet_area(const SurfacePatch& patch, const PatchFacet& facet);

/// Exposed walls between neighbouring elements of a part.
struct InnerWalls {
  double area_mm2 = 0.0;
  double highest_mm = 0.0;  ///< largest difference in height between neighbouring elements
  /// Area of the walls, projected along the parameter `towards` of inner_walls(). The walls block this cross section
  /// for light from this direction.
  double projected_mm2 = 0.0;
};

/// Measures the walls of a finite part.
/// \param towards unit vector along which the walls are projected
InnerWalls inner_walls(const Part& part, const Vec3& towards);

}  // namespace retrace::geometry
