#pragma once

// Finds waves, and marks of chips and scratches, in the residual heights of measured facets after their planes are
// subtracted. Waves and marks are reported, not corrected.
//
// A facet is a rectangle or a triangle in any orientation to the grid of its height map. Its residual heights are
// therefore resampled on a grid along the two directions of its cut: x along the cutting edge, from the centre of the
// edge, and y up the facet, in the direction in which the edge moved. Effects of the edge depend only on x, and effects
// in time depend only on y. Waves along x are those of the edge itself, and waves along y come from a drive or a
// spindle. A chip of the edge leaves a ridge along y at the same x on each facet. Each grid is evaluated with the
// methods of `retrace metrology`. Features that facets have in common are reported one time.

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "studies/calibration/measured_facets.h"
#include "surface_models/scratches.h"
#include "surface_models/spectrum.h"

namespace retrace::studies {

/// Transformation of points of a facet to coordinates of its cut: x along the cutting edge, from the centre of the
/// edge, and y up the facet. All members are vectors in these coordinates.
struct CutCoordinates {
  geometry::Vec2 root_mm = geometry::Vec2::Zero();      ///< position of the facet's root or apex
  geometry::Vec2 up_step_mm = geometry::Vec2::UnitY();  ///< step of 1 mm up the facet
  /// Step of 1 mm along the facet's horizontal line.
  geometry::Vec2 along_step_mm = geometry::Vec2::UnitX();

  /// Returns the coordinates of a point.
  /// \param p point in coordinates of the facet, relative to the root: x up the facet, and y along its horizontal line
  geometry::Vec2 position_mm(const geometry::Vec3& p) const {
    return root_mm + p.x() * up_step_mm + p.y() * along_step_mm;
  }
};

/// Returns the transformations for the last cuts of the facets.
/// \param elements numbers of the elements, in ascending order
std::map<FacetId, CutCoordinates> cut_coordinates(const FabricationResult& plan,
                                                  const std::vector<std::size_t>& elements);

/// Waves and marks in the residual heights of a facet. Coordinates are those of CutCoordinates.
struct FacetResiduals {
  FacetId at;
  geometry::Vec2 low_mm = geometry::Vec2::Zero();  ///< lower limits of the measured area
  geometry::Vec2 high_mm = geometry::Vec2::Zero();
  geometry::Vec2 pitch_mm = geometry::Vec2::Zero();  ///< distances between points of the map
  std::vector<surface_models::SpectralPeak> waves;   ///< waves along x (the edge) or along y (up the facet)
  /// Marks that run along y (the cut) or along x (the edge). Positions along x count from the centre of the edge.
  /// Positions along y count from the last position of the edge's tip.
  std::vector<surface_models::Scratch> marks;

  /// Returns true if a position is inside a mark or so close that the flanks of the mark may extend to it.
  bool is_marked(const geometry::Vec2& position_mm) const;
};

/// Finds the marks of a facet.
/// \param left coordinates of CutCoordinates and residual heights, in mm
/// \param pitch_mm distances between points of the map
FacetResiduals marks_of(const FacetId& at, std::span<const geometry::Vec3> left, const geometry::Vec2& pitch_mm);
/// Adds the waves of a facet. Points inside the marks of `rest` are ignored.
void add_waves(FacetResiduals& rest, std::span<const geometry::Vec3> left);

/// Wave that facets have in common.
struct FacetWave {
  bool is_along_edge = false;  ///< true: along the edge; false: up the facet
  double length_um = 0.0;
  double amplitude_nm = 0.0;           ///< root mean square of the amplitudes on the facets
  std::optional<double> frequency_hz;  ///< temporal frequency of a wave up the facet; none for a wave along the edge
  std::vector<FacetId> facets;
};

/// Ridge or groove that facets have at the same position.
struct FacetMark {
  bool is_along_cut = false;  ///< true: along the cut; false: along the edge
  bool is_of_edge = false;    ///< true: the edge causes the mark, which most facets with this position have
  /// Position of the mark: along the edge from the centre of the edge, or up the facet from the last position of the
  /// edge's tip.
  double position_um = 0.0;
  double height_nm = 0.0;  ///< mean height; negative for a groove
  double width_um = 0.0;   ///< full width at half of the height
  std::vector<FacetId> facets;
  std::size_t facets_covering = 0;  ///< number of facets whose measured area contains the position
};

/// Returns the waves or marks that facets have in common, the highest first.
/// \param feed_mm_per_min feed of the cuts of the facets
std::vector<FacetWave> common_waves(const std::vector<FacetResiduals>& rests, double feed_mm_per_min);
std::vector<FacetMark> common_marks(const std::vector<FacetResiduals>& rests);

}  // namespace retrace::studies
