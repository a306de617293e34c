#pragma once

// Reports that a STEP file is refused. Part of the program that reads STEP files.

#include <stdexcept>
#include <string>

namespace retrace::geometry {

/// Ends the reading of the file.
/// \param text message that begins with "must", "is" or "has"
/// \throw std::runtime_error always
[[noreturn]] inline void refuse_step(const std::string& text) {
  throw std::runtime_error(text);
}

}  // namespace retrace::geometry
