#include "core/installation.h"

#include <dlfcn.h>

#include <system_error>

namespace retrace {
namespace fs = std::filesystem;
namespace {

/// Returns the file of the program or library that contains this code.
fs::path own_file() {
  std::error_code ignored;
  Dl_info found = {};
  // For a program, dladdr() returns the name with which it was called. This name may be relative or a symbolic link.
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (::dladdr(reinterpret_cast<const void*>(&installation_folder), &found) == 0 || found.dli_fname == nullptr)
    return program;
  const fs::path file = fs::canonical(found.dli_fname, ignored);
  return ignored || fs::equivalent(file, program, ignored) ? program : file;
}

fs::path find_installation() {
  const fs::path folder = own_file().parent_path();
  std::error_code ignored;
  for (fs::path above = folder; above != above.root_path(); above = above.parent_path())
    if (fs::is_directory(above / "share" / "retrace", ignored)) return above;
  return folder.parent_path();
}

}  // namespace

const fs::path& installation_folder() {
  static const fs::path folder = find_installation();
  return folder;
}

}  // namespace retrace
