#pragma once

// Reads files whose names are given by a key, a field of a request or a table. Error messages begin with the position
// (file, line, key) at which the name is given.

#include "core/error.h"

namespace retrace {

/// Calls the function `read`, which reads a file, and adds a position to its error messages.
/// \param key position at which the name of the file is given
/// \return the return value of `read`
/// \throw InputError if `read` throws an InputError; the message begins with the position `key`
template <class Read>
auto read_named(const InputLocation& key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(key, error.what());
  }
}

/// Calls the function `read`, which reads a file, and adds a field of a request to its error messages.
/// \param field field that contains the name of the file
/// \return the return value of `read`
/// \throw InputError at the field if `read` throws an InputError
template <class Read>
auto read_named(Field field, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(field, error.what());
  }
}

}  // namespace retrace
