#pragma once

// Detector maps of the returned light: the points of the entrance face where the light leaves and where it entered, and
// the directions of the light.

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/light/direction_score.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/observers/pixel_grid.h"

namespace retrace::raytrace {

/// Settings of a detector that records the returned light for one direction of incidence.
struct DetectorSetting {
  PixelGrid face;         ///< pixels on the entrance face, or on one period of it
  DirectionGrid angles;   ///< bins of directions around the direction to the source
  ReturnFrame frame;      ///< axes around the direction to the source
  double acceptance_deg;  ///< half angle of the acceptance cone; the maps of the face contain only light in this cone
};

/// Pixel values and their standard errors. `std_error` is empty if the values are not sampled.
struct PixelValues {
  std::vector<double> value;
  std::vector<double> std_error;
};

/// Maps of the returned light. Irradiances are relative to the irradiance of the incident beam on the entrance face.
struct DetectorMaps {
  PixelValues leaving;   ///< irradiance at the points where light leaves; its mean over the face is the RRE
  PixelValues entering;  ///< irradiance of the same light at the points where it entered: the footprint
  /// Fraction of the incident power per steradian in the bins of `angles`. It is not limited to the acceptance cone.
  PixelValues per_sr;
  double outside = 0.0;  ///< fraction of the incident power that leaves in directions outside of `angles`
  double rre = 0.0;
  double std_error = 0.0;  ///< standard error of `rre`
  double truncated = 0.0;
  std::uint64_t rays = 0;  ///< number of rays or beams
  bool complete = true;
};

/// Computes the maps from beams of polygonal cross-section. The area of a pixel that a polygon covers is computed
/// exactly.
/// \throw BudgetError in the same cases as BeamTracer::trace()
DetectorMaps exact_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                 const DetectorSetting& setting, const BeamPolicy& policy,
                                 const Cancellation* cancel = nullptr);

/// Computes the maps from rays, in 32 independent replicates with equal numbers of rays.
/// \throw BudgetError if power is lost
DetectorMaps sampled_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                   const DetectorSetting& setting, std::uint64_t rays, std::uint32_t seed,
                                   const PathPolicy& policy, Progress* progress = nullptr,
                                   const Cancellation* cancel = nullptr);

}  // namespace retrace::raytrace
