#include "core/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/installation.h"

namespace retrace {
void* module_function(const Module& module) {
  const std::filesystem::path file = installation_folder() / "lib" / "retrace" / (std::string(module.name) + ".so");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw OutputError(fmt::format("{}: retrace was built without {}: {} is missing", module.missing_message,
                                  module.library, file.string()));
  void* const loaded = ::dlopen(file.c_str(), RTLD_NOW | (module.is_global ? RTLD_GLOBAL : RTLD_LOCAL));
  void* const function = loaded == nullptr ? nullptr : ::dlsym(loaded, std::string(module.function).c_str());
  if (function != nullptr) return function;
  const char* const why = ::dlerror();
  throw OutputError(fmt::format("{}: {}; install the Debian package {}, which contains {}", module.missing_message,
                                why != nullptr ? why : "the module is damaged", module.package, module.library));
}

}  // namespace retrace
