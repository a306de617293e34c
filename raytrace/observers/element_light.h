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

/// Portion of the incident light that belongs to an element: the light that enters nearest to the tangent point of the
/// element. The portions of all elements together are the light that enters the part.
struct ElementPortion {
  double fraction = 0.0;      ///< fraction of the light that is incident on the part
  Vec2 at_mm = Vec2::Zero();  ///< tangent point in plan
  bool is_at_border = false;  ///< true if the border of the part cuts the portion, or is near the element
};

/// An element and its surroundings behind a tangent plane of the entrance surface, for light from one direction. The
/// frame of the excerpt is the frame of the tangent plane, shifted along z. Objects refer to each other and are not
/// copied.
struct ElementScene {
  bool is_lit = true;  ///< false if no light enters nearest to the element; all other members are then undefined
  geometry::ElementExcerpt excerpt;
  TangentPlane plane;
  SurfaceSag sag;
  surface_models::FacetForm squared_slope;  ///< squared slope of `sag` across the light that enters
  Vec3 to_source = Vec3::UnitZ();           ///< in the frame of the excerpt
  geometry::Polygon portion_mm;             ///< portion of the element on the tangent plane; see ElementPortion
  double fraction = 0.0;                    ///< as ElementPortion::fraction
  /// Factor by which powers of beams in the excerpt are multiplied to obtain fractions of the light that is incident on
  /// the part.
  double power_factor = 0.0;

  ElementScene() = default;
  ElementScene(const ElementScene&) = delete;
  ElementScene& operator=(const ElementScene&) = delete;

  /// Returns a direction of the part frame in the frame of the excerpt.
  Vec3 direction(const Vec3& of_part) const { return plane.frame_from_part * of_part; }
  ReturnFrame frame(const ReturnFrame& of_part) const {
    return {direction(of_part.to_source), direction(of_part.right), direction(of_part.up)};
  }
};

/// Direction and power of a sample of a beam behind a curved surface.
struct DirectionSample {
  Vec3 direction;
  double power_fraction = 0.0;  ///< fraction of the power of the beam
};

/// Divides the light that enters a part through a curved surface among the elements, and traces the light of single
/// elements. All threads may share one object.
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

  /// Returns the portions of all elements, for light of one wavelength from one direction. Portions without a tangent
  /// plane have the fraction 0.
  std::vector<ElementPortion> portions(const Vec3& to_source, double index) const;

  /// Returns an element with its surroundings. Returns nothing if the surface has no tangent plane for the element, or
  /// if a polynomial does not describe the surface.
  std::unique_ptr<const ElementScene> scene(std::size_t element, const Vec3& to_source, double index) const;

 private:
  /// Convex region of a tangent plane: the half-planes of the part's outline and of the neighbouring elements.
  struct Bounds;
  std::optional<TangentPlane> plane_of(std::size_t element, const Vec3& to_source, double index) const;
  /// \param tangent_points tangent points in plan of the elements of `neighbours_`; empty for elements without a plane
  Bounds bounds_of(const TangentPlane& plane, const Vec3& to_source,
                   const std::vector<std::optional<Vec2>>& tangent_points) const;
  double fraction_per_mm2(const TangentPlane& plane, const Vec3& to_source) const;

  const geometry::Part& part_;
  std::shared_ptr<const geometry::EntranceSurface> surface_;
  std::vector<geometry::PartElement> elements_;
  std::vector<std::vector<std::uint32_t>> neighbours_;  ///< for each element, the nearest elements
  geometry::TouchingPlane beam_plane_;
  double area_mm2_ = 0.0;
  double diameter_mm_ = 0.0;
};

/// Returns the light of the source in the frame of an excerpt.
Illumination illumination_of(const ElementScene& scene, const Vec3& to_source, const Stokes& stokes);

/// Traces the light of one element and passes its returned beams to the observer. These are the beams that met the
/// element before any other element, and the light of the element's portion that met no element first. The light that
/// the surface reflects at its outer side is not included. The beams contain the curvature of the surface as hits with
/// a form. Powers are relative to the light on the excerpt, see ElementScene::power_factor.
/// \param optics shells must not deflect light
/// \param policy BeamPolicy::ends_at_sides is set
BeamResult trace_element(const ElementScene& scene, const Optics& optics, const Illumination& illumination,
                         const std::vector<double>& cones_deg, BeamPolicy policy, const Cancellation* cancel,
                         const BeamObserver& observer);

/// Returns directions of geometrical optics of a beam from trace_element(). The curvature of the entrance surface
/// spreads them.
std::vector<DirectionSample> spread_directions(const ReturnedBeam& beam);

}  // namespace retrace::raytrace
