#pragma once

// Light of single elements behind a curved entrance surface. The light of an element is traced as beams through a
// tangent plane of the surface (docs/theory/fronts.md).

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/element_excerpt.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/faces/tangent_plane.h"
#include "raytrace/light/return_frame.h"

namespace retrace::raytrace {

/// Portion of the incident light that belongs to an element: the light that enters closer to the tangent point of this
/// element than to any other tangent point. Together, the portions of all elements are the light that enters the part.
struct ElementPortion {
  double fraction = 0.0;      ///< fraction of the light that is incident on the part
  Vec2 at_mm = Vec2::Zero();  ///< tangent point in plan
  bool is_at_border = false;  ///< true if the border of the part cuts the portion or is near the element
};

/// An element and its surroundings behind a tangent plane of the entrance surface, for light from one direction. The
/// frame of the excerpt is the frame of the tangent plane, shifted along z. Returned beams refer to members of this
/// object. Therefore, it cannot be copied.
struct ElementScene {
  bool is_lit = true;  ///< false if the portion of the element is empty; all other members are then undefined
  geometry::ElementExcerpt excerpt;
  TangentPlane plane;
  SurfaceSag sag;
  surface_models::FacetForm squared_slope;  ///< see squared_slope(), for the light that enters
  Vec3 to_source = Vec3::UnitZ();           ///< in the frame of the excerpt
  /// Portion of the tangent plane through which the light of the element would enter (ElementPortion,
  /// entry_displacement()).
  geometry::Polygon portion_mm;
  double rim_path_mm = 0.0;  ///< path length of the light from the tangent plane to the rim of the element
  double fraction = 0.0;     ///< fraction of the light that is incident on the part, as in ElementPortion
  /// Factor by which powers of beams in the excerpt are multiplied to obtain fractions of the light that is incident on
  /// the part.
  double power_factor = 0.0;

  ElementScene() = default;
  ElementScene(const ElementScene&) = delete;
  ElementScene& operator=(const ElementScene&) = delete;

  /// Converts a direction from the part frame to the frame of the excerpt.
  Vec3 direction(const Vec3& of_part) const { return plane.frame_from_part * of_part; }
  ReturnFrame frame(const ReturnFrame& of_part) const {
    return {direction(of_part.to_source), direction(of_part.right), direction(of_part.up)};
  }
};

/// One of several directions in which a beam leaves through a curved surface.
struct DirectionSample {
  Vec3 direction;
  double power_fraction = 0.0;  ///< fraction of the power of the beam
};

/// Divides the light that enters a part through a curved surface among the elements, and traces the light of single
/// elements. Several threads may use the same object.
class ElementLight {
 public:
  /// \param part must outlive this object
  /// \pre the part is finite and has elements; its outline is convex
  ElementLight(const geometry::Part& part, std::shared_ptr<const geometry::EntranceSurface> surface);

  std::size_t element_count() const { return elements_.size(); }
  const geometry::EntranceSurface& surface() const { return *surface_; }
  /// Returns the plane that touches the entrance surface from above. The incident beam covers the outline of the part
  /// in this plane.
  const geometry::TouchingPlane& beam_plane() const { return beam_plane_; }

  /// Returns the portions of all elements, for light of one wavelength from one direction. Elements without a tangent
  /// plane get no light (fraction 0).
  std::vector<ElementPortion> portions(const Vec3& to_source, double index) const;

  /// Returns an element with its surroundings. Returns null if the tangent plane cannot replace the surface. This is
  /// the case if there is no tangent plane, if the element extends up to it, if no polynomial can be fitted to the
  /// surface, or if the curvature changes the illuminance too much.
  std::unique_ptr<const ElementScene> scene(std::size_t element, const Vec3& to_source, double index) const;

 private:
  /// Half-planes that bound convex regions of a tangent plane. They result from the outline of the part and from the
  /// neighbouring elements.
  struct Bounds;
  std::optional<TangentPlane> plane_of(std::size_t element, const Vec3& to_source, double index) const;
  /// \param tangent_points tangent points of the neighbouring elements, in plan; elements without a tangent plane are
  ///     omitted
  Bounds bounds_of(const TangentPlane& plane, const Vec3& to_source, const std::vector<Vec2>& tangent_points) const;
  double fraction_per_mm2(const TangentPlane& plane, const Vec3& to_source) const;

  const geometry::Part& part_;
  std::shared_ptr<const geometry::EntranceSurface> surface_;
  std::vector<geometry::PartElement> elements_;
  std::vector<std::vector<std::uint32_t>> neighbours_;  ///< for each element, the indices of the nearest elements
  geometry::TouchingPlane beam_plane_;
  double area_mm2_ = 0.0;
  double diameter_mm_ = 0.0;
};

/// Returns the light of the source in the frame of an excerpt.
Illumination illumination_of(const ElementScene& scene, const Vec3& to_source, const Stokes& stokes);

/// Traces the light of one element and passes its returned beams to the observer. A beam belongs to the element if the
/// first facet that it met is a facet of this element. If its first cell is flat land, it belongs to the element
/// through whose portion of the entrance face it entered (ExcerptLight). Light that is reflected at the outer side of
/// the surface is not included.
///
/// Hits with a form describe the curvature of the surface in each beam. Powers are fractions of the light that is
/// incident on the excerpt (ElementScene::power_factor).
/// \param optics optical properties; shells must not deflect light
/// \param policy policy for the beams; BeamPolicy::excerpt is ignored
BeamResult trace_element(const ElementScene& scene, const Optics& optics, const Illumination& illumination,
                         const std::vector<double>& cones_deg, BeamPolicy policy, const Cancellation* cancel,
                         const BeamObserver& observer);

/// Returns the directions of rays (geometrical optics) within a beam from trace_element(). The curvature of the
/// entrance surface spreads these directions.
std::vector<DirectionSample> spread_directions(const ReturnedBeam& beam);

}  // namespace retrace::raytrace
