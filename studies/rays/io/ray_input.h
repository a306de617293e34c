#pragma once

// Opens files of rays, for readers of all formats. Internal to studies/rays/io.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>

namespace retrace::studies {

/// Stream of a file and the length of the file in bytes.
struct RayInput {
  std::unique_ptr<std::istream> stream;
  std::uint64_t bytes = 0;
};

/// Opens a regular file. Other files are refused, because the length must be known.
/// \throw InputError if the file cannot be read
RayInput opened_ray_file(const std::filesystem::path& file);

}  // namespace retrace::studies
