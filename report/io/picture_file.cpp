#include "report/io/picture_file.h"

#include "core/error.h"

#ifdef RETRACE_HAS_OPENIMAGEIO
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#endif

namespace retrace::report {

#ifdef RETRACE_HAS_OPENIMAGEIO
namespace {

/// The file of a format as bytes. \param pixels interleaved, of type `type`
std::string encoded(const char* name, OIIO::ImageSpec spec, OIIO::TypeDesc type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(name, &memory);
  if (!output) throw OutputError(std::string(name) + ": cannot be made: " + OIIO::geterror());
  if (!output->open(name, spec) || !output->write_image(type, pixels) || !output->close())
    throw OutputError(std::string(name) + ": cannot be made: " + output->geterror());
  return {bytes.begin(), bytes.end()};
}

}  // namespace

bool can_write_pictures() {
  return true;
}

std::string exr_file(const FloatPicture& picture) {
  const std::size_t pixels = picture.columns * picture.rows;
  auto channels = picture.channels;
  std::sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  OIIO::ImageSpec spec(static_cast<int>(picture.columns), static_cast<int>(picture.rows),
                       static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const auto& [name, values] : channels) spec.channelnames.push_back(name);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // otherwise the time of day, and no two files are alike
  for (const auto& [key, value] : picture.texts) spec.attribute(key, value);
  for (const auto& [key, value] : picture.numbers) spec.attribute(key, static_cast<float>(value));
  std::vector<float> interleaved(pixels * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (std::size_t k = 0; k < pixels; ++k)
      interleaved[k * channels.size() + c] = static_cast<float>(channels[c].second[k]);
  return encoded("picture.exr", spec, OIIO::TypeDesc::FLOAT, interleaved.data());
}

std::string png_file(std::size_t columns, std::size_t rows, const std::vector<unsigned char>& rgb) {
  OIIO::ImageSpec spec(static_cast<int>(columns), static_cast<int>(rows), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return encoded("picture.png", spec, OIIO::TypeDesc::UINT8, rgb.data());
}
#else
bool can_write_pictures() {
  return false;
}

std::string exr_file(const FloatPicture&) {
  throw OutputError("picture.exr: cannot be made: this program was built without OpenImageIO");
}

std::string png_file(std::size_t, std::size_t, const std::vector<unsigned char>&) {
  throw OutputError("picture.png: cannot be made: this program was built without OpenImageIO");
}
#endif

}  // namespace retrace::report
