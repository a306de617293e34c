#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace retrace::report {

/// A picture of numbers, row by row from above.
struct FloatPicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::vector<double>>> channels;  ///< name, one value a pixel
  std::vector<std::pair<std::string, std::string>> texts;             ///< metadata, such as units
  std::vector<std::pair<std::string, double>> numbers;                ///< likewise
};

/// Whether this program was built with OpenImageIO, which the functions below need.
bool can_write_pictures();

/// The picture as an OpenEXR file of 32-bit floats, ZIP compressed; channels in alphabetical order of their names, as
/// the format has it. The same picture gives the same bytes. \throw OutputError if it cannot be made, also for want of
/// OpenImageIO
std::string exr_file(const FloatPicture& picture);

/// Eight-bit sRGB pixels, three bytes each, as a PNG file. \throw as exr_file()
std::string png_file(std::size_t columns, std::size_t rows, const std::vector<unsigned char>& rgb);

}  // namespace retrace::report
