#pragma once

// Rays in memory: sources and sinks of plain arrays, numbers of one ray after those of another.

#include <span>
#include <vector>

#include "studies/rays/ray_limits.h"
#include "studies/rays/ray_source.h"

namespace retrace::studies {

/// Arrays of a source; they must outlive it.
struct RaySpans {
  std::span<const double> origins_mm;      ///< three a ray
  std::span<const double> directions;      ///< three a ray, of any length above 0
  std::span<const double> stokes;          ///< four a ray, the first its power; or four for all
  std::span<const double> axes;            ///< three a ray, across the direction; empty: +x seen across it
  std::span<const double> wavelengths_nm;  ///< one a ray, one for all, or none
};

class ArraySource : public RaySource {
 public:
  /// \throw InputError naming the array: `origins`, `directions`, `stokes`, `axes` or `wavelength_nm`
  explicit ArraySource(const RaySpans& arrays);

  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t most, std::vector<SetRay>& rays) override;
  double share_read() const override;

 private:
  SetRay ray(std::size_t number) const;

  RaySpans arrays_;
  RaySetInfo info_;
  std::size_t count_ = 0;
  std::size_t rays_read_ = 0;
  TotalPower total_;
};

/// Keeps what leaves.
class ArraySink : public RaySink {
 public:
  /// \param rays about so many: memory is taken at once
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
  std::vector<std::uint64_t> incident;  ///< from 0
};

}  // namespace retrace::studies
