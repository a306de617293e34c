#pragma once

// Rays in memory: ray sources and sinks that use plain arrays. The numbers of each ray are contiguous.

#include <span>
#include <vector>

#include "studies/rays/ray_limits.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Arrays of a source. They must exist as long as the source.
struct RaySpans {
  std::span<const double> origins_mm;  ///< three numbers per ray
  std::span<const double> directions;  ///< three numbers per ray; any length above 0
  /// Four numbers per ray, of which the first is the power; or four numbers for all rays.
  std::span<const double> stokes;
  /// Three numbers per ray, perpendicular to the direction; empty: the x axis, projected perpendicular to the
  /// direction.
  std::span<const double> axes;
  std::span<const double> wavelengths_nm;  ///< one number per ray, one for all rays, or none
};

class ArraySource : public RaySource {
 public:
  /// \throw InputError with the name of the invalid array as location: `origins`, `directions`, `stokes`, `axes` or
  /// `wavelength_nm`
  explicit ArraySource(const RaySpans& arrays);

  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t max_rays, std::vector<SetRay>& rays) override;
  double fraction_read() const override;

 private:
  SetRay ray(std::size_t number) const;

  RaySpans arrays_;
  RaySetInfo info_;
  std::size_t count_ = 0;
  std::size_t rays_read_ = 0;
  TotalPower total_;
};

/// Sink that stores the rays that leave the part in arrays.
class ArraySink : public RaySink {
 public:
  /// \param rays approximate number of rays for which memory is reserved
  explicit ArraySink(std::size_t rays);
  void begin(const RaySinkLayout&) override {}
  void write(std::span<const AccountedRay> rays) override;
  void finish() override {}

  std::vector<double> origins_mm;
  std::vector<double> directions;
  std::vector<double> stokes;
  std::vector<double> axes;
  std::vector<double> wavelengths_nm;
  std::vector<std::uint8_t> accounts;
  std::vector<std::uint64_t> incident;  ///< number of the incident ray, from 0
};

}  // namespace retrace::studies
