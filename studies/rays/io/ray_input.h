#pragma once

// Internal to studies/rays/io: how files of rays are opened, whatever their format.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>

namespace retrace::studies {

/// A stream and how many bytes it has.
struct RayInput {
  std::unique_ptr<std::istream> stream;
  std::uint64_t bytes = 0;
};

/// \throw InputError if it cannot be read; its length must be known before, so that only regular files can
RayInput opened_ray_file(const std::filesystem::path& file);

}  // namespace retrace::studies
