#pragma once

// Monte Carlo tracing of ball retroreflectors. It computes the RRE with its standard error, and the ledger.

#include <vector>

#include "raytrace/balls/ball_layer.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/sampling/replicates.h"

namespace retrace::raytrace {

/// Estimates the RRE (retroreflective efficiency) and the ledger (power by destination) of balls with mirrors behind
/// them. The estimate uses Monte Carlo tracing (BallWalker). The incident beam on a layer of balls covers one period of
/// the plane that touches the balls from above. The incident beam on a single ball covers the cross section of the
/// ball. The standard errors are computed from replicates as in MonteCarlo.
class BallTracer {
 public:
  explicit BallTracer(const BallLayer& layer) : layer_(layer) {}

  /// \param optics `lossless_entrance` makes uncoated areas of the ball surfaces transmit all light. `mirror_facets`,
  ///        or an opaque layer in `facet_layers`, defines the mirror behind the balls.
  /// \param score function of the exit direction, which is summed over the light that leaves the balls; null for none
  /// \param progress receives the finished fraction of the work, see the constructor of Rounds; null for none
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy, const Cancellation* cancel = nullptr,
                         const DirectionScore* score = nullptr, Progress* progress = nullptr) const;

 private:
  BallLayer layer_;
};

}  // namespace retrace::raytrace
