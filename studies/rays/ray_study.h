#pragma once

// What becomes of the rays of a set at a part: every ray that leaves, and the account of all power.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "raytrace/paths/ray_tracer.h"
#include "studies/design/optical_model.h"
#include "studies/rays/emitter.h"
#include "studies/rays/placement.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

struct RayRequest {
  RayPlacementRequest placement;
  /// Both branches of an interface are followed while each has at least this share of the ray's power; below, one takes
  /// the whole by chance. 1: one ray in, at most one out.
  double split = 1.0;
  double cutoff = 1e-10;     ///< share of a ray's power below which it is followed no further
  bool keep_missed = false;  ///< rays that miss the part are written too
  bool stokes = false;       ///< polarisation is written even if the source has none
  std::uint32_t seed = 1;
};

/// Whose unit the power of the ledger has.
enum class RayPower { radiant_w, luminous_lm };

struct RayResult {
  Design design;
  RayRequest request;
  std::string source_name;         ///< of its file; empty: none \note as what follows, for who made the source to set
  std::optional<Emitter> emitter;  ///< in place of a file
  std::string out_name;            ///< of the file that rays were written to; empty: none
  RaySetInfo source;
  RayPlacement placement;
  double acceptance_half_angle_deg = 0.0;
  RayPower power = RayPower::radiant_w;
  raytrace::RayLedger ledger;
  std::uint64_t rays_out = 0;  ///< given to the sink
  double shortest_nm = 0.0;    ///< wavelengths that were traced
  double longest_nm = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;
  double elapsed_s = 0.0;
};

/// Traces the rays of a source at a design. Rays of a source that tells no wavelengths take those of the design's light
/// by chance, in proportion to their weights; those with a spectrum take wavelengths of it.
class RayStudy {
 public:
  /// \throw InputError for balls, or a request that makes no sense
  RayStudy(Design design, RayRequest request);
  RayStudy(const RayStudy&) = delete;
  RayStudy& operator=(const RayStudy&) = delete;
  ~RayStudy();

  const geometry::Part& part() const;
  const Design& design() const;
  /// An emitter as asked, for this part. Its power is in lm where the design's light is weighed by the eye.
  /// \throw InputError for what is out of range
  Emitter emitter_of(const EmitterRequest& request) const;

  /// \param sink null: rays are counted alone \throw InputError of the source; BudgetError if power was lost
  RayResult run(RaySource& source, RaySink* sink, Progress* progress, const Cancellation* cancel) const;

 private:
  struct Hidden;
  class Run;

  std::unique_ptr<const Hidden> hidden_;
};

}  // namespace retrace::studies
