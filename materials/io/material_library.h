#pragma once

// Reads the library of optical materials and metals (data/materials.toml). Designs refer to its entries by name.

#include <filesystem>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "materials/dispersion.h"
#include "materials/metal.h"

namespace retrace::materials {

/// Returns the keys of materials files, with their meaning and limits.
const schema::Format& materials_format();

/// Materials and metals of a file, in the order of the file.
class MaterialLibrary {
 public:
  /// Reads a materials file (TOML with one table [[material]] or [[metal]] per entry).
  /// \throw InputError with file, line and key
  static MaterialLibrary read(const std::filesystem::path& file);
  /// Returns the library in the data folder.
  /// \throw InputError in the same cases as read()
  static MaterialLibrary shipped();

  const std::vector<Material>& all() const { return materials_; }
  /// Returns the material with a name.
  /// \throw InputError at `where` with a list of all names, if there is no such material
  const Material& find(std::string_view name, const InputLocation& where = {}) const;
  const Material& air() const { return find("air"); }
  const std::vector<Metal>& metals() const { return metals_; }
  /// Returns the metal with a name.
  /// \throw InputError in the same cases as find()
  const Metal& find_metal(std::string_view name, const InputLocation& where = {}) const;
  /// Returns the material or metal with a name.
  /// \throw InputError in the same cases as find()
  std::variant<const Material*, const Metal*> find_any(std::string_view name, const InputLocation& where = {}) const;

 private:
  std::vector<Material> materials_;
  std::vector<Metal> metals_;
};

}  // namespace retrace::materials
