#include "geometry/io/mask_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/pictures.h"
#include "geometry/elements/whole_elements.h"

namespace retrace::geometry {
namespace {

/// Returns the grey value, 0..255, of a pixel with `channels` channels of 0..255.
long grey_of(const std::uint8_t* pixel, std::size_t channels, int alpha_channel) {
  const bool coloured = channels >= 3;
  double grey = coloured ? 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2] : pixel[0];
  // Colours are premultiplied by their opacity.
  if (alpha_channel >= 0 && static_cast<std::size_t>(alpha_channel) < channels) grey += 255.0 - pixel[alpha_channel];
  return std::lround(std::min(grey, 255.0));
}

void check_size(const std::string& name, const PictureFiles::Size& size, const std::optional<CellCounts>& cells) {
  constexpr std::size_t most_pixels = 40'000'000;
  if (!cells && size.columns > most_pixels / std::max<std::size_t>(1, size.rows))
    throw InputError({name, 0, ""},
                     fmt::format("must have at most {} pixels, got {} x {}", most_pixels, size.columns, size.rows));
  if (cells &&
      (size.columns != static_cast<std::size_t>(cells->columns) || size.rows != static_cast<std::size_t>(cells->rows)))
    throw InputError({name, 0, ""}, fmt::format("must have {} x {} pixels, one for each cell of the array, got {} x {}",
                                                cells->columns, cells->rows, size.columns, size.rows));
}

}  // namespace

std::vector<std::string> mask_pattern(const std::filesystem::path& file, double threshold,
                                      const std::optional<CellCounts>& cells, const InputLocation& where) {
  const std::string name = printable(file.string(), std::string::npos);
  const auto unreadable = [&](const std::string& why) -> InputError {
    return {where, fmt::format("{}: cannot be read as a picture: {}", name, printable(why, 200))};
  };
  BytePicture picture;
  try {
    require_short_file(file, kMaxDataBytes);
    check_size(name, picture_files().size(file), cells);
    picture = picture_files().read(file);
  } catch (const InputError& error) {
    throw InputError(where, error.what());
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw unreadable(error.what());
  }
  std::vector<std::string> pattern(picture.rows, std::string(picture.columns, '-'));
  bool any = false;
  for (std::size_t row = 0; row < picture.rows; ++row)
    for (std::size_t column = 0; column < picture.columns; ++column) {
      const std::uint8_t* const pixel = &picture.values[(row * picture.columns + column) * picture.channels];
      const long grey = grey_of(pixel, picture.channels, picture.alpha_channel);
      if (static_cast<double>(grey) >= threshold * 255.0) continue;
      pattern[row][column] = '#';
      any = true;
    }
  if (!any)
    throw InputError(where,
                     fmt::format("{}: no pixel is darker than the threshold, so the mask selects no element", name));
  return pattern;
}

}  // namespace retrace::geometry
