#pragma once

// Pictures of a part in the light of a lamp as an eye sees it: `retrace image` with a camera.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "raytrace/observers/camera.h"
#include "studies/design/optical_model.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Default width and height, in mm, of the sheet that the picture shows for an infinite part.
inline constexpr std::array<double, 2> kUsualFilmMm = {100.0, 100.0};

/// What is asked of a camera: a picture of the part in the light of a lamp. Positions are those of CameraScene.
struct CameraRequest {
  double distance_m = 10.0;       ///< of lamp and eye from the middle of the face; > 0
  double observation_deg = 0.33;  ///< by which the eye is above the lamp; 0 to 180
  double v_deg = 0.0;             ///< where the lamp is, as regulations say it; -90 to 90
  double h_deg = 0.0;
  double rotation_deg = 0.0;                     ///< of the part about its normal
  std::optional<std::array<double, 3>> eye_mm;   ///< in place of distance and angles
  std::optional<std::array<double, 3>> lamp_mm;  ///< likewise
  double lamp_arcmin = 10.0;                     ///< diameter of its disc; > 0, up to 600
  double pupil_arcmin = 10.0;                    ///< likewise, of the eye's pupil; >= 0
  double illuminance_lx = 10.0;                  ///< of the lamp across its beam, at the part; without `lamp`
  std::optional<PhotometricLamp> lamp;  ///< whose intensity gives it; its axis points at the middle of the face
  double lamp_aim_deg = 0.0;            ///< by which that axis is turned down; -45 to 45
  double ambient_lx = 0.0;              ///< of even light from all of the half space in front, on the face
  double backlight_lx = 0.0;            ///< likewise from behind and round the part
  std::size_t columns = 400;
  std::size_t rows = 300;
  std::optional<double> field_mm;  ///< what the picture's width shows at the part; none: the part and some margin
  /// Width and height, in mm, of the sheet that the picture shows for an infinite part. Default: kUsualFilmMm. Not
  /// allowed for finite parts.
  std::optional<std::array<double, 2>> film_mm;
  std::optional<double> cylinder_mm;    ///< radius of the cylinder that the sheet is bent over; < 0: its hollow side
  double noise = 0.02;                  ///< relative, of a pixel, to reach
  std::optional<std::uint32_t> passes;  ///< in place of it
  std::uint32_t seed = 1;
  raytrace::DiscAverage discs = raytrace::DiscAverage::kernel;

  std::array<double, 2> film_size_mm() const { return film_mm.value_or(kUsualFilmMm); }
};

struct CameraResult {
  Design design;
  CameraRequest request;
  raytrace::CameraScene scene;
  raytrace::CameraImage image;
  std::string engine;            ///< cell, with Embree at borders, or embree
  double observation_deg = 0.0;  ///< as seen from the middle of the face
  double entrance_deg = 0.0;
  double viewing_deg = 0.0;
  double elapsed_s = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;  ///< false: fewer passes than requested
};

/// A checked request, ready to run.
class CameraStudy {
 public:
  static constexpr std::size_t kMostSide = 16384;        ///< pixels along a side
  static constexpr std::size_t kMostPixels = 1U << 26U;  ///< in all
  static constexpr std::uint32_t kFewestPasses = 8;      ///< before the noise is looked at
  static constexpr std::uint32_t kMostPasses = 65536;
  static constexpr std::uint32_t kPassesToJudge = 64;  ///< before a noise counts as out of reach

  /// \throw InputError for numbers out of range, an eye or a lamp inside the part, polarised light
  CameraStudy(Design design, CameraRequest request);

  /// \param after_pass told of the picture after every pass, one call at a time \param share has the passes traced by
  /// several processes, each with an equal study; none: by this one
  CameraResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                   const std::function<void(const raytrace::CameraImage&)>& after_pass = {},
                   const ShareTasks& share = {}) const;
  /// Traces passes as tasks of their numbers, each on all threads. \pre the study outlives it
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
