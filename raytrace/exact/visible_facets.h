#pragma once

// Searches for the facets that a beam meets, and removes their hidden parts.

#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/exact/beam_reach.h"
#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// A facet that may block a beam.
struct Candidate {
  Plane plane;
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  CellInstance cell;
  Distance distance;
  FlatPolygon overlap;  ///< intersection of the facet and the beam, including parts that other facets hide
  PlanBox box;
  bool is_processed = false;             ///< true if the candidate has been processed
  std::optional<Vec2> centroid_mm = {};  ///< PatchFacet::centroid_mm, displaced to the position of the cell
};

/// Facets that may block a beam in its next step. One object serves all beams of a run, one after the other.
class VisibleFacets {
 public:
  explicit VisibleFacets(const BeamScene& scene) : scene_(scene) {}

  /// Searches for the facets that may block a beam up to its horizon.
  /// \param whole cross-section of the beam
  void find(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon);
  std::size_t size() const { return candidates_.size(); }
  const Candidate& operator[](std::size_t k) const { return candidates_[k]; }
  /// Returns the visible parts of all candidates in the plane of candidate k. Coplanar facets of neighbouring elements
  /// therefore do not split a beam. The result is empty if the candidate has already been processed together with an
  /// earlier candidate.
  FlatPolygons take_visible_on_plane_of(std::size_t k);
  /// Returns the parts of a beam's cross-section that no candidate covers.
  FlatPolygons unblocked(const FlatPolygon& whole);
  /// Returns the work done so far, in units of BeamWalk::work().
  std::uint64_t work() const { return work_; }

 private:
  struct Search;

  void consider(const Search& search, const geometry::SurfacePatch& patch, const geometry::PatchFacet& facet,
                const Vec3& shift, const CellInstance& cell);
  bool is_nearer(const Candidate& own, const Candidate& other) const;
  FlatPolygons visible_polygons(std::size_t k);
  void join(FlatPolygons& pieces);

  BeamScene scene_;
  std::vector<Candidate> candidates_;
  std::uint64_t work_ = 0;
};

}  // namespace retrace::raytrace
