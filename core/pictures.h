#pragma once

// Pictures of bytes or floats, and the interface to the module that reads every format OpenImageIO knows and writes PNG
// and OpenEXR.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace retrace {

/// A picture of 8-bit values, row by row from above, the channels of a pixel side by side.
struct BytePicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t channels = 0;
  int alpha_channel = -1;  ///< -1: none; other channels are multiplied by it already
  std::vector<std::uint8_t> values;
};

/// A picture of numbers, row by row from above.
struct FloatPicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::vector<double>>> channels;  ///< name, one value a pixel
  std::vector<std::pair<std::string, std::string>> texts;             ///< metadata, such as units
  std::vector<std::pair<std::string, double>> numbers;                ///< likewise
};

/// Reads and writes files of pictures. Every function throws std::runtime_error, with what the library says, for a file
/// that cannot be read or made.
class PictureFiles {
 public:
  struct Size {
    std::size_t columns = 0;
    std::size_t rows = 0;
  };

  virtual ~PictureFiles() = default;
  virtual Size size(const std::filesystem::path& file) const = 0;
  virtual BytePicture read(const std::filesystem::path& file) const = 0;
  /// 32-bit floats, ZIP compressed, channels in alphabetical order of their names. The same picture gives the same
  /// bytes.
  virtual std::string exr(const FloatPicture& picture) const = 0;
  /// sRGB. \pre three channels
  virtual std::string png(const BytePicture& picture) const = 0;
};

/// The library behind PictureFiles, OpenImageIO, brings some 250 others with it, whose loading would take a quarter of
/// a second and 120 MiB of every run. So it is a module of its own, lib/retrace/retrace_pictures.so beside the
/// program's bin/ folder, loaded at its first use. \throw OutputError if the module cannot be loaded, as in a build
/// without OpenImageIO
const PictureFiles& picture_files();

}  // namespace retrace
