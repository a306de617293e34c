#pragma once

// Beams of the exact tracer: parallel light with a polygonal cross-section, its path length and where it entered.

#include <Eigen/Geometry>
#include <boost/container/deque.hpp>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
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
  std::uint64_t id = 0;           ///< the same for all copies of a patch, or for all cells of a shape
  Vec2 offset_mm = Vec2::Zero();  ///< by which this copy is moved

  friend bool operator==(const CellPlace& a, const CellPlace& b) {
    constexpr double kRounding_mm = 1e-10;
    return a.id == b.id && (a.offset_mm - b.offset_mm).squaredNorm() <= kRounding_mm * kRounding_mm;
  }
};

/// Which cells light has met on its way.
struct CellTrail {
  std::optional<CellPlace> first;
  bool is_mixed = false;  ///< others as well
  std::uint64_t met = 0;  ///< tells one order of cells from another, wherever the first of them stands

  void meet(const CellPlace& cell) {
    if (!first) first = cell;
    is_mixed = is_mixed || !(*first == cell);
    const Vec2 away = cell.offset_mm - first->offset_mm;
    for (const std::uint64_t word : {cell.id, bits_of(away.x()), bits_of(away.y())})
      met = ((met ^ (met >> 29)) + word) * 0x9e3779b97f4a7c15U;
  }

 private:
  /// Of a length in steps of 1e-9 mm.
  static std::uint64_t bits_of(double length_mm) { return static_cast<std::uint64_t>(std::llround(1e9 * length_mm)); }
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

/// Offsets in plan, from each of them to others that are alike.
using BeamPlaces = std::vector<Vec2>;

/// Light of one direction and polarisation through a polygon.
struct Beam {
  Corners corners;  ///< of the cross-section, on the plane it starts from
  Vec3 direction = Vec3::UnitZ();
  CoherentLight light;    ///< before absorption
  double phase_mm = 0.0;  ///< of the field at the origin, with the wave continued there: an optical path
  CellTrail trail;
  double share = 1.0;  ///< of the entrance's cross-section
  /// Transmittance of the material up to the start of this beam; mean over the polygon at the start.
  double transmission = 1.0;
  double power = 0.0;             ///< power at the start, as a fraction of the incident power
  PathLength path_length;         ///< in the material
  EntryPoint entry;               ///< where it came in
  std::vector<TexturedHit> hits;  ///< in their order: with BeamPolicy::keeps_phases, and of facets with a form
  Plane start;                    ///< the beam lies where start.height(p) >= 0
  bool inside = true;
  geometry::FacetRole left_through = geometry::FacetRole::retro_facet;  ///< last face it left the part through
  std::uint32_t depth = 0;                                              ///< interfaces so far
  std::uint32_t level_steps = 0;                                        ///< without an interface
  /// At equal elements of an array: where the same beam goes, this one, at the offset 0, included. Null: here alone.
  std::shared_ptr<const BeamPlaces> places;
  /// Parts with zones: index, in EqualPlaces::regions(), of the region that contains `places`.
  std::uint32_t region = 0;

  double place_count() const { return places ? static_cast<double>(places->size()) : 1.0; }
  /// Of this beam and those like it.
  double total_power() const { return place_count() * power; }
};

/// Beams that wait. They are large and many, so that they stay where they are when more come.
using WaitingBeams =
    boost::container::deque<Beam, void, boost::container::deque_options_t<boost::container::block_size<32>>>;

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
  /// Displacements in x and y from this site to all sites at which an identical beam meets an identical facet,
  /// including the displacement 0 to this site. The pointer is null if there is only this site.
  std::shared_ptr<const BeamPlaces> places;
};

/// A beam as it is at another place of an array, and there alone. \param to_source as of the light that came in, of
/// which it has another phase there \param index of where the beam travels
Beam moved(Beam beam, const Vec2& by_mm, const Vec3& to_source, double index);

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
