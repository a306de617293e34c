#include "studies/image/io/background_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "core/error.h"
#include "core/pictures.h"
#include "core/srgb.h"
#include "core/text.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMaxPixels = std::size_t{1} << 26U;

Background photograph(const BytePicture& picture) {
  Background background{picture.columns, picture.rows, {}, false};
  // Pictures with one or two channels are grey, with alpha in the second channel.
  const std::size_t colours = picture.channels >= 3 ? 3 : 1;
  for (std::size_t k = 0; k < picture.columns * picture.rows; ++k) {
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c)
      rgb[c] =
          static_cast<float>(linear_from_srgb(picture.values[k * picture.channels + std::min(c, colours - 1)] / 255.0));
    background.rgb.push_back(rgb);
  }
  return background;
}

Background luminances(const FloatPicture& picture) {
  Background background{picture.columns, picture.rows, {}, true};
  std::array<const std::vector<double>*, 3> channels{};
  for (const auto& [name, values] : picture.channels)
    for (std::size_t c = 0; c < 3; ++c)
      if (name == std::array{"R", "G", "B"}[c] || (name == "Y" && channels[c] == nullptr)) channels[c] = &values;
  if (std::ranges::count(channels, nullptr) > 0) throw std::runtime_error("it has neither channels R, G, B nor Y");
  for (std::size_t k = 0; k < picture.columns * picture.rows; ++k) {
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = (*channels[c])[k];
      rgb[c] = std::isfinite(value) && value > 0.0 ? static_cast<float>(value) : 0.0F;
    }
    background.rgb.push_back(rgb);
  }
  return background;
}

}  // namespace

Background read_background(const std::filesystem::path& file, Field field) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw InputError(field, fmt::format("must be a picture that can be read (PNG, JPEG, OpenEXR), {}: it is not a "
                                        "regular file",
                                        file.string()));
  const PictureFiles& files = picture_files();
  try {
    const PictureFiles::Size size = files.size(file);
    if (size.columns * size.rows > kMaxPixels)
      throw std::runtime_error(
          fmt::format("it has {} x {} pixels, at most {} are allowed", size.columns, size.rows, kMaxPixels));
    return ending_of(file) == ".exr" ? luminances(files.read_floats(file)) : photograph(files.read(file));
  } catch (const std::runtime_error& error) {
    throw InputError(field, fmt::format("must be a picture that can be read (PNG, JPEG, OpenEXR), {}: {}",
                                        file.string(), error.what()));
  }
}

}  // namespace retrace::studies
