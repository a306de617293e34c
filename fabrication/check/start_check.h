#pragma once

// How a program of a mill or lathe with few axes may begin: an axis is nowhere until a word says where.

#include <cstdint>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Follows the first moves of a program: Z alone and above the blank, then the other axes, before anything else moves.
class StartCheck {
 public:
  /// \param axes that the machine has, a bit each \param clear_mm height of moves over the blank
  StartCheck(FindingList& findings, std::uint8_t axes, double clear_mm)
      : findings_(findings), axes_(axes), clear_mm_(clear_mm) {}

  /// A program begins.
  void begin() { is_first_ = true; }
  void motion(const NcMotion& motion);

 private:
  FindingList& findings_;
  std::uint8_t axes_;
  double clear_mm_;
  bool is_first_ = true;
};

}  // namespace retrace::fabrication
