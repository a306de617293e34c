#pragma once

// Pictures of bytes or floats, and the interface to the module that reads all formats of OpenImageIO and writes PNG and
// OpenEXR.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace retrace {

/// A picture of 8-bit values, row by row from the top. The channels of a pixel are stored next to each other.
struct BytePicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t channels = 0;
  /// Index of the alpha channel, or -1 if there is none; the other channels are premultiplied by alpha.
  int alpha_channel = -1;
  std::vector<std::uint8_t> values;
};

/// A picture of floating-point numbers, row by row from the top.
struct FloatPicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::vector<double>>> channels;  ///< name of the channel, and one value per pixel
  std::vector<std::pair<std::string, std::string>> texts;             ///< metadata, such as units
  std::vector<std::pair<std::string, double>> numbers;                ///< metadata that are numbers

  /// Adds a channel. Does nothing if there are no values.
  void add_channel(const std::string& name, const std::vector<double>& values) {
    if (!values.empty()) channels.emplace_back(name, values);
  }
};

/// Reads and writes picture files. If a file cannot be read or created, all functions throw std::runtime_error with the
/// message of OpenImageIO.
class PictureFiles {
 public:
  struct Size {
    std::size_t columns = 0;
    std::size_t rows = 0;
  };

  virtual ~PictureFiles() = default;
  virtual Size size(const std::filesystem::path& file) const = 0;
  virtual BytePicture read(const std::filesystem::path& file) const = 0;
  /// Returns the values of all channels without conversion between colour spaces. `texts` and `numbers` are empty.
  virtual FloatPicture read_floats(const std::filesystem::path& file) const = 0;
  /// Returns the content of an OpenEXR file with 32-bit floats and ZIP compression. The channels are in alphabetical
  /// order. Equal pictures give equal bytes.
  virtual std::string exr(const FloatPicture& picture) const = 0;
  /// Returns the content of a PNG file in sRGB.
  /// \pre the picture has three channels
  virtual std::string png(const BytePicture& picture) const = 0;
};

/// Returns the functions for picture files. They use OpenImageIO, which loads about 250 other libraries. Loading them
/// would cost a quarter of a second and 120 MiB in every run. Therefore they are in a module,
/// lib/retrace/retrace_pictures.so, which is loaded at its first use.
/// \throw OutputError if the module cannot be loaded, for example in a build without OpenImageIO
const PictureFiles& picture_files();

}  // namespace retrace
