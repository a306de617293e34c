#pragma once

// Runs the program that reads STEP files with OpenCASCADE (step_program/). It is started for each file, and its memory
// and time are limited. A damaged file can therefore not affect retrace.

#include <cstddef>
#include <string>
#include <vector>

namespace retrace::geometry {

/// Maximum length of a STEP file.
inline constexpr std::size_t kMaxStepBytes = std::size_t{256} << 20;
/// Maximum memory and processor time of the program, which sets these limits itself.
inline constexpr std::size_t kMaxStepMemoryBytes = std::size_t{1} << 30;
inline constexpr double kMaxStepSeconds = 10.0;

/// Runs the program and returns its result (step_message.h).
/// \param words command-line arguments of the program, without its name
/// \throw InputError, with a text that begins with "cannot" or "must", if the program is missing, fails or is too slow
std::string result_of_step_program(std::vector<std::string> words);

}  // namespace retrace::geometry
