#pragma once

// Programs that read files of CAD systems with large libraries. Each file is read by a program of its own, whose memory
// and time are limited. A damaged file can therefore not affect retrace.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::geometry {

/// Maximum memory and processor time of a program that reads a file. The program sets these limits itself.
inline constexpr std::size_t kMaxReaderBytes = std::size_t{1} << 30;
inline constexpr unsigned kMaxReaderSeconds = 10;

/// Runs the program lib/retrace/NAME of installation_folder() and returns its standard output.
/// \param package Debian package with the library that the program needs, for messages
/// \throw InputError, with a text that begins with "cannot" or "must", if the program is missing, fails or is too slow
std::string output_of_reader(std::string_view name, std::vector<std::string> arguments, std::string_view package);

}  // namespace retrace::geometry
