#pragma once

// Detector maps of the returned light: the points of the entrance face where the light leaves and where it entered, and
// the directions of the light.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/light/direction_score.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/pixel_grid.h"
#include "raytrace/observers/pixel_pyramid.h"

namespace retrace::raytrace {

/// Settings of a detector that records the returned light for one direction of incidence.
struct DetectorSetting {
  PixelGrid face;           ///< pixels on the entrance face, or on one period of it
  DirectionGrid angles;     ///< bins of directions around the direction to the source
  ReturnFrame frame;        ///< axes around the direction to the source
  double acceptance_deg;    ///< half angle of the acceptance cone; the maps of the face contain only light in this cone
  BinRule face_bins = {};   ///< rule by which pixels of the face are merged if they are sampled by rays
  BinRule angle_bins = {};  ///< rule by which bins of directions are merged if they are sampled by rays
};

/// Distribution of the light over the angle from the direction to the source.
struct AngularRings {
  static constexpr double kMaxDeg = 10.0;
  static constexpr std::size_t kCount = 2000;

  std::vector<double> power = std::vector<double>(kCount, 0.0);  ///< power in rings of equal width up to kMaxDeg

  /// Returns the ring that contains an angle, or nothing beyond kMaxDeg.
  static std::optional<std::size_t> ring_at(double angle_rad);
  /// Returns the smallest angle within which the given fraction of the power of all rings leaves, in degrees. Nothing
  /// if there is no power.
  std::optional<double> half_angle_deg(double fraction) const;
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
  AngularRings rings;  ///< without diffraction
};

/// Returns the far field of the returned light with diffraction at the cells, for a point source and a point receiver.
/// Light that the entrance face reflects without entering is not included; it is added to `specular`.
/// \param acceptance_deg half angle of the acceptance cone
/// \param policy settings of the diffraction; `policy.cancel` also cancels the tracing of beams
/// \param specular receives the directions and powers of this light
/// \return nothing if the tracing of beams was cancelled
/// \throw BudgetError in the same cases as BeamTracer::trace(), or if the form of facets needs too many polygons
std::optional<FarField> detector_far_field(const geometry::Part& part, const Optics& optics,
                                           const Illumination& illumination, double acceptance_deg,
                                           const BeamPolicy& beams, const FarFieldPolicy& policy,
                                           std::vector<FarFieldRay>& specular);

/// Computes the maps from beams of polygonal cross-section. The area of a pixel that a polygon covers is computed
/// exactly.
/// \throw BudgetError in the same cases as BeamTracer::trace()
DetectorMaps exact_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                 const DetectorSetting& setting, const BeamPolicy& policy,
                                 const Cancellation* cancel = nullptr);

/// Light of one wavelength that DetectorSampler traces.
struct DetectorLight {
  const Optics* optics = nullptr;  ///< not null
  double weight = 1.0;             ///< fraction of the incident power; the weights of all wavelengths add up to 1
  std::uint32_t seed = 1;
};

/// Computes the maps from rays, in passes of independent replicates. More passes make the maps more accurate.
class DetectorSampler {
 public:
  /// Number of replicates in a pass.
  static constexpr std::uint32_t kReplicates = 32;

  /// \param rays number of rays in a pass at all wavelengths together; it is rounded up to a multiple of the number of
  ///        replicates and wavelengths
  /// \param entrance_face curved entrance face of a finite part, as in MonteCarlo; null for the plane face
  /// \pre all arguments and the optics of `lights` outlive the object; there is at least one wavelength
  DetectorSampler(const geometry::Part& part, const std::vector<DetectorLight>& lights,
                  const Illumination& illumination, const DetectorSetting& setting, std::uint64_t rays,
                  const PathPolicy& policy, const geometry::Entrance* entrance_face = nullptr);
  ~DetectorSampler();

  /// Traces the next pass. Returns false if it was cancelled; the finished replicates are kept.
  /// \throw BudgetError if power is lost
  bool add_pass(Progress* progress = nullptr, const Cancellation* cancel = nullptr);
  /// Returns the number of finished replicates.
  std::uint32_t replicates() const;
  /// Returns the maps of all finished replicates.
  /// \pre replicates() > 1
  DetectorMaps maps() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Computes the maps of one wavelength from one pass of rays. The maps are empty if the computation was cancelled.
/// \throw BudgetError if power is lost
DetectorMaps sampled_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                   const DetectorSetting& setting, std::uint64_t rays, std::uint32_t seed,
                                   const PathPolicy& policy, Progress* progress = nullptr,
                                   const Cancellation* cancel = nullptr);

}  // namespace retrace::raytrace
