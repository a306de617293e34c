// The file formats accept exactly the former names of tests/data/renames.json, and docs/former_names.md lists them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/atomic_file.h"
#include "core/schema/json.h"
#include "core/schema/reader.h"
#include "design/io/design_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/turning/io/part_files.h"
#include "studies/quantity/io/study_format.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::studies::former_keys_test {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const std::string& name) {
  return read_file(std::string(RETRACE_SOURCE_DIR) + "/" + name);
}

const Json& table() {
  static const Json table = Json::parse(text_of("tests/data/renames.json"));
  return table;
}

std::map<std::string, const schema::Format*> formats() {
  return {{"design", &design::design_format()},
          {"study", &study_format()},
          {"job", &fabrication::job_format()},
          {"process", &fabrication::process_format()},
          {"machine", &fabrication::machine_format()},
          {"planed_part", &fabrication::planed_part_format()},
          {"turned_part", &fabrication::turning::turned_part_format()}};
}

std::string without_indices(std::string path) {
  for (std::size_t at = 0; (at = path.find("[]")) != std::string::npos;) path.erase(at, 2);
  return path;
}

TEST(FormerKeys, AreThoseOfTheTable) {
  for (const auto& [name, format] : formats()) {
    const std::vector<TomlRename> renames = schema::former_names(*format);
    std::size_t keys = 0, words = 0;
    for (const Json& entry : table()) {
      if (entry["format"] != name) continue;
      const std::string former = without_indices(entry["former"]), current = without_indices(entry["current"]);
      if (entry["kind"] == "key" || entry["kind"] == "table") {
        ++keys;
        EXPECT_EQ(current_path(former, renames), current) << name;
        EXPECT_EQ(current_path(current, renames), current) << name;
      }
      if (entry["kind"] != "word") continue;
      ++words;
      const auto is_it = [&](const TomlRename& rename) {
        return rename.is_word && former.ends_with("=" + rename.former) && current.ends_with("=" + rename.current) &&
               former.starts_with(rename.table + "." + (rename.key.empty() ? "*" : rename.key) + "=");
      };
      EXPECT_TRUE(std::ranges::any_of(renames, is_it)) << name << " " << former;
    }
    const auto is_word = [](const TomlRename& rename) { return rename.is_word; };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(renames, is_word));
    EXPECT_EQ(count, words) << name;
    EXPECT_EQ(renames.size() - count, keys) << name;
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A run resumes from a store only if its `parts`, which are the names and texts that define the study, equal those in
/// the store. They must not depend on whether the study, the design and the overrides use former or current names.
TEST(FormerKeys, StoresCanBeContinuedAfterFilesAreRenamed) {
  const std::string study =
      "design = \"d.toml\"\n[[parameter]]\nkey = \"element.base_mm\"\nvalues = [0.4, 0.5]\n[[quantity]]\nkind = "
      "\"rre\"\n"
      "incidence_deg = [0, 10]\nover_directions = \"min\"\n[tolerance]\nmin_yield_percent = 90\n";
  const std::string former_study =
      replaced(replaced(study, "\"min\"", "\"least\""), "min_yield_percent", "least_yield_percent");
  const std::string design = text_of("examples/curved_base.toml");
  const std::string former_design = replaced(replaced(design, "[substrate]", "[base]"), "element_axes", "elements");
  const std::vector<std::string> overrides = {"substrate.element_axes=parallel", "body.thickness_mm = 3"};
  const std::vector<std::string> former_overrides = {"base.elements=parallel", "body.thickness_mm = 3"};
  const auto parts = [](const std::string& text, const std::string& of_design, const std::vector<std::string>& given) {
    return parse_study(text, "s.toml", given, 1, {{"d.toml", of_design}}).parts;
  };
  const auto expected = parts(former_study, former_design, former_overrides);
  EXPECT_EQ(parts(study, design, overrides), expected);
  EXPECT_EQ(parts(study, former_design, overrides), expected);
  EXPECT_EQ(parts(former_study, design, former_overrides), expected);
  EXPECT_NE(parts(replaced(study, "90", "91"), design, overrides), expected);
}

/// Each example is rewritten with former names. It must then be read with the same values as the original example.
TEST(FormerKeys, ExamplesWithFormerNamesHaveTheSameValues) {
  std::map<std::string, const schema::Format*> by_id;
  for (const auto& [name, format] : formats()) by_id[std::string(format->id)] = format;
  std::size_t renamed = 0;
  const std::string folder = std::string(RETRACE_SOURCE_DIR) + "/examples";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = read_file(entry.path());
    const Json values = Json::parse(parse_toml(text, entry.path().string()).as_json());
    const auto found = by_id.find(values.value("schema", ""));
    if (found == by_id.end()) continue;
    const schema::Format& format = *found->second;
    const std::string former_text = schema::toml_of_json(
        format, Json::parse(parse_toml(text, "", kMaxTextBytes, {}, reversed(schema::former_names(format))).as_json()));
    const schema::Document former = schema::read_document(format, former_text, "former.toml");
    EXPECT_EQ(schema::to_json(former), schema::to_json(schema::read_document(format, text, "current.toml")))
        << entry.path();
    if (!former.renamed().empty()) ++renamed;
  }
  EXPECT_GE(renamed, 8U);
}

TEST(FormerKeys, AreListedInTheDocumentation) {
  const std::string text = text_of("docs/former_names.md");
  for (const Json& entry : table()) {
    const auto column = [&](const char* key) { return "`" + entry[key].get<std::string>() + "`"; };
    EXPECT_NE(text.find("| " + column("former") + " | " + column("current") + " |"), std::string::npos) << entry;
  }
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = text.find("` | `", at)) != std::string::npos; ++at) ++rows;
  EXPECT_EQ(rows, table().size());
}

}  // namespace
}  // namespace retrace::studies::former_keys_test
