#pragma once

// Where rays come from and where they go, piece by piece, so that a set of any size takes little memory.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// Rays in the frame of their source, in order.
class RaySource {
 public:
  virtual ~RaySource() = default;
  virtual const RaySetInfo& info() const = 0;
  /// Replaces `rays` by the next ones. \return false behind the last \throw InputError naming the place
  virtual bool read(std::size_t most, std::vector<SetRay>& rays) = 0;
  /// How much of it was read, 0 to 1.
  virtual double share_read() const = 0;
  /// What the user should know of it; all only behind the last ray.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// What rays that leave hold, and what is told of all of them before the first.
struct RaySinkLayout {
  RaySetInfo info;
  bool tells_wavelengths = false;  ///< each ray has one
};

/// Takes rays that leave, in order.
class RaySink {
 public:
  virtual ~RaySink() = default;
  virtual void begin(const RaySinkLayout& layout) = 0;
  virtual void write(std::span<const AccountedRay> rays) = 0;
  /// Behind the last. \throw OutputError
  virtual void finish() = 0;
};

}  // namespace retrace::studies
