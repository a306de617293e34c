#pragma once

// Reads files that are named by a key, an option or a column of a table. Error messages begin with the position at
// which the file is named.

#include "core/error.h"

namespace retrace {

/// Calls `read`, which reads a file that is named by a key.
/// \param key position at which the file is named
/// \return the return value of `read`
/// \throw InputError if `read` throws one; its message is preceded by the position of the key
template <class Read>
auto read_named(const InputLocation& key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(key, error.what());
  }
}

}  // namespace retrace
