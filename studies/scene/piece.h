#pragma once

// A piece of a design that is small enough to be looked at, and light paths through it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "raytrace/faces/exact_surface.h"
#include "raytrace/paths/light_path.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// Where the light comes from.
struct SceneLight {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
};

/// A path and what share of the light that falls on one element goes such a way.
struct ScenePath {
  raytrace::LightPath path;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double share = 0.0;
};

/// Elements along a side of a still picture ...
inline constexpr double kSceneElements = 4.0;
/// ... and of a view that follows any light: askew through the plate it does not leave the piece before it meets them.
inline constexpr double kLiveElements = 6.0;

/// A few elements of a design, on a plate no thicker than they are wide. Rough facets are shown smooth.
class Piece {
 public:
  /// \param elements along a side of an array, at most \throw InputError as make_model()
  Piece(const Design& design, const materials::MaterialLibrary& library, double elements);
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;

  const OpticalModel& model() const { return model_; }
  const geometry::BoundaryMesh& mesh() const { return mesh_; }
  /// Where faces meet.
  const std::vector<std::array<std::uint32_t, 2>>& edges() const { return edges_; }
  /// In what it differs from the design.
  const std::vector<std::string>& remarks() const { return remarks_; }
  const geometry::Vec2& centre_mm() const { return centre_mm_; }

  /// Of a place of the whole part on z = 0: the like place of the piece, of several the one nearest to its middle.
  geometry::Vec2 like_place(const geometry::Vec2& at_mm) const;
  /// Where light enters the piece that meets its elements as light that enters the whole part at `at_mm` does.
  geometry::Vec2 entry_of(const SceneLight& light, const geometry::Vec2& at_mm) const;
  /// The way of light that enters there.
  raytrace::LightPath path(const SceneLight& light, const geometry::Vec2& entry_mm) const;
  /// Up to three kinds of path of light that falls on an element in the middle, the most frequent ones first.
  std::vector<ScenePath> stories(const SceneLight& light) const;

 private:
  /// How a piece of an array lies on the lattice of the whole.
  struct Lattice {
    geometry::Vec2 from_whole_mm = geometry::Vec2::Zero();
    geometry::Vec2 period_mm = geometry::Vec2::Zero();
  };
  void find_lattice(const geometry::PartSpec& whole, const geometry::PartSpec& piece);

  double whole_thickness_mm_ = 0.0;
  double cone_deg_ = 0.0;
  std::vector<std::string> remarks_;
  OpticalModel model_;
  geometry::BoundaryMesh mesh_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  geometry::Vec2 centre_mm_ = geometry::Vec2::Zero();
  std::optional<Lattice> lattice_;  ///< none: the piece is the whole, or places have no like ones
  std::optional<raytrace::ExactSurface> surface_;
};

}  // namespace retrace::studies
