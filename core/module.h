#pragma once

// Modules: libraries that are loaded at their first use. They would otherwise cost time and memory in every run, or
// they are not installed everywhere.

#include <string_view>

namespace retrace {

/// Description of a module, the file lib/retrace/NAME.so of installation_folder().
struct Module {
  std::string_view name;      ///< name of the file, without .so
  std::string_view function;  ///< name of the function that the module exports, with C linkage
  std::string_view lack;      ///< beginning of the message if the module is missing: what cannot be done
  std::string_view library;   ///< name of the library that the module uses
  std::string_view package;   ///< Debian package that contains this library
  bool is_global = false;     ///< true if libraries that the library loads need its symbols
};

/// Returns the function of a module, which the caller must cast to its type. A loaded module is never unloaded, because
/// libraries keep threads and tables until the process ends.
/// \throw OutputError if the module or its library is missing; the message names the package to install
void* module_function(const Module& module);

}  // namespace retrace
