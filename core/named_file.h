#pragma once

// Files that a key, an option or a column of a table names: messages about them begin with the place of that name.

#include "core/error.h"

namespace retrace {

/// Calls `read`, which reads a file that a key names. \param key place where the file is named
/// \return the value of `read` \throw InputError of `read`, with the place of the key in front
template <class Read>
auto read_named(const InputLocation& key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(key, error.what());
  }
}

}  // namespace retrace
