#pragma once

// What a designer says of a part, as data: the kind and sizes of its elements, errors of angle, edges, scratches,
// array, substrate and plate.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/elements/array_layout.h"
#include "geometry/substrate/substrate.h"

namespace retrace::geometry {

/// Right triangular prism: two facets that meet at a roof edge along y, open towards +z.
struct RtpElement {
  double base_mm = 0.0;          ///< across the roof edge, along x; > 0
  double width_mm = 0.0;         ///< along the roof edge, along y; > 0
  double apex_angle_deg = 90.0;  ///< included angle of the two facets; 60..120
};

/// How far the axis of a cube corner, from its apex into the part, leans away from +z. The three facets turn with it as
/// one, about the apex; the outline in plan stays.
struct Cant {
  double deg = 0.0;          ///< 0..30
  double azimuth_deg = 0.0;  ///< towards which it leans, from +x towards +y; of a rotated cell: rotated with it
};

/// Full cube corner with a hexagonal aperture, apex down, one dihedral edge over +x.
struct HexagonalCube {
  double aperture_mm = 0.0;  ///< diameter of the circle round the hexagon, 2 a sqrt(2/3) for cube edge a; > 0
  Cant cant = {};
};

/// Cube corner with a triangular aperture, apex down, one dihedral edge over +x (rotated cells: over -x).
struct TriangularCube {
  double aperture_mm = 0.0;  ///< diameter of the circle round the triangle, whose side is a sqrt(2); > 0
  Cant cant = {};
};

using Element = std::variant<RtpElement, HexagonalCube, TriangularCube>;

/// By how much facets miss their nominal angles, in arc minutes. They turn about the root or apex, which stays in
/// place, and the element's outline in plan stays nominal: its rims end above or below z = 0. Both kinds add up.
struct AngleErrors {
  /// Added to the angle between neighbouring facets, half of it by either; positive opens it. RTP: the first alone, the
  /// same as a larger apex angle. Cube corner: at the dihedral edges at 0, 120 and 240 degrees.
  std::array<double, 3> dihedral_error_arcmin{};
  /// By how much each facet is turned open, towards the xy plane. RTP: the facets towards -x and +x. Cube corner: facet
  /// k lies between the dihedral edges at 120 k and 120 (k + 1) degrees and turns about its horizontal line through the
  /// apex.
  std::array<double, 3> facet_tilt_arcmin{};
  friend bool operator==(const AngleErrors&, const AngleErrors&) = default;
};

/// Tilts of single facets that vary from element to element.
struct RandomTilts {
  double sigma_arcmin = 0.0;  ///< standard deviation of every facet's own tilt, Gaussian and independent; >= 0
  std::uint32_t seed = 1;
};

/// What wear and the tool's tip make of edges, in mm across the facets of all elements; 0: sharp. Arcs are chords with
/// their corners on the circle, so that they take exactly the width of the arc.
struct EdgeShape {
  double root_radius_mm = 0.0;   ///< where facets of one element meet
  double root_chamfer_mm = 0.0;  ///< width of a flat in their place; not both
  double rim_radius_mm = 0.0;    ///< where neighbouring elements meet, or an element and the land beside it
  double rim_chamfer_mm = 0.0;   ///< width of a flat in their place; not both
  int chords = 16;               ///< of an arc across an edge; even, 4..64

  bool rounds_roots() const { return root_radius_mm > 0.0 || root_chamfer_mm > 0.0; }
  bool rounds_rims() const { return rim_radius_mm > 0.0 || rim_chamfer_mm > 0.0; }
  bool is_sharp() const { return !rounds_roots() && !rounds_rims(); }
  friend bool operator==(const EdgeShape&, const EdgeShape&) = default;
};

/// A groove of V section that runs up one facet of a prism from root to rim: what a chip in the cutting edge leaves.
struct Scratch {
  std::size_t facet = 0;     ///< 0: towards -x, 1: towards +x (of a rotated prism: rotated with it)
  double position_mm = 0.0;  ///< of its middle along the roof edge, from the prism's middle towards +y
  double width_mm = 0.0;     ///< along the roof edge; > 0
  double depth_mm = 0.0;     ///< normal to the facet, into the part's material; < 0: a ridge out of it
};

/// What a designer says of a part: one element kind, how it is repeated, and the plate it stands on.
/// Lengths in mm in the part frame (z up to the light, nominal rims on z = 0).
struct PartSpec {
  Element element;
  AngleErrors angle_errors;
  RandomTilts random_tilts;  ///< finite parts only
  EdgeShape edges;
  std::vector<Scratch> scratches;  ///< of every prism; on one facet they do not overlap
  ArrayLayout array;
  /// What elements stand on, of finite arrays that are not `single`; none: the plane z = 0. Offsets are then 0.
  std::optional<Substrate> substrate;
  bool is_pin_bundle = false;  ///< a honeycomb whose cubes are the ends of pins
  double thickness_mm = 0.0;   ///< plate between the entrance face and z = 0; > element_top_mm()
};

}  // namespace retrace::geometry
