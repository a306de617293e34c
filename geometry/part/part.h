#pragma once

// The part that is traced: a plate with its back surface of elements, stored as few distinct patches in many places.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/part/surface_patch.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// A patch of the back surface, moved to its place in the part frame.
struct Placement {
  std::uint32_t patch = 0;
  Vec2 offset_mm = Vec2::Zero();
  double height_mm = 0.0;  ///< along z; other than 0 on a base alone
};

/// What a zone of a part has.
struct ZoneElements {
  std::int64_t full = 0;
  std::int64_t partial = 0;  ///< cut by a border of the zone
  double area_mm2 = 0.0;     ///< in plan
  std::size_t cells = 0;     ///< of the patch, which has those of zone after zone
};

/// A region of the plate in which the elements form a periodic lattice.
struct LatticeRegion {
  Polygon outline;                 ///< convex, counter-clockwise
  std::array<Vec2, 2> periods_mm;  ///< two lattice vectors at right angles
};

/// A solid part in the part frame: a plate 0 <= z <= thickness whose flat entrance face is z = thickness, and below it
/// the elements, whose rims lie on z = 0 but for errors of angle and cant. A finite part is the prism over a convex
/// outline, open at the bottom only where the back surface ends it; an infinite one repeats with a rectangular period.
///
/// The back surface is stored as few distinct patches and many placements, so that a large array costs the memory of
/// its different pieces (interior, borders, corners).
struct Part {
  PartSpec spec;
  double thickness_mm = 0.0;
  double element_depth_mm = 0.0;  ///< the back surface lies in -element_depth_mm <= z <= top_mm
  double top_mm = 0.0;            ///< highest point of the back surface; 0 for nominal facets
  double size_mm = 0.0;           ///< of an element in plan, the scale for tolerances
  std::vector<SurfacePatch> patches;
  std::vector<Placement> placements;
  Polygon outline;                ///< finite parts; counter-clockwise
  std::optional<Vec2> period_mm;  ///< infinite parts: the surface covers [-margin, 1 + margin] periods in x and y
  int periods_beyond = 0;         ///< that margin
  /// Finite arrays of equal elements: where the surface is that of the lattice, which starts at `lattice_anchor_mm`.
  std::optional<Rectangle> lattice_region_mm;
  Vec2 lattice_anchor_mm = Vec2::Zero();
  std::int64_t elements_full = 0;  ///< finite: whole elements; infinite: elements per period
  std::int64_t elements_partial = 0;
  std::vector<ZoneElements> zones;             ///< parts of zones
  std::vector<LatticeRegion> lattice_regions;  ///< parts with zones: regions that together cover the plate
  double entrance_area_mm2 = 0.0;              ///< infinite parts: area of one period
  double retro_facet_area_mm2 = 0.0;           ///< infinite parts: area in one period

  /// Returns a number that identifies the element to which a cell belongs. Cells of one element have the same number,
  /// and cells of different elements have different numbers.
  /// \pre `patch` is stored in `patches`, and `cell` is stored in `patch.cells`
  std::uint64_t number_of(const SurfacePatch& patch, const PatchCell& cell) const {
    const auto p = static_cast<std::uint64_t>(&patch - patches.data());
    const auto own = static_cast<std::uint64_t>(&cell - patch.cells.data());
    return (p << 32) | cell.first_of_element.value_or(static_cast<std::uint32_t>(own));
  }
};

/// Builds the part. `origin_mm` moves it in the plane (finite parts), for tests of numerical robustness.
/// \pre the specification is consistent (studies::parse_design checks it)
/// \throw InputError when it holds no whole element, or when a rim reaches the entrance face
Part build_part(const PartSpec& spec, const Vec2& origin_mm = Vec2::Zero());

/// Area of a facet of a patch.
double facet_area(const SurfacePatch& patch, const PatchFacet& facet);

}  // namespace retrace::geometry
