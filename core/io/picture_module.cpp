// What the rest of the program sees of pictures: the module is looked for beside the program and loaded once.
#include <dlfcn.h>

#include <system_error>

#include "core/error.h"
#include "core/pictures.h"

namespace retrace {
namespace {

namespace fs = std::filesystem;

const PictureFiles& loaded() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path file = program.parent_path().parent_path() / "lib" / "retrace" / "retrace_pictures.so";
  // Never closed: the library behind it keeps threads and tables to the end.
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const auto fail = [] {
    const char* const why = ::dlerror();
    throw OutputError(std::string("pictures cannot be read or written: ") +
                      (why != nullptr ? why : "their module is damaged"));
  };
  if (module == nullptr) fail();
  using Entry = const PictureFiles* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(module, "retrace_picture_files"));
  if (entry == nullptr) fail();
  return *entry();
}

}  // namespace

const PictureFiles& picture_files() {
  static const PictureFiles& files = loaded();
  return files;
}

}  // namespace retrace
