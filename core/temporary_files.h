#pragma once

// Removal of temporary files when the process ends without running destructors.

namespace retrace {

/// Removes the temporary files of unfinished outputs. A signal handler may call it before it ends the process.
void remove_temporary_files() noexcept;

}  // namespace retrace
