// The file formats accept exactly the former names of tests/data/renames.json, and docs/former_names.md lists them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/schema/reader.h"
#include "design/io/design_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/turning/io/part_files.h"
#include "studies/quantity/io/study_format.h"

namespace retrace::studies::former_keys_test {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const std::string& name) {
  std::ifstream file(std::string(RETRACE_SOURCE_DIR) + "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
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
