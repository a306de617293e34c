#pragma once

// Turns argc and argv into a call of one command, with all its options read and checked.

#include <functional>
#include <span>
#include <string>

#include "app/command.h"

namespace retrace::app {

/// Reads the command line. \return what runs the command; nothing if help or the version was requested: that is printed
/// \throw InputError for a usage error
std::function<ExitCode()> read_command_line(int argc, const char* const* argv);

}  // namespace retrace::app
