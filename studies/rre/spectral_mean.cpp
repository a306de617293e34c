#include "studies/rre/spectral_mean.h"

#include <algorithm>
#include <cmath>

namespace retrace::studies {

RrePoint spectral_mean(const RrePoint& at, const std::vector<SpectralPoint>& points) {
  RrePoint mean = at;
  double variance = 0.0;
  for (const auto& [weight, p] : points) {
    mean.rre += weight * p.rre;
    variance += weight * p.std_error * weight * p.std_error;
    mean.stokes += weight * p.stokes;
    for (std::size_t k = 0; k < p.ledger.power.size(); ++k) mean.ledger.power[k] += weight * p.ledger.power[k];
    mean.beams += p.beams;
    mean.depth = std::max(mean.depth, p.depth);
    mean.by_wavelength.push_back({p.wavelength_nm, weight, p.rre, p.std_error, p.engine});
    mean.engine = mean.engine.empty() || mean.engine == p.engine ? p.engine : kMixedEngines;
  }
  mean.std_error = std::sqrt(variance);
  return mean;
}

}  // namespace retrace::studies
