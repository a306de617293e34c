#pragma once

// Interfaces for sources and sinks of rays. Rays are passed in portions, so that sets of any size need little memory.

#include <cstddef>
#include <span>
#include <vector>

#include "core/warning.h"
#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// Source of rays. The rays have a fixed order and are in the frame of the source.
class RaySource {
 public:
  virtual ~RaySource() = default;
  virtual const RaySetInfo& info() const = 0;
  /// Replaces `rays` by the next rays.
  /// \return false if there are no more rays
  /// \throw InputError with the position of an error in the source
  virtual bool read(std::size_t max_rays, std::vector<SetRay>& rays) = 0;
  /// Returns the fraction of the source that has been read, from 0 to 1.
  virtual double fraction_read() const = 0;
  /// Returns warnings for the user. They are complete after the last ray.
  virtual Warnings warnings() const { return {}; }
};

/// Data of leaving rays, which the sink receives before the first ray.
struct RaySinkLayout {
  RaySetInfo info;
  bool has_wavelengths = false;  ///< true: each ray has a wavelength
};

/// Sink that receives leaving rays in order.
class RaySink {
 public:
  virtual ~RaySink() = default;
  virtual void begin(const RaySinkLayout& layout) = 0;
  virtual void write(std::span<const AccountedRay> rays) = 0;
  /// Must be called after the last ray.
  /// \throw OutputError if the rays cannot be written
  virtual void finish() = 0;
};

}  // namespace retrace::studies
