#pragma once

// What happens to rays of the cell engine at the entrance face, and their path between this face and the surface.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/cells/cell_step.h"
#include "raytrace/faces/soiled_entrance.h"

namespace retrace::raytrace {

/// The plane entrance face above an array, with the memory for rays that it sends down to the surface.
class CellEntrance {
 public:
  /// \param numbers number of values per ray, see lanes::Rays
  CellEntrance(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, std::size_t numbers);

  /// Reserves memory for rays that start at the face.
  void reserve(std::size_t count);
  /// Rays just below the face. The caller of enter() and fall() sets their values.
  RayStore& rays() { return falling_; }
  /// Sends incident light into the part at the positions of rays().
  void enter(RayStreams& streams, CellRun& run);
  /// Moves rays() down to the top of the surface.
  void fall(bool scattered, RayStreams& streams, CellRun& run);
  /// Moves the rays of a batch that rise from the top of the surface up to the face. Rays that are reflected there are
  /// moved back down.
  void meet(const CellStep& step);

 private:
  void meet_bare(const CellStep& step);
  void meet_layers(const CellStep& step);
  void meet_soiled(const CellStep& step);
  void enter_soiled(RayStreams& streams, CellRun& run);
  const SoiledReturn& soiled(const Ray& ray, CellRun& run);
  Ray risen(const CellStep& step, const lanes::Rays& rays, std::size_t k) const;
  void queue(const lanes::Rays& from, std::size_t k, const Vec3& position, const Ray& ray);
  void fall_queued(RayStreams& streams, CellRun& run);

  const LightSetup& setup_;
  const PathPolicy& policy_;
  const CellArray& array_;
  double height_mm_;                         ///< height of the face above the top of the surface
  std::vector<lanes::LinearForm> pieces_;    ///< edges of CellArray::pieces() as linear forms
  std::vector<std::uint32_t> piece_starts_;  ///< index of the first edge of each piece, and the number of edges
  RayStore falling_;
  std::vector<lanes::Label> labels_;      ///< pieces below the rays of `falling_`
  RayStore left_;                         ///< rays that leave through the face, if they are scored or observed
  std::array<RayStore, 2> queued_;        ///< rays just below a contaminated face: [0] unscattered, [1] scattered
  std::optional<SoiledEntrance> soiled_;  ///< set if the face scatters
  SoiledReturn from_soiled_;
};

}  // namespace retrace::raytrace
