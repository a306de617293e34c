#include "report/page/document_view.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/number_format.h"

namespace retrace::report::document {

const Json& member(const Json& json, const char* key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto it = json.find(key);
  return it == json.end() ? none : *it;
}

double number(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_number() ? value.get<double>() : NAN;
}

double number_or_0(const Json& json, const char* key) {
  const double value = number(json, key);
  return std::isfinite(value) ? value : 0.0;
}

std::size_t count_in(const Json& json, const char* key) {
  return static_cast<std::size_t>(std::clamp(number_or_0(json, key), 0.0, 1e15));
}

std::string text(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

bool flag(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_boolean() && value.get<bool>();
}

const Json& list(const Json& json, const char* key) {
  static const Json empty = Json::array();
  const Json& value = member(json, key);
  return value.is_array() ? value : empty;
}

std::string measured(double value, int digits, const char* unit) {
  return std::isfinite(value) ? fixed(value, digits) + unit : "";
}

std::string measured(double value, const char* unit) {
  return std::isfinite(value) ? six_digits(value) + unit : "";
}

std::string percent(double fraction) {
  return std::isfinite(fraction) ? fixed(100.0 * fraction, 2) + " %" : "";
}

PageCell cell_of(const Json& value) {
  if (value.is_number()) return {value.get<double>()};
  if (value.is_string()) return {value.get<std::string>()};
  if (value.is_boolean()) return {value.get<bool>() ? "yes" : "no"};
  return {value.is_null() ? std::string() : value.dump()};
}

std::string column_name(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> units = {{"_mcd_per_lx", "mcd/lx"},
                                                                         {"_cd_per_lx_m2", "cd/lx/m2"},
                                                                         {"_mm2_per_h", "mm2/h"},
                                                                         {"_arcmin", "arcmin"},
                                                                         {"_deg", "deg"},
                                                                         {"_mm2", "mm2"},
                                                                         {"_mm3", "mm3"},
                                                                         {"_mm", "mm"},
                                                                         {"_um", "um"},
                                                                         {"_nm", "nm"},
                                                                         {"_s", "s"},
                                                                         {"_n", "N"},
                                                                         {"_h", "h"},
                                                                         {"_cm2", "cm2"},
                                                                         {"_percent", "%"}};
  std::string name = key;
  std::string unit;
  for (const auto& [suffix, word] : units)
    if (key.size() > suffix.size() && key.ends_with(suffix)) {
      name.resize(key.size() - suffix.size());
      unit = " (" + word + ")";
      break;
    }
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + unit;
}

namespace {

constexpr const char* kVerdicts[] = {"verdict", "passes", "holds"};  // keys whose values are rated

/// Returns the rows, stably sorted by the worst rating of their values: failed rows first, then undetermined rows.
std::vector<const Json*> failures_first(const Json& rows, const std::vector<std::string>& keys) {
  std::vector<const Json*> sorted;
  for (const Json& row : rows) sorted.push_back(&row);
  for (const char* key : kVerdicts) {
    if (std::ranges::find(keys, key) == keys.end()) continue;
    std::ranges::stable_sort(sorted, {}, [&](const Json* row) {
      const Rating rating = rating_of(key, member(*row, key));
      return rating == Rating::bad ? 0 : rating == Rating::open ? 1 : 2;
    });
  }
  return sorted;
}

}  // namespace

PageTable table_of(const Json& rows, const std::vector<std::string>& keys, const std::string& caption,
                   const std::string& csv_name) {
  PageTable table;
  table.caption = caption;
  table.csv_name = csv_name;
  std::vector<std::string> present;
  for (const std::string& key : keys)
    if (std::any_of(rows.begin(), rows.end(), [&](const Json& row) { return row.is_object() && row.contains(key); }))
      present.push_back(key);
  for (const std::string& key : present) table.columns.push_back(column_name(key));
  for (const Json* row : failures_first(rows, present)) {
    if (table.rows.size() == kMaxRows) {
      table.omitted_rows = rows.size() - kMaxRows;
      break;
    }
    std::vector<PageCell> cells;
    for (const std::string& key : present) {
      const Json& value = member(*row, key.c_str());
      cells.push_back(cell_of(value));
      cells.back().rating = rating_of(key, value);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

PageTable figures_of(const Json& json, const std::string& caption, const std::string& csv_name) {
  static const std::set<std::string> told = {"schema", "version", "complete", "elapsed_s", "seed"};
  PageTable table;
  table.caption = caption;
  table.csv_name = csv_name;
  table.columns = {"figure", "value"};
  for (const auto& [key, value] : json.items()) {
    if (told.contains(key) || value.is_structured()) continue;
    PageCell cell = cell_of(value);
    cell.rating = rating_of(key, value);
    table.rows.push_back({column_name(key), std::move(cell)});
  }
  return table;
}

std::string csv_name(const ResultDocument& document, const char* what) {
  std::string name = document.name.substr(0, document.name.rfind('.'));
  std::replace(name.begin(), name.end(), '/', '_');
  return name + "_" + what + ".csv";
}

Rating rating_of(const std::string& verdict) {
  if (verdict == "pass") return Rating::good;
  return verdict == "fail" ? Rating::bad : Rating::open;
}

Rating rating_of(const std::string& key, const Json& value) {
  if (key == "verdict" && value.is_string()) return rating_of(value.get<std::string>());
  if ((key == "passes" || key == "holds") && value.is_boolean()) return value.get<bool>() ? Rating::good : Rating::bad;
  return Rating::none;
}

std::string name_of_design(const Json& design) {
  if (const std::string title = text(design, "title"); !title.empty()) return title;
  const Json& element = member(design, "element");
  if (!element.is_object()) return text(member(design, "part"), "mesh");
  std::string name = text(element, "kind");
  for (const char* size : {"base_mm", "width_mm", "aperture_mm"})
    if (std::isfinite(number(element, size))) name += " " + six_digits(number(element, size));
  return name + " mm, " + text(member(design, "array"), "arrangement");
}

std::vector<std::string> keys_of(const Json& rows) {
  std::vector<std::string> keys;
  std::size_t looked_at = 0;
  for (const Json& row : rows) {
    if (!row.is_object() || ++looked_at > 20) continue;
    for (const auto& [key, value] : row.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

std::vector<std::string> words(const Json& values) {
  std::vector<std::string> words;
  for (const Json& value : values)
    if (value.is_string()) words.push_back(value.get<std::string>());
  return words;
}

}  // namespace retrace::report::document
