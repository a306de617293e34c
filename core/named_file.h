#pragma once

// Reads files whose names are given by a key, a field of a request or a table. Error messages begin with the position
// (file, line, key) or the field at which the name is given.

#include "core/error.h"

namespace retrace {

/// Calls the function `read`, which reads a file, and adds a position to its error messages.
/// \param key position or field at which the name of the file is given
/// \return the return value of `read`
/// \throw InputError if `read` throws an InputError; the message begins with `key`
template <class Read, class Key>
auto read_named_at(const Key& key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(key, error.message([](std::string_view name) { return reference(Field{name}); }));
  }
}
template <class Read>
auto read_named(const InputLocation& key, const Read& read) {
  return read_named_at(key, read);
}
template <class Read>
auto read_named(Field key, const Read& read) {
  return read_named_at(key, read);
}

}  // namespace retrace
