#include "fabrication/job/io/mask_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/message_text.h"

#ifdef RETRACE_HAS_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif

namespace retrace::fabrication {

#ifdef RETRACE_HAS_OPENIMAGEIO
namespace {

/// Grey 0..255 of a pixel with `channels` channels of 0..255.
long grey_of(const std::uint8_t* pixel, int channels, int alpha_channel) {
  const bool coloured = channels >= 3;
  double grey = coloured ? 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2] : pixel[0];
  // OpenImageIO gives colours multiplied by their opacity already.
  if (alpha_channel >= 0 && alpha_channel < channels) grey += 255.0 - pixel[alpha_channel];
  return std::lround(std::min(grey, 255.0));
}

}  // namespace

std::vector<std::string> mask_pattern(const std::filesystem::path& file, double threshold, const CellCounts& cells,
                                      const InputLocation& where) {
  const std::string name = printable(file.string(), std::string::npos);
  const auto unreadable = [&](const std::string& why) -> InputError {
    return {where, fmt::format("{}: cannot be read as a picture: {}", name, printable(why, 200))};
  };
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw unreadable(OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width != cells.columns || spec.height != cells.rows)
    throw InputError(where, fmt::format("{}: must have {} x {} pixels, one for each cell of the array, got {} x {}",
                                        name, cells.columns, cells.rows, spec.width, spec.height));
  const auto columns = static_cast<std::size_t>(spec.width);
  const auto rows = static_cast<std::size_t>(spec.height);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  std::vector<std::uint8_t> pixels(columns * rows * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data()))
    throw unreadable(input->geterror());
  std::vector<std::string> pattern(rows, std::string(columns, '-'));
  bool any = false;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const long grey = grey_of(&pixels[(row * columns + column) * channels], spec.nchannels, spec.alpha_channel);
      if (static_cast<double>(grey) >= threshold * 255.0) continue;
      pattern[row][column] = '#';
      any = true;
    }
  if (!any) throw InputError(where, fmt::format("{}: no pixel is dark enough to be cut", name));
  return pattern;
}
#else
std::vector<std::string> mask_pattern(const std::filesystem::path&, double, const CellCounts&,
                                      const InputLocation& where) {
  throw InputError(where, "this program was built without OpenImageIO, which reads masks");
}
#endif

}  // namespace retrace::fabrication
