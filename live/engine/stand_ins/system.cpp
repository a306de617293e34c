// Replaces the functions that need muParser (formulas) or a loaded module (pictures) by functions that report an error.
// The folder of the installation is fixed instead of searched.
#include "core/installation.h"
#include "core/math/formula.h"
#include "core/pictures.h"
#include "live/engine/stand_ins/absent.h"

namespace retrace {

Formula parse_formula(const std::string&, const std::vector<std::string>&, const InputLocation& where) {
  throw InputError(where, "formulas are not on the live page: use the program retrace");
}

const PictureFiles& picture_files() {
  live::fail_as_absent("no pictures");
}

/// Returns the folder of the files in the bundle.
const std::filesystem::path& installation_folder() {
  static const std::filesystem::path folder = "/retrace";
  return folder;
}

}  // namespace retrace
