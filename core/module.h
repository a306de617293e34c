#pragma once

// Modules: libraries that cost every run time and memory, or that not everybody has, are taken in when they are first
// needed.

#include <string_view>

namespace retrace {

/// A library behind lib/retrace/NAME.so of installation_folder().
struct Module {
  std::string_view name;      ///< of its file, without .so
  std::string_view function;  ///< that it offers, with C linkage
  std::string_view lack;      ///< what cannot be done without it, the beginning of a message
  std::string_view library;   ///< that it brings, by its own name
  std::string_view package;   ///< of Debian with that library
  bool is_global = false;     ///< whether what the library loads itself is to see the library's symbols
};

/// The module's function, to be cast to what it is. A module that was loaded stays: libraries keep threads and tables
/// to the end. \throw OutputError where the module or its library is missing, which says what to install
void* module_function(const Module& module);

}  // namespace retrace
