#pragma once

// What programs must say before anything moves, whatever an earlier program, a line typed in or a reset has left.

#include <cstdint>
#include <span>
#include <string_view>

#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// A setting of the control that a dialect has words for.
struct NcNeed {
  std::uint16_t said = 0;    ///< a bit of nc_said
  std::string_view words;    ///< that say it
  std::string_view meaning;  ///< for people
};

/// What every control of a dialect may have been left with.
std::span<const NcNeed> needs_of(NcDialect dialect);

}  // namespace retrace::fabrication
