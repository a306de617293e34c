#pragma once

// Built-in emitter that replaces a ray file: a disc that emits rays with one of three distributions.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Distribution of rays over positions on the disc and over directions.
enum class EmitterKind {
  lambertian,  ///< uniform over the disc; constant radiance up to the half-angle
  gaussian,    ///< positions and angles distributed as exp(-2 (q / w)^2); w is the radius of the disc or the half-angle
  collimated   ///< uniform over the disc, and uniform per solid angle up to the half-angle
};
inline constexpr std::array<std::string_view, 3> kEmitterNames = {"lambertian", "gaussian", "collimated"};

/// Disc around the origin that emits rays towards +z.
struct Emitter {
  EmitterKind kind = EmitterKind::lambertian;
  double disc_mm = 0.0;  ///< diameter of the emitting disc; 0 for a point source
  /// Two sides of an emitting parallelogram that is centred at the origin, in the frame of the source. If they are
  /// given, the parallelogram replaces the disc and emits uniformly.
  std::optional<std::array<Vec3, 2>> period_mm = {};
  double half_angle_deg = 90.0;  ///< 0 to 90
  std::uint64_t rays = 1'000'000;
  double power = 1.0;        ///< power of all rays together
  bool is_luminous = false;  ///< true: power in lm; false: power in W
  std::uint32_t seed = 1;
};

/// Returns the kind of emitter that has the given name.
/// \pre `name` is one of kEmitterNames
EmitterKind emitter_from_name(std::string_view name);

/// Request for an emitter.
struct EmitterRequest {
  EmitterKind kind = EmitterKind::lambertian;
  /// Diameter of the emitting disc. By default, a collimated emitter covers the entrance face, or one period of an
  /// infinite part. Other emitters are points by default.
  std::optional<double> disc_mm;
  std::optional<double> half_angle_deg;  ///< none: 90 for `lambertian`, otherwise 0
  std::uint64_t rays = 1'000'000;
  double power = 1.0;
};

/// Source of random rays of equal power.
class EmitterSource : public RaySource {
 public:
  explicit EmitterSource(const Emitter& emitter);

  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t max_rays, std::vector<SetRay>& rays) override;
  double fraction_read() const override;

 private:
  Vec3 position(double u, double v) const;
  SetRay ray(std::uint64_t number) const;

  Emitter emitter_;
  RaySetInfo info_;
  std::uint64_t rays_read_ = 0;
};

}  // namespace retrace::studies
