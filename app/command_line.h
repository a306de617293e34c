#pragma once

// Parses the command line. Reads and checks the options of a command.

#include <functional>

#include "app/command.h"

namespace retrace::app {

/// Parses the command line. Prints the help or the version if it is requested.
/// \return function that runs the command; empty if there is no command to run
/// \throw InputError for a usage error
std::function<ExitCode()> read_command_line(int argc, const char* const* argv);

}  // namespace retrace::app
