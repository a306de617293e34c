#pragma once

// Small number of elements of a design for display, and light paths through them.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "design/optical_model.h"
#include "geometry/part/closed_boundary.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/faces/exact_surface.h"
#include "raytrace/paths/light_path.h"

namespace retrace::studies {

/// Direction of the light.
struct SceneLight {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
};

/// Light path, and the fraction of an element's light that takes paths of the same kind.
struct ScenePath {
  raytrace::LightPath path;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double fraction = 0.0;
};

/// Number of elements along a side of a still picture.
inline constexpr double kSceneElements = 4.0;
/// Number of elements along a side of an interactive view. It is greater, so that oblique light does not leave the
/// plate before it hits the elements.
inline constexpr double kLiveElements = 6.0;

/// A few elements of a design for display. The plate behind the elements is at most as thick as the elements are wide.
/// Rough facets are displayed as smooth facets. A part with a curved entrance face is displayed as a whole. Its face is
/// displayed as triangles, but light paths are refracted at the exact face.
class DesignExcerpt {
 public:
  /// \param elements maximum number of elements along a side of an array
  /// \throw InputError in the same cases as make_model()
  DesignExcerpt(const design::Design& design, const materials::MaterialLibrary& library, double elements);
  DesignExcerpt(const DesignExcerpt&) = delete;
  DesignExcerpt& operator=(const DesignExcerpt&) = delete;

  const design::OpticalModel& model() const { return model_; }
  const geometry::BoundaryMesh& mesh() const { return mesh_; }
  /// Returns the edges between faces.
  const std::vector<std::array<std::uint32_t, 2>>& edges() const { return edges_; }
  /// Returns the differences from the design, as texts for the user.
  const std::vector<std::string>& remarks() const { return remarks_; }
  const geometry::Vec2& centre_mm() const { return centre_mm_; }

  /// Returns the position in the excerpt that corresponds to a position in the whole part at z = 0. If several
  /// positions in the excerpt are equivalent, returns the one nearest to the centre of the excerpt.
  geometry::Vec2 equivalent_position(const geometry::Vec2& at_mm) const;
  /// Returns the point at which light must enter the excerpt so that it hits the same points of elements as light that
  /// enters the whole part at `at_mm`. The plates of excerpt and part may have different thicknesses.
  geometry::Vec2 entry_of(const SceneLight& light, const geometry::Vec2& at_mm) const;
  /// Returns the path of light that enters at a point.
  raytrace::LightPath path(const SceneLight& light, const geometry::Vec2& entry_mm) const;
  /// Returns a path of each of up to three kinds, the most frequent kind first. The light enters in an area as large as
  /// one element around the centre of the excerpt.
  std::vector<ScenePath> typical_paths(const SceneLight& light) const;

 private:
  /// Position of the excerpt relative to the lattice of the whole array.
  struct Lattice {
    geometry::Vec2 from_design_mm = geometry::Vec2::Zero();
    geometry::Vec2 period_mm = geometry::Vec2::Zero();
  };
  void find_lattice(const geometry::PartSpec& whole, const geometry::PartSpec& piece);

  double design_thickness_mm_ = 0.0;
  double cone_deg_ = 0.0;
  std::vector<std::string> remarks_;
  design::OpticalModel model_;
  geometry::BoundaryMesh mesh_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  geometry::Vec2 centre_mm_ = geometry::Vec2::Zero();
  std::optional<Lattice> lattice_;  ///< none if the excerpt is the whole part, or if the part is not periodic
  std::optional<raytrace::ExactSurface> surface_;
  std::unique_ptr<const raytrace::EntranceFace> entrance_face_;  ///< null if the entrance face is plane
};

}  // namespace retrace::studies
