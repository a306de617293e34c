// Loads the shared library that reads and writes picture files (core/io/openimageio.cpp).
#include "core/module.h"
#include "core/pictures.h"

namespace retrace {

const PictureFiles& picture_files() {
  static constexpr Module module{.name = "retrace_pictures",
                                 .function = "retrace_picture_files",
                                 .missing_message = "pictures cannot be read or written",
                                 .library = "OpenImageIO",
                                 .package = "libopenimageio2.4"};
  using Entry = const PictureFiles* (*)();
  static const PictureFiles& files = *reinterpret_cast<Entry>(module_function(module))();
  return files;
}

}  // namespace retrace
