#include "materials/io/material_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/number_format.h"
#include "core/schema/conditions.h"
#include "core/schema/reader.h"

namespace retrace::materials {
namespace {

using namespace schema;

constexpr Words kFormulas = {"constant", "power series", "sellmeier", "gas"};
constexpr Condition kIsConstant[] = {is("formula", only(kFormulas, "constant"))};
constexpr Condition kIsCurve[] = {is_not("formula", only(kFormulas, "constant"))};
constexpr Condition kWithThermoOptic[] = {is_given("thermo_optic")};
constexpr NumberRange kAtLeastZero{.low = 0.0};
constexpr NumberRange kAboveZero{.low = 0.0, .low_included = false};

constexpr Row kMaterialRows[] = {
    {"name", Text{}, kRequired, "Name of the material in designs."},
    {"description", Text{}, kRequired, "Description of the material."},
    {"formula", Word{kFormulas}, kRequired,
     "Formula of the refractive index as a function of the vacuum wavelength in um."},
    {"coefficients", Terms{1}, kRequired, "Refractive index.", kIsConstant},
    {"coefficients", Terms{2}, kRequired,
     "Coefficients of the formula's terms, as described at the head of the shipped file.", Access(), kIsCurve},
    {"relative_to_vacuum", Flag{}, false,
     "Whether indices are relative to vacuum; otherwise they are relative to air."},
    {"valid_nm", Numbers{2, {}}, kRequired, "First and last wavelength for which the formula is valid."},
    {"temperature_c", Number{}, 20.0, "Temperature for which the coefficients are valid."},
    {"thermo_optic", Numbers{6, {}}, kNone,
     "Coefficients of the temperature dependence of the index against vacuum, as described at the head of the shipped "
     "file: D0, D1, D2, E0, E1, w_TK."},
    {"thermo_optic_valid_c", Numbers{2, {}}, kNone,
     "Lowest and highest temperature for which the thermo-optic coefficients are valid, if known.", kWithThermoOptic},
    {"thermo_optic_source", Text{}, kRequired, "Source of the thermo-optic coefficients.", kWithThermoOptic},
    {"absorption_per_mm", Number{kAtLeastZero}, 0.0,
     "Napierian absorption coefficient, for power. A list of two or more `[wavelength_nm, absorption_per_mm]`, "
     "ascending and with linear interpolation, gives it as a function of wavelength."},
    {"absorption_per_mm", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, absorption_per_mm]", 2}, kNone,
     "Absorption coefficient as a function of wavelength."},
    {"source", Text{}, kRequired, "Source of the values."}};
constexpr Row kMetalRows[] = {
    {"name", Text{}, kRequired, "Name of the metal in designs."},
    {"description", Text{}, kRequired, "Description of the metal."},
    {"plasma_ev", Terms{1}, kRequired, "Photon energy at the plasma frequency, in eV."},
    {"terms", Terms{3}, kRequired, "Strength, damping in eV and resonance in eV of each Lorentz-Drude term."},
    {"valid_nm", Numbers{2, {}}, kRequired, "First and last wavelength for which the model is valid."},
    {"source", Text{}, kRequired, "Source of the values."}};
constexpr Table kTables[] = {
    {.name = "material", .meaning = "A material.", .rows = kMaterialRows, .presence = Presence::list},
    {.name = "metal", .meaning = "A metal.", .rows = kMetalRows, .presence = Presence::list}};
constexpr Format kFormat = {"materials",
                            "retrace.materials/1",
                            "Materials and metals",
                            {.name = "", .meaning = "Materials and metals.", .tables = kTables},
                            true};

template <class Model>
Model pairs(const std::vector<double>& values) {
  Model model;
  for (std::size_t i = 0; i < values.size(); i += 2) model.terms.push_back({values[i], values[i + 1]});
  return model;
}

Dispersion dispersion_of(const std::string& formula, const std::vector<double>& values) {
  if (formula == "constant") return ConstantIndex{values.front()};
  if (formula == "sellmeier") return pairs<Sellmeier>(values);
  if (formula == "gas") return pairs<GasRefractivity>(values);
  PowerSeries series;
  for (std::size_t i = 0; i < values.size(); i += 2)
    series.terms.push_back({values[i], static_cast<int>(values[i + 1])});
  return series;
}

/// Reads the keys that materials and metals have in common.
template <class Item>
Item described(const Document& file, const std::string& entry) {
  Item item;
  item.name = file.text(entry + ".name");
  item.description = file.text(entry + ".description");
  item.source = file.text(entry + ".source");
  item.valid_from_nm = file.numbers(entry + ".valid_nm")[0];
  item.valid_to_nm = file.numbers(entry + ".valid_nm")[1];
  return item;
}

ThermoOptic thermo_optic_of(const Document& file, const std::string& entry) {
  const std::vector<double> c = file.numbers(entry + ".thermo_optic");
  ThermoOptic t{.d0_per_k = c[0],
                .d1_per_k2 = c[1],
                .d2_per_k3 = c[2],
                .e0_um2_per_k = c[3],
                .e1_um2_per_k2 = c[4],
                .resonance_um = c[5],
                .source = file.text(entry + ".thermo_optic_source")};
  if (const std::string key = entry + ".thermo_optic_valid_c"; file.has(key)) {
    t.valid_from_c = file.numbers(key)[0];
    t.valid_to_c = file.numbers(key)[1];
  }
  return t;
}

std::variant<double, SpectralCurve> absorption_of(const Document& file, const std::string& key) {
  if (!file.is_list(key)) return file.number(key);
  SpectralCurve curve;
  for (const std::vector<double>& pair : file.rows(key)) {
    if (!curve.wavelengths_nm.empty() && !(pair[0] > curve.wavelengths_nm.back()))
      file.fail(key, fmt::format("the wavelengths must be in ascending order, got {} nm after {} nm", shortest(pair[0]),
                                 shortest(curve.wavelengths_nm.back())));
    curve.wavelengths_nm.push_back(pair[0]);
    curve.values.push_back(pair[1]);
  }
  if (curve.values.size() < 2)
    file.fail(key, "must be a number or a list of two or more pairs, got a list of one pair");
  return curve;
}

Material material_of(const Document& file, const std::string& entry) {
  Material m = described<Material>(file, entry);
  m.dispersion = dispersion_of(file.text(entry + ".formula"), file.numbers(entry + ".coefficients"));
  m.relative_to_vacuum = file.flag(entry + ".relative_to_vacuum");
  m.temperature_c = file.number(entry + ".temperature_c");
  if (file.has(entry + ".thermo_optic")) m.thermo_optic = thermo_optic_of(file, entry);
  m.absorption_per_mm = absorption_of(file, entry + ".absorption_per_mm");
  return m;
}

Metal metal_of(const Document& file, const std::string& entry) {
  Metal m = described<Metal>(file, entry);
  m.model.plasma_ev = file.numbers(entry + ".plasma_ev").front();
  const std::vector<double> values = file.numbers(entry + ".terms");
  for (std::size_t i = 0; i < values.size(); i += 3) m.model.terms.push_back({values[i], values[i + 1], values[i + 2]});
  return m;
}

/// Returns the item with this name, or null if there is none. In that case the names of all items are appended to
/// `names`.
template <class Item>
const Item* search(const std::vector<Item>& items, std::string_view name, std::vector<std::string>& names) {
  for (const Item& item : items) {
    if (item.name == name) return &item;
    names.push_back(item.name);
  }
  return nullptr;
}

[[noreturn]] void fail(std::string_view kind, std::string_view name, const std::vector<std::string>& names,
                       const InputLocation& where) {
  throw InputError(where, fmt::format("unknown {} \"{}\" (allowed: {})", kind, name, fmt::join(names, ", ")));
}

/// Returns the item with this name.
/// \throw InputError at `where` if there is no such item
template <class Item>
const Item& find_by_name(const std::vector<Item>& items, std::string_view kind, std::string_view name,
                         const InputLocation& where) {
  std::vector<std::string> names;
  if (const Item* const item = search(items, name, names)) return *item;
  fail(kind, name, names, where);
}

}  // namespace

const schema::Format& materials_format() {
  return kFormat;
}

MaterialLibrary MaterialLibrary::read(const std::filesystem::path& file) {
  const Document document = read_document(kFormat, read_file(file), file.string());
  if (!document.has("material")) document.fail("material", "the file must contain [[material]] tables");
  MaterialLibrary library;
  for (std::size_t i = 0; i < document.count("material"); ++i)
    library.materials_.push_back(material_of(document, path_of_entry("material", i)));
  for (std::size_t i = 0; i < document.count("metal"); ++i)
    library.metals_.push_back(metal_of(document, path_of_entry("metal", i)));
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

std::variant<const Material*, const Metal*> MaterialLibrary::find_any(std::string_view name,
                                                                      const InputLocation& where) const {
  std::vector<std::string> names;
  if (const Material* const material = search(materials_, name, names)) return material;
  if (const Metal* const metal = search(metals_, name, names)) return metal;
  fail("material or metal", name, names, where);
}

}  // namespace retrace::materials
