#pragma once

// What the stand-ins say of what the live page has not. Files of this folder define functions of other folders, in
// place of the sources that need libraries which a browser cannot have.

#include <string_view>

#include "core/error.h"

namespace retrace::live {

/// \param what is not there, such as "no formulas" \throw InputError that says so
[[noreturn]] inline void fail_as_absent(std::string_view what) {
  throw InputError("the live page has " + std::string(what) + ": use the program retrace");
}

}  // namespace retrace::live
