#pragma once

// Reflectors of a car or a sign as seen at night by a driver. `retrace image` runs this study if a road is requested.

#include <vector>

#include "core/progress.h"
#include "design/design.h"
#include "materials/spectrum.h"
#include "requests/image.h"
#include "studies/image/image_result.h"
#include "studies/image/road_picture.h"

namespace retrace::studies {

struct RoadResult : ImageResultBase {
  RoadRequest request;
  RoadScene scene;
  std::vector<RoadView> views;
};

/// Study of a checked request, ready to run.
class RoadStudy {
 public:
  /// \throw InputError for numbers out of range, and for designs that Photometer does not support
  RoadStudy(design::Design design, RoadRequest request);

  RoadResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

 private:
  design::Design design_;
  RoadRequest request_;
  RoadScene scene_;
  materials::SpectralCurve dye_absorption_per_mm_;
};

}  // namespace retrace::studies
