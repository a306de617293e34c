#pragma once

// Maps of the returned light over the face and over angles. `retrace image` runs this study if a detector is requested.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "design/engine_facts.h"
#include "design/optical_model.h"
#include "raytrace/observers/detector.h"
#include "requests/image.h"
#include "studies/image/image_result.h"

namespace retrace::studies {

/// Number of rays per pass, and maximum number of passes. Both are used if the request does not specify the number of
/// rays.
inline constexpr std::uint64_t kDetectorRaysPerPass = std::uint64_t{1} << 22;
inline constexpr std::uint32_t kMaxDetectorPasses = 8;
/// Minimum fraction of the light in small bins. Passes are added until this fraction is reached.
inline constexpr double kLightInSmallBins = 0.9;
/// Maximum width of a bin that is regarded as small, as a fraction of the map's width.
inline constexpr double kSmallBin = 0.01;

/// Fractions of the largest value of a map below which bins count as dark.
inline constexpr double kDarkFace = 0.01;
inline constexpr double kDarkAngles = 1e-3;

struct DetectorResult : ImageResultBase {
  DetectorRequest request;
  double acceptance_half_angle_deg = 0.0;
  raytrace::PixelGrid face{{geometry::Vec2::Zero(), geometry::Vec2::Ones()}, 1, 1};
  raytrace::DetectorMaps maps;
  bool is_period = false;           ///< true: the face is one period of an infinite part
  double window_deg = 0.0;          ///< half width of the angular map
  bool has_diffraction = false;     ///< true: the angular map contains diffraction at the cells
  std::string without_diffraction;  ///< reason why the angular map has no diffraction, such as "rays"
  /// Largest standard error of a bin with light, relative to its value; 0 if light was traced as beams.
  double face_error = 0.0;
  double angle_error = 0.0;
  /// Width of bins, in pixels, such that bins of at most this width contain kLightInSmallBins of the light.
  std::size_t face_bin_pixels = 1;
  std::size_t angle_bin_pixels = 1;
  /// True if bins are larger than small bins (kSmallBin) although the maximum number of rays was traced.
  bool is_limit_reached = false;

  /// Returns true if there are maps. There are none if the computation was cancelled too early.
  bool has_maps() const { return !maps.leaving.value.empty(); }
};

/// Study of a detector. The constructor checks the request and prepares the model; run() computes the maps.
class DetectorStudy {
 public:
  /// \param rays_per_pass number of rays in a pass if the request contains no number of rays
  /// \throw InputError if a number is out of range, if a material is unknown, or if the engine cannot trace the light
  /// or the facets
  DetectorStudy(design::Design design, DetectorRequest request, std::uint64_t rays_per_pass = kDetectorRaysPerPass);

  /// Computes the maps.
  /// \throw BudgetError if power was lost, or if too many beams are needed
  DetectorResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

 private:
  /// Computes the maps from beams. They are empty if the computation was cancelled.
  raytrace::DetectorMaps trace_beams(const raytrace::DetectorSetting& setting, Progress* progress,
                                     const Cancellation* cancel) const;
  /// Computes the maps from rays, and stores them and the widths of bins in `result`. If the computation was cancelled,
  /// the maps contain the finished replicates. They are empty if too few replicates are finished.
  void trace_rays(const raytrace::DetectorSetting& setting, Progress* progress, const Cancellation* cancel,
                  DetectorResult& result) const;
  /// Traces a small number of rays, and returns the distribution of their power over the angle from the direction to
  /// the source.
  raytrace::AngularRings pilot_rings(const raytrace::PixelGrid& face, const Cancellation* cancel) const;
  std::vector<raytrace::DetectorLight> lights() const;
  raytrace::DetectorSetting setting_of(const raytrace::PixelGrid& face, double window_deg) const;
  raytrace::BeamPolicy beam_policy() const;
  double window_deg(const raytrace::AngularRings& rings, bool with_diffraction) const;
  std::optional<raytrace::CellInterference> cell_interference(const design::SpectralOptics& light) const;
  std::optional<std::vector<double>> diffracted_map(const design::SpectralOptics& light,
                                                    const raytrace::DetectorSetting& setting,
                                                    const Cancellation* cancel) const;
  bool add_diffraction(DetectorResult& result, const raytrace::DetectorSetting& setting,
                       const Cancellation* cancel) const;

  design::Design design_;
  DetectorRequest request_;
  std::uint64_t rays_per_pass_;
  raytrace::Engine engine_;
  design::OpticalModel model_;
  raytrace::EngineFacts facts_;
};

}  // namespace retrace::studies
