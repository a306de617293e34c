#pragma once

// Traces a set of rays through a part. The result consists of all leaving rays and the ledger, which accounts for all
// power.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/progress.h"
#include "core/warning.h"
#include "design/optical_model.h"
#include "raytrace/paths/ray_tracer.h"
#include "requests/rays.h"
#include "studies/rays/emitter.h"
#include "studies/rays/placement.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Settings of a ray study. resolve() makes them from a RaysRequest or a TraceRequest.
struct RayRequest {
  RayPlacementRequest placement;
  std::optional<EmitterRequest> emitter = {};  ///< requested emitter; empty: a file or the caller gives the rays
  /// Minimum fraction of a ray's power for which both branches at an interface are traced. Below this fraction, one
  /// branch is chosen at random and carries the power of both. With 1, at most one ray leaves for each incident ray.
  double split = 1.0;
  double cutoff = 1e-10;     ///< fraction of an incident ray's power below which a branch is not traced further
  bool keep_missed = false;  ///< true: rays that miss the part are also written
  bool stokes = false;       ///< true: polarisation is written even if the source has none
  std::uint32_t seed = 1;
};

/// Checks a request and returns its settings. An emitter without a requested position is placed in front of the
/// entrance face.
/// \throw InputError at the first field whose value is not allowed
RayRequest resolve(const RaysRequest& request);
RayRequest resolve(const TraceRequest& request);

/// Unit of the power in the ledger.
enum class RayPower { radiant_w, luminous_lm };

struct RayResult {
  design::Design design;
  RayRequest request;
  /// Name of the source's file; empty if the source is not a file. The creator of the source sets this member and the
  /// next two.
  std::string source_name;
  std::optional<Emitter> emitter;  ///< emitter that replaces a file
  std::string out_name;            ///< file to which rays were written; empty: none
  RaySetInfo source;
  RayPlacement placement;
  double acceptance_half_angle_deg = 0.0;
  RayPower power = RayPower::radiant_w;
  raytrace::RayLedger ledger;
  std::uint64_t rays_out = 0;  ///< number of rays that the sink received
  double shortest_nm = 0.0;    ///< shortest traced wavelength
  double longest_nm = 0.0;
  Warnings warnings;
  bool complete = true;
  double elapsed_s = 0.0;
};

/// Traces the rays of a source through a design. Rays without wavelengths get random wavelengths of the design's light,
/// in proportion to their weights. Rays with a spectrum get wavelengths of their spectrum.
class RayStudy {
 public:
  /// \pre each value of `request` is in its allowed range; resolve() ensures this
  /// \throw InputError if the elements are balls, or if the source would be aimed at its own position
  RayStudy(design::Design design, RayRequest request);
  RayStudy(const RayStudy&) = delete;
  RayStudy& operator=(const RayStudy&) = delete;
  ~RayStudy();

  const geometry::Part& part() const;
  const design::Design& design() const;
  /// Returns the requested emitter for this part. Its power is in lm if the design's light is weighted by the response
  /// of the eye.
  Emitter emitter_of(const EmitterRequest& request) const;

  /// Traces all rays of a source.
  /// \param sink null: rays are only counted
  /// \throw InputError if the source contains an error
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
  RayResult run(RaySource& source, RaySink* sink, Progress* progress, const Cancellation* cancel) const;

 private:
  struct Impl;
  class Run;

  std::unique_ptr<const Impl> impl_;
};

}  // namespace retrace::studies
