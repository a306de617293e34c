#pragma once

// Waves, and marks of chips and scratches, that are left of measured facets once their planes are taken away. They are
// told, not corrected.
//
// A facet is a rectangle or a triangle that stands over the plane of its map, turned as it may be. What is left of it
// is therefore laid out anew over the two directions of its cut: along the edge that cut it, counted from the middle of
// the edge, and up the facet, along which the edge went. There what the edge does lies at one place, and what happens
// in time lies along the other axis: waves along the edge are those of the edge itself, waves up the facet those of a
// drive or a spindle, and a chip of the edge leaves a ridge up each facet at the same place. Each layout is measured
// with the means of `retrace metrology`; what facets have in common is then told once.

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "studies/calibration/measured_facets.h"
#include "surface_models/scratches.h"
#include "surface_models/spectrum.h"

namespace retrace::studies {

/// Where points of a facet lie under the edge that cut it.
struct EdgeView {
  geometry::Vec2 root_mm =
      geometry::Vec2::Zero();                      ///< the facet's root or apex: along the edge from its middle, and up
  geometry::Vec2 of_up = geometry::Vec2::UnitY();  ///< for a mm up the facet's slope
  geometry::Vec2 of_along = geometry::Vec2::UnitX();  ///< and along its level line

  /// \param p up the facet and along it, from its root
  geometry::Vec2 place_mm(const geometry::Vec3& p) const { return root_mm + p.x() * of_up + p.y() * of_along; }
};

/// The facets of these elements, ascending, as their last cuts made them.
std::map<FacetPlace, EdgeView> edge_views(const FabricationResult& plan, const std::vector<std::size_t>& elements);

/// What is left of a facet.
struct FacetRest {
  FacetPlace at;
  geometry::Vec2 low_mm = geometry::Vec2::Zero();  ///< of what is shown of it: along the edge and up the facet
  geometry::Vec2 high_mm = geometry::Vec2::Zero();
  geometry::Vec2 pitch_mm = geometry::Vec2::Zero();  ///< of the map's points, likewise
  std::vector<surface_models::SpectralPeak> waves;   ///< along x: along the edge; along y: up the facet
  /// That run along y, the cut, and along x, the edge; their positions count from the edge's middle and from where its
  /// tip stood last.
  std::vector<surface_models::Scratch> marks;

  /// Whether a place lies in a mark, or so near that its flanks may reach there.
  bool is_marked(const geometry::Vec2& place_mm) const;
};

/// Marks of a facet. \param left places by EdgeView and heights over the plane, mm \param pitch_mm of the map's points
FacetRest marks_of(const FacetPlace& at, std::span<const geometry::Vec3> left, const geometry::Vec2& pitch_mm);
/// And its waves, beside the marks that it has.
void add_waves(FacetRest& rest, std::span<const geometry::Vec3> left);

/// A wave that facets have in common.
struct FacetWave {
  bool is_along_edge = false;  ///< else up the facet
  double length_um = 0.0;
  double amplitude_nm = 0.0;           ///< root mean square of those of its facets
  std::optional<double> frequency_hz;  ///< of one up the facet
  std::vector<FacetPlace> facets;
};

/// A ridge or a groove that facets have at the same place.
struct FacetMark {
  bool is_along_cut = false;  ///< else along the edge
  bool is_of_edge = false;    ///< it is on most of the facets that show its place
  double place_um = 0.0;      ///< along the edge from its middle, or up the facet from where the tip stood last
  double height_nm = 0.0;     ///< mean; negative: a groove
  double width_um = 0.0;      ///< over which it stays beyond half of that
  std::vector<FacetPlace> facets;
  std::size_t shown = 0;  ///< facets that show its place
};

/// What rests have in common. \param feed_mm_per_min of their cuts
std::vector<FacetWave> common_waves(const std::vector<FacetRest>& rests, double feed_mm_per_min);
std::vector<FacetMark> common_marks(const std::vector<FacetRest>& rests);

}  // namespace retrace::studies
