#pragma once

// Removes temporary files if a process ends without running destructors.

namespace retrace {

/// Removes the temporary files of output files that are not complete. A signal handler may call this function before it
/// ends the process.
void remove_temporary_files() noexcept;

}  // namespace retrace
