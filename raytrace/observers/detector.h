#pragma once

// Detector maps: where on the entrance face light leaves and entered, and in which directions it comes back.

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/observers/direction_score.h"
#include "raytrace/observers/pixel_grid.h"

namespace retrace::raytrace {

/// What a detector over the entrance face records of the light that comes back, for one direction of incidence.
struct DetectorSetting {
  PixelGrid face;         ///< over the entrance face, or over one period of it
  DirectionGrid angles;   ///< around the direction back to the source
  ReturnFrame frame;      ///< of that direction
  double acceptance_deg;  ///< half angle of the cone that the two maps of the face count, as RRE does
};

/// Pixel values and the standard error of each; that is empty where nothing was sampled.
struct PixelValues {
  std::vector<double> value;
  std::vector<double> std_error;
};

/// Maps of what comes back. Irradiances are relative to that of the beam on the entrance face.
struct DetectorMaps {
  PixelValues leaving;   ///< irradiance by where light leaves; its mean over the face is RRE
  PixelValues entering;  ///< the same light by where it entered: the footprint, dead spots dark
  PixelValues per_sr;    ///< share of the incident power per steradian, of all directions; by the bins of `angles`
  double outside = 0.0;  ///< share of the incident power that leaves beyond `angles`
  double rre = 0.0;
  double std_error = 0.0;  ///< of it
  double truncated = 0.0;
  std::uint64_t rays = 0;  ///< or beams
  bool complete = true;
};

/// By beams of polygonal cross-section: every pixel holds the exact share of the polygons that cover it.
/// \throw BudgetError as BeamTracer::trace()
DetectorMaps exact_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                 const DetectorSetting& setting, const BeamPolicy& policy,
                                 const Cancellation* cancel = nullptr);

/// By paths, 32 independent replicates of an equal number of them. \throw BudgetError if power is lost
DetectorMaps sampled_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                   const DetectorSetting& setting, std::uint64_t rays, std::uint32_t seed,
                                   const PathPolicy& policy, Progress* progress = nullptr,
                                   const Cancellation* cancel = nullptr);

}  // namespace retrace::raytrace
