#pragma once

// Reads the library of optical materials and metals (data/materials.toml), in which designs look up their substance by
// name.

#include <filesystem>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "materials/dispersion.h"
#include "materials/metal.h"

namespace retrace::materials {

/// The keys of materials files.
const schema::Format& materials_format();

/// The shipped materials and metals, each in the order of the file.
class MaterialLibrary {
 public:
  /// Reads a materials file (TOML, one [[material]] or [[metal]] table each). \throw InputError naming file, line and
  /// key
  static MaterialLibrary read(const std::filesystem::path& file);
  /// The library in the data folder. \throw InputError
  static MaterialLibrary shipped();

  const std::vector<Material>& all() const { return materials_; }
  /// \throw InputError at `where`, listing what there is
  const Material& find(std::string_view name, const InputLocation& where = {}) const;
  const Material& air() const { return find("air"); }
  const std::vector<Metal>& metals() const { return metals_; }
  /// \throw InputError as find()
  const Metal& find_metal(std::string_view name, const InputLocation& where = {}) const;
  /// Of either kind. \throw InputError as find()
  std::variant<const Material*, const Metal*> find_any(std::string_view name, const InputLocation& where = {}) const;

 private:
  std::vector<Material> materials_;
  std::vector<Metal> metals_;
};

}  // namespace retrace::materials
