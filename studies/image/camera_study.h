#pragma once

// Pictures of a part that is illuminated by a lamp and seen by an eye. `retrace image` runs this study if a camera is
// requested.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "core/warning.h"
#include "raytrace/observers/camera.h"
#include "studies/design/optical_model.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Default width and height, in mm, of the sheet that the picture shows for an infinite part.
inline constexpr std::array<double, 2> kUsualFilmMm = {100.0, 100.0};

/// Request for a picture of the part in the light of a lamp. Positions are in the camera frame
/// (raytrace/observers/camera.h).
struct CameraRequest {
  double distance_m = 10.0;       ///< distance of lamp and eye from the centre of the face; > 0
  double observation_deg = 0.33;  ///< angle between lamp and eye; the eye is above the lamp; 0 to 180
  double v_deg = 0.0;             ///< vertical angle of the lamp, as in regulations; -90 to 90
  double h_deg = 0.0;
  double rotation_deg = 0.0;                     ///< rotation of the part about its normal
  std::optional<std::array<double, 3>> eye_mm;   ///< position of the eye; replaces distance and angles
  std::optional<std::array<double, 3>> lamp_mm;  ///< position of the lamp; replaces distance and angles
  double lamp_arcmin = 10.0;                     ///< angular diameter of the lamp; > 0, up to 600
  double pupil_arcmin = 10.0;                    ///< angular diameter of the eye's pupil; 0 to 600
  /// Illuminance by the lamp at the part, perpendicular to the light; not used with `lamp`.
  double illuminance_lx = 10.0;
  /// Luminous intensity distribution of the lamp, if it comes from a file. The axis of the lamp points at the centre of
  /// the face.
  std::optional<PhotometricLamp> lamp;
  double lamp_aim_deg = 0.0;  ///< angle by which the lamp's axis is rotated downwards; -45 to 45
  double ambient_lx = 0.0;    ///< illuminance of the face by uniform light from the half space in front
  double backlight_lx = 0.0;  ///< illuminance by uniform light from behind and around the part
  std::size_t columns = 400;
  std::size_t rows = 300;
  std::optional<double> field_mm;  ///< width of the field of view at the part; if empty, the part and a margin
  /// Width and height, in mm, of the sheet that the picture shows for an infinite part. Default: kUsualFilmMm. Not
  /// allowed for finite parts.
  std::optional<std::array<double, 2>> film_mm;
  std::optional<double> cylinder_mm;    ///< radius of the cylinder on which the sheet is bent; negative for its inside
  double noise = 0.02;                  ///< target for the relative noise of a pixel
  std::optional<std::uint32_t> passes;  ///< fixed number of passes; if given, `noise` has no effect
  std::uint32_t seed = 1;
  raytrace::DiscAverage discs = raytrace::DiscAverage::kernel;

  std::array<double, 2> film_size_mm() const { return film_mm.value_or(kUsualFilmMm); }
};

struct CameraResult {
  Design design;
  CameraRequest request;
  raytrace::CameraScene scene;
  raytrace::CameraImage image;
  std::string engine;            ///< "cell" (with Embree at borders) or "embree"
  double observation_deg = 0.0;  ///< angle as seen from the centre of the face
  double entrance_deg = 0.0;
  double viewing_deg = 0.0;
  double elapsed_s = 0.0;
  Warnings warnings;
  bool complete = true;  ///< false: fewer passes than requested
};

/// Study of a checked request, ready to run.
class CameraStudy {
 public:
  static constexpr std::size_t kMostSide = 16384;        ///< maximum number of pixels along a side
  static constexpr std::size_t kMostPixels = 1U << 26U;  ///< maximum number of pixels
  /// Minimum number of passes before the noise is compared with the request.
  static constexpr std::uint32_t kFewestPasses = 8;
  static constexpr std::uint32_t kMostPasses = 65536;
  /// Minimum number of passes after which the requested noise may be judged unreachable.
  static constexpr std::uint32_t kPassesToJudge = 64;

  /// \throw InputError for numbers out of range, for an eye or a lamp inside the part, and for polarised light
  CameraStudy(Design design, CameraRequest request);

  /// Computes the picture.
  /// \param after_pass function that receives the picture after every pass; one call at a time
  /// \param share function that distributes the passes among several processes with equal studies. Without it, this
  ///        process traces all passes.
  CameraResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                   const std::function<void(const raytrace::CameraImage&)>& after_pass = {},
                   const ShareTasks& share = {}) const;
  /// Returns a task that traces the pass with a given number, using all threads.
  /// \pre the study exists as long as the task
  ComputeTask passes() const;

  const raytrace::CameraScene& scene() const { return scene_; }

 private:
  std::shared_ptr<const raytrace::CameraTracer> tracer() const;

  Design design_;
  CameraRequest request_;
  OpticalModel model_;
  raytrace::CameraScene scene_;
};

}  // namespace retrace::studies
