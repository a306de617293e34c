#pragma once

// Settings that a program must make before its first move, because an earlier program, a manual command or a reset may
// have left another state.

#include <cstdint>
#include <span>
#include <string_view>

#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Setting of the control that a program must make before its first move.
struct RequiredSetting {
  std::uint16_t setting = 0;  ///< bit of nc_setting
  std::string_view words;     ///< NC words that a program uses to make the setting
  std::string_view meaning;   ///< description for messages
};

/// Returns the settings that programs of a dialect must make.
std::span<const RequiredSetting> required_settings_of(NcDialect dialect);

}  // namespace retrace::fabrication
