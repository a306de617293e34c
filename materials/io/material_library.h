#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "materials/dispersion.h"

namespace retrace::materials {

/// The shipped materials, in the order of the file.
class MaterialLibrary {
 public:
  /// Reads a materials file (TOML, one [[material]] table each). \throw InputError naming file, line and key
  static MaterialLibrary read(const std::filesystem::path& file);
  /// The library in the data folder. \throw InputError
  static MaterialLibrary shipped();

  const std::vector<Material>& all() const { return materials_; }
  /// \throw InputError at `where`, listing what there is
  const Material& find(std::string_view name, const InputLocation& where = {}) const;
  const Material& air() const { return find("air"); }

 private:
  std::vector<Material> materials_;
};

}  // namespace retrace::materials
