#pragma once

// Interface for tracing the light that rough facets scatter out of beams. The beam tracer depends only on this
// interface.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "core/random.h"
#include "raytrace/exact/beam.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

/// Traces the scattered light of one replicate. Not thread-safe.
class ScatteredReplicate {
 public:
  virtual ~ScatteredReplicate() = default;

  /// Traces all light that the sites scatter, in rays with at most the power `max_power`. Stops early if cancelled.
  virtual void launch(const std::vector<ScatterSite>& sites, double max_power) = 0;
  /// Returns the sums over all light traced so far.
  virtual const Tally& tally() const = 0;
};

/// Traces the scattered light of one direction of incidence. All threads may share one object.
class ScatteredLight {
 public:
  virtual ~ScatteredLight() = default;

  /// \param key key of the random numbers of this replicate and round
  virtual std::unique_ptr<ScatteredReplicate> replicate(RandomKey key, std::uint32_t number, std::uint32_t round,
                                                        const Cancellation* cancel) const = 0;
};

}  // namespace retrace::raytrace
