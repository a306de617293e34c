// Reads any bytes as a file of materials. The result is a library of materials or an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "materials/io/material_library.h"

namespace {

std::filesystem::path folder;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::string name = "/tmp/retrace_materials_fuzz_XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) std::abort();
  folder = name;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = folder / "materials.toml";
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    static_cast<void>(retrace::materials::MaterialLibrary::read(file));
  } catch (const retrace::InputError&) {
  }
  return 0;
}
