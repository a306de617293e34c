#pragma once

// Data of a run of the cell engine: its results, its random choices, and the inputs and outputs of a step.

#include <cstddef>
#include <cstdint>

#include "core/random.h"
#include "raytrace/cells/column_faces.h"
#include "raytrace/cells/ray_streams.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

/// Receives the light that leaves the part in the cell engine. `owner` is the number of the path to which a ray belongs
/// (CellRay::owner).
class CellObserver {
 public:
  virtual ~CellObserver() = default;
  /// Called when light leaves through the entrance face, see ExitObserver::on_exit().
  virtual void on_exit(std::uint32_t owner, const Vec3& position, const Vec3& direction, double power) = 0;
  /// Called when light leaves through the back.
  virtual void on_transmission(std::uint32_t owner, double power) = 0;
};

/// Results and random choices of a run. The counters of the random generator are the replicate, the number of the first
/// point and the number of earlier choices.
struct CellRun {
  Tally& tally;
  CellObserver* observer = nullptr;  ///< may be null
  geometry::Rectangle outline_mm;    ///< finite parts: outline of the entrance face, relative to the centre
  RandomKey key;
  std::uint32_t replicate = 0;
  std::uint32_t first = 0;
  std::uint32_t choices = 0;

  double random() { return unit_interval(philox(key, replicate, first, choices++)[0]); }
  surface_models::RandomStream random_stream() { return {key, replicate, first, choices++}; }
};

/// One step of the rays of a stream to their next faces.
struct CellStep {
  const LightSetup& setup;
  const PathPolicy& policy;
  const ColumnFaces& faces;
  RayBatch& batch;
  RayStreams& streams;  ///< receives the rays after the step
  CellRun& run;

  const StreamKey& stream() const { return batch.stream; }
  lanes::Rays rays() const { return batch.rays.rays(); }
  std::size_t size() const { return batch.rays.size(); }
  /// Returns the parameters for the choice of the branches of the rays with this label. Draws one random number.
  lanes::FaceInteraction meeting(lanes::Label label) const {
    return {batch.hits.face_hits(), label, stream().inside() ? -1.0 : 1.0, policy.split_power, run.random()};
  }
  /// Ends the rays with this label and adds their power to an account of the ledger.
  void add_to_ledger(lanes::Label label, Account account) const {
    const lanes::PowerSum share = lanes::sum_of(batch.hits.labels(), label, rays(), size());
    run.tally.other[account] += share.power;
    run.tally.segments += share.count;
  }
};

}  // namespace retrace::raytrace
