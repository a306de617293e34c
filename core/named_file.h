#pragma once

// Reads files whose names are given in another file or in a field of a request. Error messages begin with the position
// (file, line, key) or the field that contains the name.

#include "core/error.h"

namespace retrace {

/// Calls the function `read`, which reads a file. If `read` fails, prepends `key` to the error message.
/// \param key position or field that contains the name of the file
/// \return the return value of `read`
/// \throw InputError if `read` throws an InputError; the message consists of `key` and the message of `read`
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
