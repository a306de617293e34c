#pragma once

// Beams of the exact tracer: parallel light with a polygonal cross-section, its path length and where it entered.

#include <Eigen/Geometry>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "raytrace/exact/flat_polygon.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/light/coherent_light.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::raytrace {

/// Corners of a plane convex polygon in space.
using Corners = boost::container::small_vector<Vec3, 8>;

/// A plane normal . p = offset.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset_mm = 0.0;

  double height(const Vec3& p) const { return normal.dot(p) - offset_mm; }
};

/// The way that light has gone in the material before it comes to a point: linear in the point, since all interfaces
/// are plane and all light of a beam is parallel. Along the beam it grows by 1 inside and by 0 outside.
struct PathLength {
  double constant_mm = 0.0;
  Vec3 slope = Vec3::Zero();

  double at(const Vec3& p) const { return constant_mm + slope.dot(p); }

  /// Beyond an interface: equal on its plane, growing by `growth` along the new direction.
  PathLength continued(const Plane& plane, const Vec3& direction, double growth) const {
    const double across = (growth - slope.dot(direction)) / plane.normal.dot(direction);
    return {constant_mm - across * plane.offset_mm, slope + across * plane.normal};
  }
};

/// The point of the entrance face that the light at a place came in through: affine in the place, for the same reason.
struct EntryPoint {
  Vec2 constant_mm = Vec2::Zero();
  Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();

  Vec2 of(const Vec3& p) const { return constant_mm + slope * p; }

  /// Beyond an interface: equal on its plane, constant along the new direction.
  EntryPoint continued(const Plane& plane, const Vec3& direction) const {
    const Vec2 across = -(slope * direction) / plane.normal.dot(direction);
    return {constant_mm - across * plane.offset_mm, slope + across * plane.normal.transpose()};
  }
};

/// A cell of the back surface, wherever it stands.
struct CellPlace {
  std::uint64_t id = 0;           ///< the same for all copies of a patch
  Vec2 offset_mm = Vec2::Zero();  ///< by which this copy is moved
  double height_mm = 0.0;         ///< and along z

  friend bool operator==(const CellPlace& a, const CellPlace& b) {
    return a.id == b.id && (a.offset_mm - b.offset_mm).squaredNorm() == 0.0;
  }
};

/// Which cells light has met on its way.
struct CellTrail {
  std::optional<CellPlace> first;
  bool is_mixed = false;  ///< others as well

  void meet(const CellPlace& cell) {
    if (!first) first = cell;
    is_mixed = is_mixed || !(*first == cell);
  }
};

/// A facet with a texture or a form that light has met: where, as an affine function of where the light is now (as
/// EntryPoint), and what the heights there did to its phase.
struct TexturedHit {
  Plane plane;
  Vec3 constant_mm = Vec3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
  surface_models::PhaseTexture phase;
  FacetFrame frame;              ///< of the form
  double path_per_height = 0.0;  ///< by which a height out of the part lengthens the way; 0: without a form

  Vec3 of(const Vec3& p) const { return constant_mm + slope * p; }

  /// Beyond an interface: equal on its plane, constant along the new direction.
  TexturedHit continued(const Plane& at, const Vec3& direction) const {
    const Vec3 across = -(slope * direction) / at.normal.dot(direction);
    TexturedHit hit = *this;
    hit.constant_mm -= across * at.offset_mm;
    hit.slope += across * at.normal.transpose();
    return hit;
  }
};

/// Light of one direction and polarisation through a polygon.
struct Beam {
  Corners corners;  ///< of the cross-section, on the plane it starts from
  Vec3 direction = Vec3::UnitZ();
  CoherentLight light;    ///< before absorption
  double phase_mm = 0.0;  ///< of the field at the origin, with the wave continued there: an optical path
  CellTrail trail;
  double share = 1.0;             ///< of the entrance's cross-section
  double power = 0.0;             ///< that it starts with, as a share of the incident
  PathLength path_length;         ///< in the material
  EntryPoint entry;               ///< where it came in
  std::vector<TexturedHit> hits;  ///< in their order: with BeamPolicy::keeps_phases, and of facets with a form
  Plane start;                    ///< the beam lies where start.height(p) >= 0
  bool inside = true;
  geometry::FacetRole left_through = geometry::FacetRole::retro_facet;  ///< last face it left the part through
  std::uint32_t depth = 0;                                              ///< interfaces so far
  std::uint32_t level_steps = 0;                                        ///< without an interface
};

/// Where light of a beam meets a rough facet: the light before, and what the facet scatters of its power.
struct ScatterSite {
  Corners corners;  ///< of the piece of the facet
  Vec3 direction = Vec3::UnitZ();
  Light light;                  ///< before absorption
  PathLength path_length;       ///< in the material
  Vec3 normal = Vec3::UnitZ();  ///< of the facet, out of the part
  double share = 0.0;           ///< of the entrance's cross-section
  double scattered = 0.0;       ///< power, as a share of the incident
  bool inside = true;
};

/// Coordinates across a beam: (u, v) across, w along.
struct Frame {
  Vec3 u, v, w;

  explicit Frame(const Vec3& direction) : w(direction) {
    u = std::abs(w.z()) < 0.9 ? Vec3(w.y(), -w.x(), 0.0).normalized() : Vec3(0.0, w.z(), -w.y()).normalized();
    v = w.cross(u);
  }
  Vec2 across(const Vec3& p) const { return {u.dot(p), v.dot(p)}; }
};

/// Distance along a beam to a plane, linear in the coordinates across it.
struct Distance {
  double constant = 0.0;
  Vec2 slope = Vec2::Zero();

  Distance(const Frame& frame, const Plane& plane) {
    const double along = plane.normal.dot(frame.w);
    constant = plane.offset_mm / along;
    slope = -Vec2(plane.normal.dot(frame.u), plane.normal.dot(frame.v)) / along;
  }
  double at(const Vec2& p) const { return constant + slope.dot(p); }
};

/// A polygon in space seen along a beam, counter-clockwise; corners nearer than `merge_mm` are one.
FlatPolygon flattened(const Corners& corners, const Frame& frame, double merge_mm);

/// A polygon across a beam moved along it onto a plane.
Corners lifted(const FlatPolygon& polygon, const Frame& frame, const Distance& distance);

/// The part of a polygon where `plane.height` >= 0; empty if none.
Corners cut(const Corners& corners, const Plane& plane);

/// Mean over a polygon of exp(-absorption * path length). Exact to rounding.
double mean_transmission(const Corners& corners, const PathLength& path_length, double absorption_per_mm);

}  // namespace retrace::raytrace
