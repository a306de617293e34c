#pragma once

// Pictures of a part that is illuminated by a lamp and seen by an eye. `retrace image` runs this study if a camera is
// requested.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "design/optical_model.h"
#include "raytrace/observers/camera.h"
#include "requests/image.h"
#include "studies/image/image_result.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Default width and height, in mm, of the sheet that the picture shows for an infinite part.
inline constexpr std::array<double, 2> kDefaultFilmMm = {100.0, 100.0};

struct CameraResult : ImageResultBase {
  CameraRequest request;
  std::optional<PhotometricLamp> lamp;  ///< lamp that was read from the requested file; empty if no file was requested
  raytrace::CameraScene scene;
  raytrace::CameraImage image;
  double observation_deg = 0.0;  ///< angle as seen from the centre of the face
  double entrance_deg = 0.0;
  double viewing_deg = 0.0;
};

/// Study of a checked request, ready to run.
class CameraStudy {
 public:
  /// Minimum number of passes before the noise is compared with the request.
  static constexpr std::uint32_t kMinPasses = 8;
  static constexpr std::uint32_t kMaxPasses = 65536;
  /// Minimum number of passes after which the requested noise may be judged unreachable.
  static constexpr std::uint32_t kPassesToJudge = 64;

  /// \param discs method by which the luminance is averaged over the lamp and the pupil
  /// \throw InputError if a number is out of range, if the eye or the lamp is inside the part, or if light is polarised
  CameraStudy(design::Design design, CameraRequest request,
              raytrace::DiscAverage discs = raytrace::DiscAverage::kernel);

  /// Computes the picture.
  /// \param after_pass function that receives the picture after every pass; one call at a time
  /// \param distribute function that distributes the passes among several processes with equal studies. Without it,
  ///        this process traces all passes.
  CameraResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                   const std::function<void(const raytrace::CameraImage&)>& after_pass = {},
                   const DistributeTasks& distribute = {}) const;
  /// Returns a task that traces the pass with a given number, using all threads.
  /// \pre the study exists as long as the task
  ComputeTask passes() const;

  const raytrace::CameraScene& scene() const { return scene_; }

 private:
  std::shared_ptr<const raytrace::CameraTracer> tracer() const;

  design::Design design_;
  CameraRequest request_;
  std::optional<PhotometricLamp> lamp_;
  design::OpticalModel model_;
  raytrace::CameraScene scene_;
};

}  // namespace retrace::studies
