#pragma once

// Beams of the exact tracer: parallel light with a polygonal cross-section, its path length and its entry point.

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
#include "surface_models/facet_form.h"
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

/// Length of the light's path in the material up to a point p. It is a linear function of p, because all interfaces are
/// plane and all light of a beam is parallel. Along the beam, it increases by 1 per mm inside the part and by 0
/// outside.
struct PathLength {
  double constant_mm = 0.0;
  Vec3 slope = Vec3::Zero();

  double at(const Vec3& p) const { return constant_mm + slope.dot(p); }

  /// Returns the path length after an interface. It is continuous on the plane of the interface and increases by
  /// `growth` per mm along the new direction.
  PathLength continued(const Plane& plane, const Vec3& direction, double growth) const {
    const double across = (growth - slope.dot(direction)) / plane.normal.dot(direction);
    return {constant_mm - across * plane.offset_mm, slope + across * plane.normal};
  }
};

/// Point of the entrance face through which the light at a point p entered. It is an affine function of p, because all
/// interfaces are plane and all light of a beam is parallel.
struct EntryPoint {
  Vec2 constant_mm = Vec2::Zero();
  Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();

  Vec2 of(const Vec3& p) const { return constant_mm + slope * p; }

  /// Returns the function after an interface. It is continuous on the plane of the interface and constant along the new
  /// direction.
  EntryPoint continued(const Plane& plane, const Vec3& direction) const {
    const Vec2 across = -(slope * direction) / plane.normal.dot(direction);
    return {constant_mm - across * plane.offset_mm, slope + across * plane.normal.transpose()};
  }
};

/// Identity and position of a cell (an element or a flat area) of the back surface.
struct CellInstance {
  std::uint64_t id = 0;           ///< identical for all copies of a cell, or for all cells of identical shape
  Vec2 offset_mm = Vec2::Zero();  ///< displacement of this copy

  friend bool operator==(const CellInstance& a, const CellInstance& b) {
    constexpr double kRounding_mm = 1e-10;
    return a.id == b.id && (a.offset_mm - b.offset_mm).squaredNorm() <= kRounding_mm * kRounding_mm;
  }
};

/// Cells that the light has met so far.
struct CellTrail {
  std::optional<CellInstance> first;
  bool is_mixed = false;            ///< true if the light has met cells other than `first`
  std::uint64_t sequence_hash = 0;  ///< hash of the sequence of cells, with offsets relative to `first`

  void meet(const CellInstance& cell) {
    if (!first) first = cell;
    is_mixed = is_mixed || !(*first == cell);
    const Vec2 away = cell.offset_mm - first->offset_mm;
    for (const std::uint64_t word : {cell.id, bits_of(away.x()), bits_of(away.y())})
      sequence_hash = ((sequence_hash ^ (sequence_hash >> 29)) + word) * 0x9e3779b97f4a7c15U;
  }

 private:
  /// Returns the length as an integer multiple of 1e-9 mm.
  static std::uint64_t bits_of(double length_mm) { return static_cast<std::uint64_t>(std::llround(1e9 * length_mm)); }
};

/// A facet with a texture or a form that the light has met. It contains the point where the light met the facet, as an
/// affine function of a point of the present beam (see EntryPoint). It also contains the data for the phase shift that
/// the heights of the facet cause.
struct TexturedHit {
  Plane plane;
  Vec3 constant_mm = Vec3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
  surface_models::PhaseTexture phase;
  FacetFrame frame;  ///< frame in which the form of the facet is defined
  /// Form of the surface. It must outlive the beam. If it is null, the surface has the form of all retro facets
  /// (Optics::facet_form).
  const surface_models::FacetForm* form = nullptr;
  /// Change of the optical path per height of the form. Heights that point out of the part are positive. The value is 0
  /// for facets without form.
  double path_per_height = 0.0;

  Vec3 of(const Vec3& p) const { return constant_mm + slope * p; }

  /// Returns the function after an interface. It is continuous on the plane of the interface and constant along the new
  /// direction.
  TexturedHit continued(const Plane& at, const Vec3& direction) const {
    const Vec3 across = -(slope * direction) / at.normal.dot(direction);
    TexturedHit hit = *this;
    hit.constant_mm -= across * at.offset_mm;
    hit.slope += across * at.normal.transpose();
    return hit;
  }
};

/// Displacements in x and y from a position to all positions at which an identical beam exists.
using InstanceOffsets = std::vector<Vec2>;

/// Light with one direction and one state of polarization, which passes through a polygon.
struct Beam {
  Corners corners;  ///< corners of the polygon on the plane where the beam starts
  Vec3 direction = Vec3::UnitZ();
  CoherentLight light;    ///< light, not reduced by the absorption in the material; see `transmission`
  double phase_mm = 0.0;  ///< phase of the plane wave, extrapolated to the origin, as an optical path length
  CellTrail trail;
  /// Fraction of the area of the entrance face through which the light of this beam entered.
  double area_fraction = 1.0;
  /// Transmittance of the material along the path from the entrance face to the start of this beam. It is the mean over
  /// the polygon `corners`.
  double transmission = 1.0;
  double power = 0.0;      ///< power at the start of the beam, as a fraction of the incident power
  PathLength path_length;  ///< length of the path in the material
  EntryPoint entry;        ///< point of the entrance face where the light entered
  /// Facets that the light has met, in order. The list contains the facets with a form and, if BeamPolicy::keeps_phases
  /// is set, the textured facets.
  std::vector<TexturedHit> hits;
  Plane start;  ///< the beam is in the half space start.height(p) >= 0
  bool inside = true;
  /// Role of the last face through which light left the part.
  geometry::FacetRole last_exit_role = geometry::FacetRole::retro_facet;
  std::uint32_t depth = 0;                  ///< number of interfaces so far
  std::uint32_t steps_since_interface = 0;  ///< number of steps since the last interface
  /// Displacements from this beam to all identical beams at identical elements, including the displacement 0 of this
  /// beam. The pointer is null if the beam represents only itself.
  std::shared_ptr<const InstanceOffsets> instance_offsets;
  /// Index in TranslationalSymmetry::regions() of the region that contains all `instance_offsets`. It is used only for
  /// parts with zones (regions with different arrays).
  std::uint32_t region = 0;

  double instance_count() const { return instance_offsets ? static_cast<double>(instance_offsets->size()) : 1.0; }
  /// Returns the power of this beam and of all identical beams in `instance_offsets`, as a fraction of the incident
  /// power.
  double total_power() const { return instance_count() * power; }
};

/// Queue of beams that have not been traced yet. The queue is a deque, because beams are large and should not be copied
/// when the queue grows.
using WaitingBeams =
    boost::container::deque<Beam, void, boost::container::deque_options_t<boost::container::block_size<32>>>;

/// Polygon on which a beam meets a rough facet. It contains the light of the beam and the power that the facet
/// scatters.
struct ScatterSite {
  Corners corners;  ///< corners of the illuminated polygon on the facet
  Vec3 direction = Vec3::UnitZ();
  Light light;                  ///< incident light, not reduced by the absorption in the material
  PathLength path_length;       ///< length of the path in the material
  Vec3 normal = Vec3::UnitZ();  ///< normal of the facet, which points out of the part
  double area_fraction = 0.0;   ///< fraction of the area of the entrance face through which this light entered
  double scattered = 0.0;       ///< scattered power as a fraction of the incident power
  bool inside = true;
  /// Displacements in x and y from this site to all sites at which an identical beam meets an identical facet. The list
  /// includes the displacement 0 of this site. The pointer is null if there is no other site.
  std::shared_ptr<const InstanceOffsets> instance_offsets;
};

/// Returns the copy of a beam at another position of an array. The copy represents only itself.
/// \param to_source unit vector to the source; the phase of the incident wave at the new position depends on it
/// \param index refractive index of the medium in which the beam travels
Beam moved(Beam beam, const Vec2& by_mm, const Vec3& to_source, double index);

/// Coordinate axes of a beam: u and v are perpendicular to the beam, and w is its direction.
struct Frame {
  Vec3 u, v, w;

  explicit Frame(const Vec3& direction) : w(direction) {
    u = std::abs(w.z()) < 0.9 ? Vec3(w.y(), -w.x(), 0.0).normalized() : Vec3(0.0, w.z(), -w.y()).normalized();
    v = w.cross(u);
  }
  Vec2 across(const Vec3& p) const { return {u.dot(p), v.dot(p)}; }
};

/// Distance along a beam to a plane, as a linear function of the coordinates (u, v) of Frame.
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

/// Returns the projection of a polygon along the beam, counter-clockwise. Corners closer than `merge_mm` are merged.
FlatPolygon flattened(const Corners& corners, const Frame& frame, double merge_mm);

/// Returns the projection of a flat polygon, along the beam, onto a plane.
Corners lifted(const FlatPolygon& polygon, const Frame& frame, const Distance& distance);

/// Returns the part of a polygon where `plane.height` >= 0. The result is empty if there is no such part.
Corners cut(const Corners& corners, const Plane& plane);

/// Returns the portion of a polygon that is inside a convex outline in plan view (projection along z).
Corners cut_to_outline(Corners corners, const geometry::Polygon& outline);

/// Returns the mean over a polygon of exp(-absorption * path length). The result is exact except for rounding.
double mean_transmission(const Corners& corners, const PathLength& path_length, double absorption_per_mm);

}  // namespace retrace::raytrace
