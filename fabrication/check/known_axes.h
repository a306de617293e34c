#pragma once

// Which axes a mill or lathe with few of them has, and that none moves before a word has said where the others are.

#include <cstdint>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Follows the moves of programs: words of axes that the machine has, and no move before all of these are known. A
/// rapid word may say where an axis is.
class KnownAxes {
 public:
  /// \param axes that the machine has, bit i: axis i of kNcAxisLetters
  KnownAxes(FindingList& findings, std::uint8_t axes) : findings_(findings), axes_(axes) {}

  void motion(const NcMotion& motion);

 private:
  FindingList& findings_;
  std::uint8_t axes_;
};

}  // namespace retrace::fabrication
