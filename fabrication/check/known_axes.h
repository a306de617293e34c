#pragma once

// Checks the axes of programs for machines with fewer than five axes. A program must not use axes that the machine does
// not have, and must not move while the position of an axis is unknown.

#include <cstdint>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Checks that programs move only axes that the machine has, and that the positions of all axes are known before a
/// move. Exception: a rapid move may move axes with unknown positions if it moves no other axes, because it makes their
/// positions known.
class KnownAxes {
 public:
  /// \param axes axes of the machine, as one bit for each axis of kNcAxisLetters
  KnownAxes(FindingList& findings, std::uint8_t axes) : findings_(findings), axes_(axes) {}

  void motion(const NcMotion& motion);

 private:
  FindingList& findings_;
  std::uint8_t axes_;
};

}  // namespace retrace::fabrication
