#include "report/io/picture_file.h"

#include <stdexcept>

#include "core/error.h"

namespace retrace::report {

std::string exr_file(const FloatPicture& picture) {
  const PictureFiles& files = picture_files();
  try {
    return files.exr(picture);
  } catch (const std::runtime_error& error) {
    throw OutputError(std::string("picture.exr: cannot be made: ") + error.what());
  }
}

std::string png_file(std::size_t columns, std::size_t rows, const std::vector<unsigned char>& rgb) {
  const PictureFiles& files = picture_files();
  try {
    return files.png({columns, rows, 3, -1, rgb});
  } catch (const std::runtime_error& error) {
    throw OutputError(std::string("picture.png: cannot be made: ") + error.what());
  }
}

}  // namespace retrace::report
