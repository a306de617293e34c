#pragma once

// Checks the axes of programs for machines with less than five axes: no unknown axes, and no moves while the position
// of an axis is unknown.

#include <cstdint>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Checks that programs only move axes that the machine has, and only after the positions of all axes are known. A
/// rapid move may set the position of an axis.
class KnownAxes {
 public:
  /// \param axes axes of the machine; bit i: axis i of kNcAxisLetters
  KnownAxes(FindingList& findings, std::uint8_t axes) : findings_(findings), axes_(axes) {}

  void motion(const NcMotion& motion);

 private:
  FindingList& findings_;
  std::uint8_t axes_;
};

}  // namespace retrace::fabrication
