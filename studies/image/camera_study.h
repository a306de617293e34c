#pragma once

// Pictures of a part that is illuminated by a lamp and seen by an eye. `retrace image` runs this study if a camera is
// requested.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "design/optical_model.h"
#include "raytrace/observers/camera.h"
#include "requests/image.h"
#include "studies/image/background.h"
#include "studies/image/camera_colours.h"
#include "studies/image/camera_light.h"
#include "studies/image/image_result.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

struct CameraResult : ImageResultBase {
  CameraRequest request;
  std::optional<PhotometricLamp> lamp;  ///< lamp that was read from the requested file; empty if no file was requested
  raytrace::CameraScene scene;
  raytrace::CameraImage image;                   ///< luminance
  std::optional<CameraColours> colours;          ///< set if the part is coloured and the light is a CIE illuminant
  std::shared_ptr<const Background> background;  ///< picture behind the part; null if there is none
  /// Reason why the light of the lamp does not include diffraction, or not all of it. Empty if it does.
  std::optional<NoDiffraction> no_diffraction;
  /// R_A in cd/(lx m^2) with diffraction for the centre of the visible face; empty if it was not computed.
  std::optional<double> r_a;
  double r_a_error = 0.0;        ///< standard error of `r_a` caused by the resampling of weak beams
  double observation_deg = 0.0;  ///< angle as seen from the centre of the face
  double entrance_deg = 0.0;
  double viewing_deg = 0.0;
};

/// Reads the requested picture behind the part. Returns null if none is requested.
/// \throw InputError at the field `background` if the picture cannot be read
std::shared_ptr<const Background> background_of(const CameraRequest& request);

/// Study of a checked request, ready to run.
class CameraStudy {
 public:
  /// Minimum number of passes before the noise is compared with the request.
  static constexpr std::uint32_t kMinPasses = 8;
  static constexpr std::uint32_t kMaxPasses = 65536;
  /// Minimum number of passes after which the requested noise may be judged unreachable.
  static constexpr std::uint32_t kPassesToJudge = 64;

  /// \param discs method by which the luminance is averaged over the lamp and the pupil
  /// \param background result of background_of(); null: the study reads the background from the file, if one is
  ///     requested
  /// \throw InputError if a number is out of range, if the eye or the lamp is inside the part, if light is polarised,
  /// or if a file cannot be read. Files are read before the model of the part is made.
  CameraStudy(design::Design design, CameraRequest request, raytrace::DiscAverage discs = raytrace::DiscAverage::kernel,
              std::shared_ptr<const Background> background = nullptr);

  /// Computes the picture.
  /// \param after_pass function that receives the unfinished result after every pass; one call at a time
  /// \param distribute function that distributes the passes among several processes with equal studies. Without it,
  ///        this process traces all passes.
  CameraResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                   const std::function<void(const CameraResult&)>& after_pass = {},
                   const DistributeTasks& distribute = {}) const;
  /// Computes the picture in this process, like run(), and returns its numbers as bytes for result_of(). Returns
  /// nothing if the computation was cancelled.
  std::optional<std::string> run_to_bytes(const Cancellation* cancel) const;
  /// Returns the result that corresponds to these bytes.
  /// \param bytes result of run_to_bytes() of a study with the same settings
  CameraResult result_of(const std::string& bytes) const;
  /// Returns a task that traces the pass with a given number, using all threads.
  /// \pre the study outlives the task
  ComputeTask passes() const;

  const raytrace::CameraScene& scene() const { return scene_; }

 private:
  struct Tracers;
  /// The numbers that identify a picture. Together with the request, they determine the result.
  struct Numbers {
    std::vector<raytrace::CameraImage> images;  ///< one for each element of `lights_`
    std::optional<NoDiffraction> no_diffraction;
    std::optional<double> r_a;
    double r_a_error = 0.0;
    bool is_by_cells = false;
    bool complete = false;
    double elapsed_s = 0.0;
  };

  /// Returns a result without a picture: the request, the design and the geometry.
  CameraResult empty_result() const;
  CameraResult result_with(const Numbers& numbers) const;
  /// Computes the picture. The parameters are those of run().
  Numbers compute(Progress* progress, const Cancellation* cancel,
                  const std::function<void(const CameraResult&)>& after_pass, const DistributeTasks& distribute) const;
  /// Computes the returned light and makes the tracers. Returns null if the computation was cancelled.
  std::shared_ptr<const Tracers> tracers(Progress* progress, const Cancellation* cancel) const;

  design::Design design_;
  design::Design dyed_;  ///< `design_` with the requested dye
  CameraRequest request_;
  std::optional<PhotometricLamp> lamp_;
  design::OpticalModel model_;
  raytrace::CameraScene scene_;
  std::shared_ptr<const Background> background_;
  /// Light as seen by the responses y, x and z, in this order; only y if the picture has no colours.
  std::vector<std::shared_ptr<const CameraLight>> lights_;
};

}  // namespace retrace::studies
