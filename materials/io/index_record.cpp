#include "materials/io/index_record.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace::materials {
namespace {

constexpr std::size_t kMostRecordBytes = std::size_t{4} << 20;
constexpr std::size_t kMostOfFormula = 64;
constexpr double kZeroCelsiusK = 273.15;
/// Records round the temperature of 20 degrees C to 293 K.
constexpr double kSameTemperatureK = 0.2;

class Record {
 public:
  explicit Record(std::string file) : file_(std::move(file)) {}

  Material read(std::string_view text) {
    const YAML::Node root = parsed(text);
    if (!root.IsMap() || !root["DATA"] || !root["DATA"].IsSequence() || root["DATA"].size() == 0)
      throw InputError({file_, 0, "DATA"}, "must be a list of what the record knows");
    Material material;
    material.name = printable(std::filesystem::path(file_).stem().string());
    material.source = file_;
    for (const YAML::Node& entry : root["DATA"]) add(entry, material);
    if (!has_index_) throw InputError({file_, line(root["DATA"]), "DATA"}, "has neither a formula nor a table of n");
    add_conditions(root, material);
    add_thermo_optic(root["PROPERTIES"], material);
    return material;
  }

 private:
  YAML::Node parsed(std::string_view text) const {
    try {
      return YAML::Load(std::string(text));
    } catch (const YAML::Exception& error) {
      throw InputError({file_, error.mark.is_null() ? 0 : error.mark.line + 1, ""}, "no YAML: " + printable(error.msg));
    }
  }

  static int line(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

  [[noreturn]] void fail(const YAML::Node& at, std::string_view key, std::string_view text) const {
    throw InputError({file_, line(at), std::string(key)}, text);
  }

  std::string text_of(const YAML::Node& map, const char* key) const {
    const YAML::Node node = map[key];
    if (!node) fail(map, key, "is missing");
    if (!node.IsScalar()) fail(node, key, "must be text");
    return node.Scalar();
  }

  std::vector<double> numbers_in(const YAML::Node& map, const char* key, std::size_t least, std::size_t most) const {
    const std::string text = text_of(map, key);
    std::vector<double> values;
    for (const std::string_view word : words_in(text)) {
      const std::optional<double> value = number_in(word);
      if (!value) fail(map[key], key, fmt::format("must be finite numbers, got {}", in_quotes(word)));
      values.push_back(*value);
    }
    if (values.size() < least || values.size() > most)
      fail(map[key], key, fmt::format("must be {} to {} numbers, got {}", least, most, values.size()));
    return values;
  }

  void add(const YAML::Node& entry, Material& material) {
    if (!entry.IsMap()) fail(entry, "DATA", "must be a list of tables");
    const std::string type = text_of(entry, "type");
    if (type.starts_with("formula ")) {
      begin_index(entry, type);
      add_formula(entry, type, material);
    } else if (type == "tabulated n") {
      begin_index(entry, type);
      set_table(curve(entry, 2, 1, 1e3), material);
    } else if (type == "tabulated nk") {
      begin_index(entry, type);
      set_table(curve(entry, 3, 1, 1e3), material);
      set_extinction(entry, curve(entry, 3, 2, 1e3), material);
    } else if (type == "tabulated k") {
      set_extinction(entry, curve(entry, 2, 1, 1e3), material);
    } else {
      fail(entry["type"], "type",
           fmt::format("must be formula 1 to formula 9, tabulated n, tabulated k or tabulated nk, got {}",
                       in_quotes(type)));
    }
  }

  void begin_index(const YAML::Node& entry, const std::string& type) {
    if (has_index_) fail(entry["type"], "type", fmt::format("tells the index a second time, got {}", in_quotes(type)));
    has_index_ = true;
  }

  void add_formula(const YAML::Node& entry, const std::string& type, Material& material) const {
    const std::optional<double> number = number_in(std::string_view(type).substr(8));
    if (!number || !(*number >= 1.0 && *number <= 9.0) || *number != static_cast<int>(*number))
      fail(entry["type"], "type", fmt::format("must be formula 1 to formula 9, got {}", in_quotes(type)));
    const char* const range_key = entry["range"] ? "range" : "wavelength_range";
    const std::vector<double> range_um = numbers_in(entry, range_key, 2, 2);
    if (!(range_um[0] > 0.0 && range_um[1] > range_um[0]))
      fail(entry[range_key], range_key,
           fmt::format("must be wavelengths in um that ascend from above 0, got {} and {}", shortest(range_um[0]),
                       shortest(range_um[1])));
    material.valid_from_nm = 1e3 * range_um[0];
    material.valid_to_nm = 1e3 * range_um[1];
    material.dispersion =
        RecordFormula{static_cast<int>(*number), numbers_in(entry, "coefficients", 1, kMostOfFormula)};
  }

  /// A column of a table over its first, the wavelength in um.
  SpectralCurve curve(const YAML::Node& entry, std::size_t columns, std::size_t column, double nm_per_um) const {
    const std::vector<double> all = numbers_in(entry, "data", columns, kMostRecordBytes);
    if (all.size() % columns != 0)
      fail(entry["data"], "data", fmt::format("must have {} numbers a line, got {} in all", columns, all.size()));
    std::vector<std::array<double, 2>> rows;
    for (std::size_t k = 0; k < all.size(); k += columns) rows.push_back({nm_per_um * all[k], all[k + column]});
    std::ranges::stable_sort(rows, {}, [](const auto& row) { return row[0]; });
    SpectralCurve curve;
    for (const auto& [wavelength_nm, value] : rows) {
      if (!(wavelength_nm > 0.0))
        fail(entry["data"], "data",
             fmt::format("wavelengths must be > 0, got {} um", shortest(wavelength_nm / nm_per_um)));
      if (!curve.wavelengths_nm.empty() && wavelength_nm == curve.wavelengths_nm.back())
        fail(entry["data"], "data",
             fmt::format("must have each wavelength once, got {} um twice", shortest(wavelength_nm / nm_per_um)));
      if (!(value >= 0.0)) fail(entry["data"], "data", fmt::format("n and k must be >= 0, got {}", shortest(value)));
      curve.wavelengths_nm.push_back(wavelength_nm);
      curve.values.push_back(value);
    }
    return curve;
  }

  static void set_table(SpectralCurve table, Material& material) {
    material.valid_from_nm = table.wavelengths_nm.front();
    material.valid_to_nm = table.wavelengths_nm.back();
    material.dispersion = TabulatedIndex{std::move(table)};
  }

  void set_extinction(const YAML::Node& entry, SpectralCurve k, Material& material) {
    if (std::exchange(has_extinction_, true)) fail(entry["type"], "type", "tells k a second time");
    constexpr double kNmPerMm = 1e6;
    for (std::size_t at = 0; at < k.values.size(); ++at)
      k.values[at] *= 4.0 * std::numbers::pi * kNmPerMm / k.wavelengths_nm[at];
    if (k.values.size() == 1)
      material.absorption_per_mm = k.values.front();
    else
      material.absorption_per_mm = std::move(k);
  }

  void add_conditions(const YAML::Node& root, Material& material) const {
    for (const char* const table : {"CONDITIONS", "SPECS"}) {
      const YAML::Node conditions = root[table];
      if (!conditions || !conditions.IsMap()) continue;
      if (conditions["n_is_absolute"]) {
        const std::string word = text_of(conditions, "n_is_absolute");
        if (word != "true" && word != "false")
          fail(conditions["n_is_absolute"], "n_is_absolute",
               fmt::format("must be true or false, got {}", in_quotes(word)));
        material.relative_to_vacuum = word == "true";
      }
      if (!conditions["temperature"]) continue;
      const double temperature_k = numbers_in(conditions, "temperature", 1, 1).front();
      if (!(temperature_k > 0.0))
        fail(conditions["temperature"], "temperature", fmt::format("must be > 0 K, got {}", shortest(temperature_k)));
      const double celsius = temperature_k - kZeroCelsiusK;
      if (std::abs(celsius - material.temperature_c) > kSameTemperatureK) material.temperature_c = celsius;
    }
  }

  void add_thermo_optic(const YAML::Node& properties, Material& material) const {
    if (!properties || !properties.IsMap() || !properties["thermal_dispersion"]) return;
    for (const YAML::Node& entry : properties["thermal_dispersion"]) {
      if (!entry.IsMap() || text_of(entry, "type") != "formula A") continue;
      const std::vector<double> t = numbers_in(entry, "coefficients", 6, 6);
      material.thermo_optic = ThermoOptic{.d0_per_k = t[0],
                                          .d1_per_k2 = t[1],
                                          .d2_per_k3 = t[2],
                                          .e0_um2_per_k = t[3],
                                          .e1_um2_per_k2 = t[4],
                                          .resonance_um = t[5],
                                          .source = file_};
    }
  }

  std::string file_;
  bool has_index_ = false;
  bool has_extinction_ = false;
};

}  // namespace

Material parse_index_record(std::string_view text, const std::string& file) {
  try {
    return Record(file).read(text);
  } catch (const YAML::Exception& error) {  // of nodes that are not what they are taken for
    throw InputError({file, error.mark.is_null() ? 0 : error.mark.line + 1, ""}, printable(error.msg));
  }
}

Material read_index_record(const std::filesystem::path& file) {
  return parse_index_record(read_file(file, kMostRecordBytes), file.string());
}

}  // namespace retrace::materials
