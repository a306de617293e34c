#include "studies/rays/io/ray_input.h"

#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace retrace::studies {

RayInput opened_ray_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    const bool is_there = std::filesystem::exists(file, ignored);
    throw InputError({file.string(), 0, ""}, is_there ? "cannot be read: it is not a regular file"
                                                      : "cannot be read: No such file or directory");
  }
  auto stream = std::make_unique<std::ifstream>(file, std::ios::binary);
  if (!*stream) throw InputError({file.string(), 0, ""}, "cannot be read");
  return {std::move(stream), std::filesystem::file_size(file)};
}

}  // namespace retrace::studies
