#include "materials/io/index_record.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/length_units.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"
#include "materials/io/absorption_data.h"

namespace retrace::materials {
namespace {

constexpr std::size_t kMaxRecordBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxFormulaCoefficients = 64;
/// Largest magnitude of a negative k that is attributed to measurement noise.
constexpr double kNoiseOfExtinction = 1e-6;
constexpr double kZeroCelsiusK = 273.15;
/// Maximum difference of temperatures that are treated as equal. Records round 20 degrees C (293.15 K) to 293 K.
constexpr double kSameTemperatureK = 0.2;

/// Allowed numbers of coefficients for the formulas 1 to 9, as text for messages.
constexpr std::string_view kPairs = "an odd number of coefficients";
constexpr std::array<std::string_view, 9> kTerms = {kPairs,
                                                    kPairs,
                                                    kPairs,
                                                    "1, 5, 9 or a greater odd number of coefficients",
                                                    kPairs,
                                                    kPairs,
                                                    "1 to 6 coefficients",
                                                    "1, 3 or 4 coefficients",
                                                    "1, 3 or 6 coefficients"};

/// Returns true if no term of the formula lacks a coefficient.
bool has_whole_terms(const RecordFormula& formula) {
  const std::size_t count = formula.c.size();
  switch (formula.number) {
    case 4: return count == 1 || count == 5 || (count >= 9 && count % 2 == 1);
    case 7: return count <= 6;
    case 8: return count == 1 || count == 3 || count == 4;
    case 9: return count == 1 || count == 3 || count == 6;
    default: return count % 2 == 1;
  }
}

class Record {
 public:
  explicit Record(std::string file) : file_(std::move(file)) {}

  Material read(std::string_view text) {
    const YAML::Node root = parsed(text);
    if (!root.IsMap() || !root["DATA"] || !root["DATA"].IsSequence() || root["DATA"].size() == 0)
      throw InputError({file_, 0, "DATA"}, "must be a list of the dispersion formulas and tables of the record");
    Material material;
    material.name = printable(std::filesystem::path(file_).stem().string());
    material.source = file_;
    for (const YAML::Node& entry : root["DATA"]) add(entry, material);
    if (!has_index_)
      throw InputError({file_, line(root["DATA"]), "DATA"},
                       "must contain a dispersion formula or a table of the refractive index n, but contains neither");
    add_conditions(root, material);
    add_thermo_optic(root["PROPERTIES"], material);
    check_nd(root, material);
    return material;
  }

 private:
  YAML::Node parsed(std::string_view text) const {
    try {
      return YAML::Load(std::string(text));
    } catch (const YAML::Exception& error) {
      throw InputError({file_, error.mark.is_null() ? 0 : error.mark.line + 1, ""},
                       "the file is not valid YAML: " + printable(error.msg));
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
      set_table(index_table(entry, 2), material);
    } else if (type == "tabulated nk") {
      begin_index(entry, type);
      set_table(index_table(entry, 3), material);
      add_extinction(entry, 3, material);
    } else if (type == "tabulated k") {
      add_extinction(entry, 2, material);
    } else {
      fail(entry["type"], "type",
           fmt::format("must be formula 1 to formula 9, tabulated n, tabulated k or tabulated nk, got {}",
                       in_quotes(type)));
    }
  }

  void begin_index(const YAML::Node& entry, const std::string& type) {
    if (has_index_)
      fail(entry["type"], "type", fmt::format("must give the index only once, got a second entry {}", in_quotes(type)));
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
           fmt::format("must be two wavelengths in um, above 0 in ascending order, got {} and {}",
                       shortest(range_um[0]), shortest(range_um[1])));
    material.valid_from_nm = 1e3 * range_um[0];
    material.valid_to_nm = 1e3 * range_um[1];
    RecordFormula formula{static_cast<int>(*number), numbers_in(entry, "coefficients", 1, kMaxFormulaCoefficients)};
    if (!has_whole_terms(formula))
      fail(entry["coefficients"], "coefficients",
           fmt::format("must have {} for {}, got {}", kTerms[static_cast<std::size_t>(formula.number - 1)], type,
                       formula.c.size()));
    material.dispersion = std::move(formula);
  }

  /// Row of a table as words, which are converted to numbers later. The first word is the wavelength in um.
  struct Row {
    int line = 0;
    std::vector<std::string> words;
  };

  /// Returns the rows of `data`. A line contains one or more rows of `columns` words. If the number of words in a line
  /// is not a multiple of `columns`, the whole line is returned as one row.
  std::vector<Row> rows_of(const YAML::Node& entry, std::size_t columns) const {
    const std::string text = text_of(entry, "data");
    const std::vector<std::string_view> lines = split(text, '\n');
    // In YAML, the text of a block begins in the line after the indicator `|`. Other forms of text have only one line.
    int at = line(entry["data"]) + (lines.size() > 1 ? 1 : 0);
    std::vector<Row> rows;
    for (const std::string_view one : lines) {
      const std::vector<std::string_view> words = words_in(one);
      const std::size_t in_row = words.size() % columns == 0 ? columns : words.size();
      for (std::size_t k = 0; k < words.size(); ++k) {
        if (k % in_row == 0) rows.push_back({at, {}});
        rows.back().words.emplace_back(words[k]);
      }
      ++at;
    }
    if (rows.empty()) fail(entry["data"], "data", "must have at least one row, got none");
    return rows;
  }

  [[noreturn]] void fail(const Row& row, std::string_view text) const {
    throw InputError({file_, row.line, "data"}, text);
  }

  double number_in_row(const Row& row, std::size_t column) const {
    const std::optional<double> value = number_in(row.words[column]);
    if (!value) fail(row, "must be finite numbers, got " + in_quotes(row.words[column]));
    return *value;
  }

  /// Returns the wavelength of a row in um.
  /// \throw InputError if the first word is not a positive number, or if the row does not have `columns` words
  double wavelength_um_of(const Row& row, std::size_t columns) const {
    if (row.words.size() != columns)
      fail(row, fmt::format("must have {} numbers in each line, got {}", columns, row.words.size()));
    const double um = number_in_row(row, 0);
    if (!(um > 0.0)) fail(row, fmt::format("wavelengths must be > 0, got {} um", shortest(um)));
    return um;
  }

  /// Returns the table of n. Repeated equal rows count as one row.
  SpectralCurve index_table(const YAML::Node& entry, std::size_t columns) const {
    std::map<double, double> n_at_um;
    for (const Row& row : rows_of(entry, columns)) {
      const double um = wavelength_um_of(row, columns);
      const double n = number_in_row(row, 1);
      if (!(n >= 0.0)) fail(row, fmt::format("n must be >= 0, got {}", shortest(n)));
      if (const auto [at, is_new] = n_at_um.emplace(um, n); !is_new && at->second != n)
        fail(row, fmt::format("must have one value of n for each wavelength, got {} and {} at {} um",
                              shortest(at->second), shortest(n), shortest(um)));
    }
    SpectralCurve curve;
    for (const auto& [um, n] : n_at_um) {
      curve.wavelengths_nm.push_back(1e3 * um);
      curve.values.push_back(n);
    }
    return curve;
  }

  static void set_table(SpectralCurve table, Material& material) {
    material.valid_from_nm = table.wavelengths_nm.front();
    material.valid_to_nm = table.wavelengths_nm.back();
    material.dispersion = TabulatedIndex{std::move(table)};
  }

  /// Adds the absorption computed from k, which is the last column of a table. Errors in this column cause warnings
  /// only, because the refractive index does not depend on k.
  void add_extinction(const YAML::Node& entry, std::size_t columns, Material& material) {
    AbsorptionData data(file_, "data");
    try {
      if (std::exchange(has_extinction_, true))
        fail(entry["type"], "type", "the record may contain only one table of k, got a second table");
      for (const Row& row : rows_of(entry, columns)) add_extinction(row, columns, data);
    } catch (const InputError& error) {
      material.warnings.push_back(
          {"absorption_table_ignored", InputError(error.where(), error.text() + "; this table is ignored").what()});
      return;
    }
    data.finish(material);
  }

  void add_extinction(const Row& row, std::size_t columns, AbsorptionData& data) const {
    try {
      const double wavelength_nm = 1e3 * wavelength_um_of(row, columns);
      const double k = number_in_row(row, columns - 1);
      if (k >= 0.0)
        data.add(row.line, wavelength_nm, 4.0 * std::numbers::pi * kNmPerMm * k / wavelength_nm);
      else if (k >= -kNoiseOfExtinction)
        data.add_zero(row.line, wavelength_nm, fmt::format("k must be >= 0, got {}", shortest(k)));
      else
        data.omit(row.line, fmt::format("k must be >= 0, got {}", shortest(k)));
    } catch (const InputError& error) {
      data.omit(row.line, error.text());
    }
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
      material.thermo_optic = thermo_optic_of(numbers_in(entry, "coefficients", 6, 6), file_);
    }
  }

  /// Adds a warning if n_d of the record differs from the index of its data.
  void check_nd(const YAML::Node& root, Material& material) const {
    for (const char* const table : {"PROPERTIES", "SPECS"}) {
      const YAML::Node properties = root[table];
      if (!properties || !properties.IsMap() || !properties["nd"] || !properties["nd"].IsScalar()) continue;
      const std::optional<double> stated = number_in(trimmed(properties["nd"].Scalar()));
      const std::string doubt = stated ? nd_contradiction(material, *stated) : std::string();
      if (!doubt.empty())
        material.warnings.push_back(
            {"index_disagrees", InputError({file_, line(properties["nd"]), "nd"}, doubt).what()});
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
  } catch (const YAML::Exception& error) {  // thrown if a node has an unexpected type
    throw InputError({file, error.mark.is_null() ? 0 : error.mark.line + 1, ""}, printable(error.msg));
  }
}

Material read_index_record(const std::filesystem::path& file) {
  return parse_index_record(read_file(file, kMaxRecordBytes), file.string());
}

}  // namespace retrace::materials
