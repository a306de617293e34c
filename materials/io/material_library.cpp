#include "materials/io/material_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "core/atomic_file.h"
#include "core/data_directory.h"

namespace retrace::materials {
namespace {

/// One [[material]] or [[metal]] table; every read names file, line and key when it fails.
class Entry {
 public:
  Entry(const std::string& file, std::string_view kind, const toml::table& table)
      : file_(file), kind_(kind), table_(table) {}

  [[noreturn]] void fail(std::string_view key, std::string_view text) const {
    const toml::node* node = table_.get(key);
    const auto& source = node != nullptr ? node->source() : table_.source();
    throw InputError({file_, static_cast<int>(source.begin.line), fmt::format("{}.{}", kind_, key)}, text);
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
  std::string_view kind_;
  const toml::table& table_;
};

Material read_material(const std::string& file, const toml::table& table) {
  const Entry entry(file, "material", table);
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

Metal read_metal(const std::string& file, const toml::table& table) {
  const Entry entry(file, "metal", table);
  Metal m;
  m.name = entry.text("name");
  m.description = entry.text("description");
  m.model.plasma_ev = entry.numbers("plasma_ev", 1).front();
  const std::vector<double> values = entry.numbers("terms", 3);
  for (std::size_t i = 0; i < values.size(); i += 3) m.model.terms.push_back({values[i], values[i + 1], values[i + 2]});
  const std::vector<double> range = entry.numbers("valid_nm", 2);
  m.valid_from_nm = range[0];
  m.valid_to_nm = range[1];
  m.source = entry.text("source");
  return m;
}

template <class Read>
void for_each_table(const toml::table& root, const std::string& file, const std::string& kind, Read read) {
  const toml::array* entries = root[kind].as_array();
  const std::string must = fmt::format("the file must hold [[{}]] tables", kind);
  if (entries == nullptr) throw InputError({file, 0, kind}, must);
  for (const toml::node& node : *entries) {
    if (!node.is_table()) throw InputError({file, 0, kind}, must);
    read(*node.as_table());
  }
}

/// \throw InputError at `where` if no item has the name
template <class Item>
const Item& find_by_name(const std::vector<Item>& items, std::string_view kind, std::string_view name,
                         const InputLocation& where) {
  std::vector<std::string> names;
  for (const Item& item : items) {
    if (item.name == name) return item;
    names.push_back(item.name);
  }
  throw InputError(where,
                   fmt::format("no {} of that name, got \"{}\"; there are {}", kind, name, fmt::join(names, ", ")));
}

}  // namespace

MaterialLibrary MaterialLibrary::read(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string content = read_file(file);
  MaterialLibrary library;
  try {
    const toml::table root = toml::parse(content, name);
    for_each_table(root, name, "material",
                   [&](const toml::table& table) { library.materials_.push_back(read_material(name, table)); });
    if (root.contains("metal"))
      for_each_table(root, name, "metal",
                     [&](const toml::table& table) { library.metals_.push_back(read_metal(name, table)); });
  } catch (const toml::parse_error& error) {
    throw InputError({name, static_cast<int>(error.source().begin.line), ""}, error.description());
  }
  return library;
}

MaterialLibrary MaterialLibrary::shipped() {
  return read(data_directory() / "materials.toml");
}

const Material& MaterialLibrary::find(std::string_view name, const InputLocation& where) const {
  return find_by_name(materials_, "material", name, where);
}

const Metal& MaterialLibrary::find_metal(std::string_view name, const InputLocation& where) const {
  return find_by_name(metals_, "metal", name, where);
}

}  // namespace retrace::materials
