#pragma once

// Monte-Carlo tracing of ball retroreflectors: RRE and ledger, with standard errors.

#include <vector>

#include "raytrace/balls/ball_layer.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/sampling/replicates.h"

namespace retrace::raytrace {

/// Estimates the RRE (retroreflective efficiency) and the ledger (power by destination) of balls with mirrors behind
/// them. The estimate uses Monte Carlo tracing (BallWalker). The beam on a layer covers one period of the plane that
/// touches the balls from above. The beam on a single ball covers the cross section of the ball. The standard errors
/// are computed from replicates as in MonteCarlo.
class BallTracer {
 public:
  explicit BallTracer(const BallLayer& layer) : layer_(layer) {}

  /// \param optics `lossless_entrance` makes uncoated parts of the balls transmit all light. `mirror_facets`, or an
  ///        opaque layer in `facet_layers`, defines the mirror behind the balls.
  /// \param score function of the exit direction; its mean over the light that leaves the balls is computed; null for
  ///        none
  /// \param progress receives the finished fraction of the work, see the constructor of Rounds; null for none
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy, const Cancellation* cancel = nullptr,
                         const DirectionScore* score = nullptr, Progress* progress = nullptr) const;

 private:
  BallLayer layer_;
};

}  // namespace retrace::raytrace
