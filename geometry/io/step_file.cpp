#include "geometry/io/step_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/number_format.h"

// OpenCASCADE stands in a module that is loaded when the first STEP file is written: its libraries would cost every run
// of the program time and memory.

namespace retrace::geometry {
namespace {

namespace fs = std::filesystem;

using WriteStep = void (*)(const FacetedSolid& solid, const std::string& name, std::string& text);

void require_long_edges(const FacetedSolid& solid) {
  double least = INFINITY;
  for (const SolidFace& face : solid.faces)
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        least = std::min(least, (solid.vertices[loop[i]] - solid.vertices[loop[(i + 1) % loop.size()]]).norm());
  if (least < kShortestStepEdgeMm)
    throw InputError(fmt::format("STEP takes edges of {} mm and more, the shortest of this solid is {} mm",
                                 shortest(kShortestStepEdgeMm), shortest(least)));
}

WriteStep loaded() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path file = program.parent_path().parent_path() / "lib" / "retrace" / "retrace_step.so";
  // Never closed: the library behind it keeps tables to the end.
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const auto entry = module == nullptr ? nullptr : reinterpret_cast<WriteStep>(::dlsym(module, "retrace_write_step"));
  if (entry != nullptr) return entry;
  const char* const why = ::dlerror();
  throw OutputError(std::string("STEP cannot be written, STL and OBJ can: ") +
                    (why != nullptr ? why : "its module is damaged"));
}

}  // namespace

std::string step_text(const FacetedSolid& solid, const std::string& name) {
  require_long_edges(solid);
  static const WriteStep write = loaded();
  std::string text;
  write(solid, name, text);
  return text;
}

}  // namespace retrace::geometry
