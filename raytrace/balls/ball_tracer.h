#pragma once

// Monte-Carlo tracing of ball retroreflectors: RRE and ledger, with standard errors.

#include <vector>

#include "raytrace/balls/ball_layer.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::raytrace {

/// Monte-Carlo estimates of where light goes that falls on balls with mirrors behind (BallWalker), by the replicates of
/// MonteCarlo. Of a layer the beam covers one period of the plane that touches the balls; of a single ball it covers
/// the ball, across the beam.
class BallTracer {
 public:
  explicit BallTracer(const BallLayer& layer) : layer_(layer) {}

  /// \param optics lossless_entrance: clear interfaces transmit all light; mirror_facets or an opaque layer of
  ///        facet_layers: the mirror behind the balls
  /// \param score function of the directions in which light leaves; null: none
  /// \param progress as in the constructor of Rounds
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy, const Cancellation* cancel = nullptr,
                         const DirectionScore* score = nullptr, Progress* progress = nullptr) const;

 private:
  BallLayer layer_;
};

}  // namespace retrace::raytrace
