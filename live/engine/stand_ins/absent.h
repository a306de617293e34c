#pragma once

// Reports features that the live page does not have. The files in this folder define functions that are declared in
// other folders. They replace sources whose libraries are not available in a browser.

#include <string_view>

#include "core/error.h"

namespace retrace::live {

/// Fails because a feature is missing.
/// \param what missing feature, such as "no formulas"
/// \throw InputError always
[[noreturn]] inline void fail_as_absent(std::string_view what) {
  throw InputError("the live page has " + std::string(what) + ": use the program retrace");
}

}  // namespace retrace::live
