// Reads and writes picture files with OpenImageIO. This code is a separate shared library, which is loaded at its first
// use. No other file uses OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include "core/pictures.h"

namespace retrace {
namespace {

/// Throws std::runtime_error.
/// \param why message of OpenImageIO; if it is empty, a default message is used
[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error(why.empty() ? "it ends early or is damaged" : why);
}

/// Discards what is written to standard error while an object of this class exists. libpng and libjpeg write their
/// errors and warnings there, in addition to the errors that OpenImageIO returns.
class SilentLibraries {
 public:
  SilentLibraries() : lock_(mutex()) {
    std::fflush(stderr);
    saved_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (saved_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  ~SilentLibraries() {
    std::fflush(stderr);
    if (saved_ < 0) return;
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
  }
  SilentLibraries(const SilentLibraries&) = delete;
  SilentLibraries& operator=(const SilentLibraries&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }

  std::lock_guard<std::mutex> lock_;
  int saved_ = -1;
};

std::unique_ptr<OIIO::ImageInput> opened(const std::filesystem::path& file) {
  auto input = OIIO::ImageInput::open(file.string());
  if (!input) fail(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1)
    fail("its size is " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
  return input;
}

/// Returns the content of a picture file of the format `name`.
/// \param pixels values of type `type`; all channels of a pixel are stored next to each other
std::string encoded(const char* name, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(name, &memory);
  if (!output) fail(OIIO::geterror());
  if (!output->open(name, spec) || !output->write_image(type, pixels) || !output->close()) fail(output->geterror());
  return {bytes.begin(), bytes.end()};
}

class OpenImageIo final : public PictureFiles {
 public:
  Size size(const std::filesystem::path& file) const override {
    const SilentLibraries silent;
    const OIIO::ImageSpec spec = opened(file)->spec();
    return {static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height)};
  }

  BytePicture read(const std::filesystem::path& file) const override {
    const SilentLibraries silent;
    const auto input = opened(file);
    const OIIO::ImageSpec& spec = input->spec();
    BytePicture picture{static_cast<std::size_t>(spec.width),
                        static_cast<std::size_t>(spec.height),
                        static_cast<std::size_t>(spec.nchannels),
                        spec.alpha_channel,
                        {}};
    picture.values.resize(picture.columns * picture.rows * picture.channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, picture.values.data()))
      fail(input->geterror());
    return picture;
  }

  FloatPicture read_floats(const std::filesystem::path& file) const override {
    const SilentLibraries silent;
    const auto input = opened(file);
    const OIIO::ImageSpec& spec = input->spec();
    FloatPicture picture{static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height), {}, {}, {}};
    const std::size_t pixels = picture.columns * picture.rows;
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(pixels * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) fail(input->geterror());
    for (std::size_t c = 0; c < channels; ++c) {
      auto& [name, channel] = picture.channels.emplace_back(spec.channel_name(static_cast<int>(c)), pixels);
      for (std::size_t k = 0; k < pixels; ++k) channel[k] = static_cast<double>(values[k * channels + c]);
    }
    return picture;
  }

  std::string exr(const FloatPicture& picture) const override {
    auto channels = picture.channels;
    std::sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    OIIO::ImageSpec spec(static_cast<int>(picture.columns), static_cast<int>(picture.rows),
                         static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const auto& [name, values] : channels) spec.channelnames.push_back(name);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // The default is the current time. With it, files of equal pictures would differ.
    for (const auto& [key, value] : picture.texts) spec.attribute(key, value);
    for (const auto& [key, value] : picture.numbers) spec.attribute(key, static_cast<float>(value));
    const std::size_t pixels = picture.columns * picture.rows;
    std::vector<float> interleaved(pixels * channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c)
      for (std::size_t k = 0; k < pixels; ++k)
        interleaved[k * channels.size() + c] = static_cast<float>(channels[c].second[k]);
    return encoded("picture.exr", spec, OIIO::TypeDesc::FLOAT, interleaved.data());
  }

  std::string png(const BytePicture& picture) const override {
    OIIO::ImageSpec spec(static_cast<int>(picture.columns), static_cast<int>(picture.rows), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encoded("picture.png", spec, OIIO::TypeDesc::UINT8, picture.values.data());
  }
};

}  // namespace
}  // namespace retrace

extern "C" __attribute__((visibility("default"))) const retrace::PictureFiles* retrace_picture_files() {
  static const retrace::OpenImageIo files;
  return &files;
}
