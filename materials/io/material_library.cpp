#include "materials/io/material_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "core/atomic_file.h"
#include "core/data_directory.h"

namespace retrace::materials {
namespace {

/// One [[material]] table; every read names file, line and key when it fails.
class Entry {
 public:
  Entry(const std::string& file, const toml::table& table) : file_(file), table_(table) {}

  [[noreturn]] void fail(std::string_view key, std::string_view text) const {
    const toml::node* node = table_.get(key);
    const auto& source = node != nullptr ? node->source() : table_.source();
    throw InputError({file_, static_cast<int>(source.begin.line), "material." + std::string(key)}, text);
  }

  std::string text(std::string_view key) const {
    const auto value = table_[key].value<std::string>();
    if (!value) fail(key, "must be a text");
    return *value;
  }

  bool flag(std::string_view key) const { return table_[key].value_or(false); }
  double number_or(std::string_view key, double otherwise) const { return table_[key].value_or(otherwise); }

  std::vector<double> numbers(std::string_view key, std::size_t multiple_of) const {
    std::vector<double> values;
    if (const toml::array* array = table_[key].as_array())
      for (const toml::node& node : *array) {
        const auto value = node.value<double>();
        if (!value) fail(key, "must be a list of numbers");
        values.push_back(*value);
      }
    if (values.empty() || values.size() % multiple_of != 0)
      fail(key, fmt::format("must be a list of numbers, {} for each term", multiple_of));
    return values;
  }

  template <class Model>
  Model pairs() const {
    Model model;
    const std::vector<double> values = numbers("coefficients", 2);
    for (std::size_t i = 0; i < values.size(); i += 2) model.terms.push_back({values[i], values[i + 1]});
    return model;
  }

  Dispersion dispersion() const {
    const std::string formula = text("formula");
    if (formula == "constant") return ConstantIndex{numbers("coefficients", 1).front()};
    if (formula == "sellmeier") return pairs<Sellmeier>();
    if (formula == "gas") return pairs<GasRefractivity>();
    if (formula != "power series") fail("formula", "must be constant, power series, sellmeier or gas, got " + formula);
    PowerSeries series;
    const std::vector<double> values = numbers("coefficients", 2);
    for (std::size_t i = 0; i < values.size(); i += 2)
      series.terms.push_back({values[i], static_cast<int>(values[i + 1])});
    return series;
  }

 private:
  const std::string& file_;
  const toml::table& table_;
};

Material read_material(const std::string& file, const toml::table& table) {
  const Entry entry(file, table);
  Material m;
  m.name = entry.text("name");
  m.description = entry.text("description");
  m.dispersion = entry.dispersion();
  m.relative_to_vacuum = entry.flag("relative_to_vacuum");
  const std::vector<double> range = entry.numbers("valid_nm", 2);
  m.valid_from_nm = range[0];
  m.valid_to_nm = range[1];
  m.absorption_per_mm = entry.number_or("absorption_per_mm", 0.0);
  m.source = entry.text("source");
  return m;
}

}  // namespace

MaterialLibrary MaterialLibrary::read(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string content = read_file(file);
  MaterialLibrary library;
  try {
    const toml::table root = toml::parse(content, name);
    const toml::array* entries = root["material"].as_array();
    if (entries == nullptr) throw InputError({name, 0, "material"}, "the file must hold [[material]] tables");
    for (const toml::node& node : *entries) {
      if (!node.is_table()) throw InputError({name, 0, "material"}, "the file must hold [[material]] tables");
      library.materials_.push_back(read_material(name, *node.as_table()));
    }
  } catch (const toml::parse_error& error) {
    throw InputError({name, static_cast<int>(error.source().begin.line), ""}, error.description());
  }
  return library;
}

MaterialLibrary MaterialLibrary::shipped() {
  return read(data_directory() / "materials.toml");
}

const Material& MaterialLibrary::find(std::string_view name, const InputLocation& where) const {
  for (const Material& m : materials_)
    if (m.name == name) return m;
  std::vector<std::string> names;
  for (const Material& m : materials_) names.push_back(m.name);
  throw InputError(where,
                   fmt::format("no material of that name, got \"{}\"; there are {}", name, fmt::join(names, ", ")));
}

}  // namespace retrace::materials
