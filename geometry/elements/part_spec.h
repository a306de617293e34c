#pragma once

// Specification of a part as data: kind and sizes of its elements, errors of angle, edges, scratches, array, substrate
// and plate.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/elements/array_layout.h"
#include "geometry/substrate/substrate.h"

namespace retrace::geometry {

/// Right triangular prism: two facets that meet at a roof edge along y. The prism is open towards +z.
struct RtpElement {
  double base_mm = 0.0;          ///< size across the roof edge, along x; > 0
  double width_mm = 0.0;         ///< size along the roof edge, which is along y; > 0
  double apex_angle_deg = 90.0;  ///< included angle of the two facets; 60..120
};

/// Cant: angle between +z and a cube corner's axis, which points from its apex into the part. The three facets are
/// rotated together about the apex. The outline in plan is not changed.
struct Cant {
  double deg = 0.0;  ///< 0..30
  /// azimuth of the inclination, from +x towards +y; for a rotated cell it is rotated with the cell
  double azimuth_deg = 0.0;
};

/// Full cube corner with a hexagonal aperture and its apex at the bottom. In plan, one dihedral edge points towards +x.
struct HexagonalCube {
  double aperture_mm = 0.0;  ///< diameter of the hexagon's circumscribed circle: 2 a sqrt(2/3) for cube edge a; > 0
  Cant cant = {};
};

/// Cube corner with a triangular aperture and its apex at the bottom. In plan, one dihedral edge points towards +x
/// (rotated cells: towards -x).
struct TriangularCube {
  double aperture_mm = 0.0;  ///< diameter of the triangle's circumscribed circle; > 0
  Cant cant = {};
};

/// Single cube corner with a circular face, for ranging and surveying. Its shape is a cube corner inside a cylinder
/// about the cube's axis. The highest points of the nominal facets inside the cylinder are at z = 0.
struct RoundCube {
  double diameter_mm = 0.0;  ///< diameter of the entrance face; > 0
  Cant cant = {};
  double chamfer_mm = 0.0;  ///< width of the chamfer at the rim of the entrance face, in plan; the chamfer blocks light
  double recess_mm = 0.0;   ///< depth of the entrance face below the edge of the mount, >= 0
  /// Diameter of the circular edge of the mount. The mount blocks light outside this circle. 0: there is no mount.
  double mount_diameter_mm = 0.0;
  /// Convex outline that also limits the entrance face, or null. The centre of its bounding box is above the apex.
  std::shared_ptr<const PlanRegion> outline = {};
};

struct RuledPattern;

/// Cells between sets of parallel V-grooves that a ruling machine cuts into the master of a sheeting. The grooves fill
/// the array, so that the cells are not repeated by an arrangement of their own.
struct RuledCells {
  std::shared_ptr<const RuledPattern> pattern;  ///< never null (geometry/elements/ruled_pattern.h)
};

using Element = std::variant<RtpElement, HexagonalCube, TriangularCube, RoundCube, RuledCells>;

/// Errors of the facets' angles, in arc minutes. Facets are rotated about the root or apex, which does not move. The
/// element's outline in plan stays nominal, so its rims end above or below z = 0. If both kinds of error are given,
/// their rotations are added.
struct AngleErrors {
  /// Error of the angle between two neighbouring facets; each facet is rotated by half of it. A positive value opens
  /// the angle. Prism: only the first value is used, which is equivalent to a larger apex angle. Cube corner: values
  /// for the dihedral edges at 0, 120 and 240 degrees.
  std::array<double, 3> dihedral_error_arcmin{};
  /// Rotation of each facet towards the xy plane. Prism: values for the facets towards -x and +x. Cube corner: facet k
  /// is between the dihedral edges at 120 k and 120 (k + 1) degrees. It is rotated about its horizontal line through
  /// the apex.
  std::array<double, 3> facet_tilt_arcmin{};
  friend bool operator==(const AngleErrors&, const AngleErrors&) = default;
};

/// Random tilts of individual facets. They differ from element to element.
struct RandomTilts {
  double sigma_arcmin = 0.0;  ///< standard deviation of the tilt of each facet; Gaussian and independent; >= 0
  std::uint32_t seed = 1;
};

/// Rounding or chamfering of edges by wear and by the tool's tip. The sizes are in mm and apply to the edges of all
/// elements; 0 means a sharp edge. Arcs are approximated by chords whose corners are on the circle. A row of chords is
/// therefore exactly as wide as the arc.
struct EdgeShape {
  double root_radius_mm = 0.0;   ///< radius of roots, where facets of one element meet
  double root_chamfer_mm = 0.0;  ///< width of a flat that replaces the root; not together with root_radius_mm
  double rim_radius_mm = 0.0;    ///< radius of rims, where neighbouring elements meet, or an element and land
  double rim_chamfer_mm = 0.0;   ///< width of a flat that replaces the rim; not together with rim_radius_mm
  int chords = 16;               ///< number of chords in an arc; even, 4..64

  bool rounds_roots() const { return root_radius_mm > 0.0 || root_chamfer_mm > 0.0; }
  bool rounds_rims() const { return rim_radius_mm > 0.0 || rim_chamfer_mm > 0.0; }
  bool is_sharp() const { return !rounds_roots() && !rounds_rims(); }
  friend bool operator==(const EdgeShape&, const EdgeShape&) = default;
};

/// Groove with a V-shaped cross section along one facet of a prism, from root to rim. A chipped cutting edge causes
/// such a scratch.
struct Scratch {
  std::size_t facet = 0;     ///< 0: facet towards -x, 1: facet towards +x; rotated together with a rotated prism
  double position_mm = 0.0;  ///< centre along the roof edge, measured from the prism's centre towards +y
  double width_mm = 0.0;     ///< width along the roof edge; > 0
  /// depth normal to the facet, into the material; < 0: a ridge that protrudes from the facet
  double depth_mm = 0.0;
};

/// Specification of a part with one kind of element: the element, how it is repeated, and the plate. Lengths are in mm
/// in the part frame (z towards the light, nominal rims on z = 0).
struct PartSpec {
  Element element;
  AngleErrors angle_errors;
  RandomTilts random_tilts;  ///< finite parts only
  EdgeShape edges;
  std::vector<Scratch> scratches;  ///< scratches of each prism; scratches on one facet do not overlap
  ArrayLayout array;
  /// Surface on which the elements are placed. If it is not set, the elements are on the plane z = 0. A substrate
  /// requires a finite array without offsets that is not `single`.
  std::optional<Substrate> substrate;
  bool is_pin_bundle = false;  ///< true for a honeycomb whose cubes are the ends of pins
  double thickness_mm = 0.0;   ///< thickness of the plate between the entrance face and z = 0; > element_top_mm()
};

}  // namespace retrace::geometry
