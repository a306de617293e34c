#pragma once

// Modules: shared libraries that are loaded at their first use. Some of them would cost time and memory in every run if
// they were linked. Others are not installed on every system.

#include <string_view>

namespace retrace {

/// Description of a module, the file lib/retrace/NAME.so of installation_folder().
struct Module {
  std::string_view name;      ///< name of the file, without .so
  std::string_view function;  ///< name of the function that the module exports, with C linkage
  /// Beginning of the error message if the module is missing; it states what cannot be done without the module.
  std::string_view missing_message;
  std::string_view library;  ///< name of the library that the module uses
  std::string_view package;  ///< Debian package that contains this library
  bool is_global = false;    ///< true if libraries that `library` loads later need its symbols
};

/// Loads a module and returns the address of its function. The caller must cast the address to the type of the
/// function. A loaded module is never unloaded, because libraries keep threads and tables until the process ends.
/// \throw OutputError if the module or its library is missing; the message names the package to install
void* module_function(const Module& module);

}  // namespace retrace
