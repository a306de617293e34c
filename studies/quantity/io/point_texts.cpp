#include "studies/quantity/io/point_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/schema/reader.h"
#include "design/io/design_format.h"
#include "studies/quantity/io/study_format.h"

namespace retrace::studies {
namespace {

constexpr std::array<std::string_view, 2> kSettingTables = {"analysis", "machining"};

/// Returns points of the study such that each text value of a parameter occurs at least one time. Designs and the files
/// that they name may depend on these texts.
std::vector<PointValues> points_of_texts(const Study& study) {
  std::vector<PointValues> points = {example_values(study)};
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    for (const ParameterValue& value : study.parameters[k].values)
      if (std::holds_alternative<std::string>(value.shown)) {
        points.push_back(points.front());
        points.back()[k] = value;
      }
  return points;
}

/// Returns the position, for messages, at which a file is named. This is the position of the parameter that sets the
/// file's key, or otherwise the position of the key in the design.
InputLocation where_named(const Study& study, const design::NamedFile& named) {
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    if (std::ranges::count(study.parameters[k].keys, named.key) > 0)
      return study.document->where(schema::path_of_entry("parameter", k) + ".values");
  return named.where;
}

}  // namespace

bool is_setting(std::string_view key) {
  return std::any_of(kSettingTables.begin(), kSettingTables.end(), [&](std::string_view table) {
    return key.starts_with(table) && key.substr(table.size()).starts_with('.');
  });
}

std::string key_of(const std::string& override_text) {
  std::string key = override_text.substr(0, override_text.find('='));
  std::erase_if(key, [](char c) { return c == ' ' || c == '\t'; });
  return key;
}

std::string current_key(std::string_view key) {
  return current_path(key, schema::former_names(is_setting(key) ? study_format() : design::design_format()));
}

std::vector<std::string> overrides_for(std::span<const std::string> overrides, bool study) {
  std::vector<std::string> chosen;
  for (const std::string& text : overrides)
    if (is_setting(key_of(text)) == study) chosen.push_back(text);
  return chosen;
}

PointTexts texts_at(const Study& study, std::span<const ParameterValue> values) {
  PointTexts texts{study.design_file, overrides_for(study.overrides, false), {}};
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    for (const std::string& key : study.parameters[k].keys) {
      if (key == "design")
        texts.design = values[k].toml;
      else
        (is_setting(key) ? texts.for_study : texts.for_design).push_back(fmt::format("{}={}", key, values[k].toml));
    }
  return texts;
}

std::vector<design::NamedFile> files_of_designs(const Study& study) {
  std::vector<design::NamedFile> files;
  std::set<std::filesystem::path> known;
  for (const PointValues& values : points_of_texts(study)) {
    const PointTexts texts = texts_at(study, values);
    for (design::NamedFile& named :
         design::files_named(study.design_texts.at(texts.design), texts.design, texts.for_design))
      if (known.insert(named.file).second) {
        named.where = where_named(study, named);
        files.push_back(std::move(named));
      }
  }
  return files;
}

}  // namespace retrace::studies
