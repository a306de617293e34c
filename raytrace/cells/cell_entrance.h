#pragma once

// Processes the rays of the cell engine at the entrance face, and moves them between this face and the back surface.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/cells/cell_step.h"
#include "raytrace/faces/contaminated_entrance.h"

namespace retrace::raytrace {

/// The plane entrance face of an array. An object also stores the rays that travel from the face down to the back
/// surface.
class CellEntrance {
 public:
  /// \param numbers number of values per ray, see lanes::Rays
  CellEntrance(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, std::size_t numbers);

  /// Reserves memory for `count` rays that start at the face.
  void reserve(std::size_t count);
  /// Returns the rays just below the face. Before enter(), the caller must set their positions. Before descend(), the
  /// caller must set all their values.
  RayStore& rays() { return descending_; }
  /// Sends incident light into the part at the positions of rays().
  void enter(RayStreams& streams, CellRun& run);
  /// Moves rays() down to the top of the back surface.
  void descend(bool scattered, RayStreams& streams, CellRun& run);
  /// Processes the rays of a batch that have reached the top of the back surface from below. The rays are moved up to
  /// the entrance face. Rays that this face reflects are moved back down.
  void meet(const CellStep& step);

 private:
  void meet_bare(const CellStep& step);
  void meet_layers(const CellStep& step);
  void meet_contaminated(const CellStep& step);
  void enter_contaminated(RayStreams& streams, CellRun& run);
  const EntranceScatter& scatter_at_face(const Ray& ray, CellRun& run);
  Ray risen(const CellStep& step, const lanes::Rays& rays, std::size_t k) const;
  void queue(const lanes::Rays& from, std::size_t k, const Vec3& position, const Ray& ray);
  void descend_queued(RayStreams& streams, CellRun& run);

  const LightSetup& setup_;
  const PathPolicy& policy_;
  const CellArray& array_;
  double height_mm_;                               ///< height of the entrance face above the top of the back surface
  std::vector<lanes::LinearForm> fragment_edges_;  ///< edges of CellArray::fragments() as linear forms
  std::vector<std::uint32_t> fragment_starts_;     ///< index in `fragment_edges_` per fragment, then the size
  RayStore descending_;
  std::vector<lanes::Label> labels_;  ///< index of the fragment below each ray of `descending_`
  RayStore exited_;                   ///< rays that leave through the face; used only with a score or an observer
  std::array<RayStore, 2> queued_;    ///< rays just below a contaminated face: [0] unscattered, [1] scattered
  std::optional<ContaminatedEntrance> contaminated_;  ///< set if the face scatters
  EntranceScatter scatter_;
};

}  // namespace retrace::raytrace
