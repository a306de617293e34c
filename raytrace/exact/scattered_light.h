#pragma once

// What rough facets scatter out of beams, for who follows beams and not what becomes of that light.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "core/random.h"
#include "raytrace/exact/beam.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

/// Follows the scattered light of one replicate. For one thread.
class ScatteredReplicate {
 public:
  virtual ~ScatteredReplicate() = default;

  /// All that these sites scatter, in pieces of at most `most_power`. Stops half way if it was cancelled.
  virtual void launch(const std::vector<ScatterSite>& sites, double most_power) = 0;
  /// Of all that was launched.
  virtual const Tally& tally() const = 0;
};

/// Follows the scattered light of one direction of incidence. A value shared by all threads.
class ScatteredLight {
 public:
  virtual ~ScatteredLight() = default;

  /// \param key of the random numbers of this replicate and round
  virtual std::unique_ptr<ScatteredReplicate> replicate(RandomKey key, std::uint32_t number, std::uint32_t round,
                                                        const Cancellation* cancel) const = 0;
};

}  // namespace retrace::raytrace
