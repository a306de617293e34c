#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "tests/app/program.h"

// Tests of `retrace validate`: all expected values are met, and the page of the documentation contains the numbers that
// the command writes. The JSON document has the structure that docs/commands/validate.md describes.

namespace retrace::test::validate_test {
namespace {

/// Returns the numbers of a text in their order.
std::vector<std::string> numbers_of(const std::string& text) {
  static const std::regex number(R"(-?[0-9]+(\.[0-9]+)?(e-?[0-9]+)?)");
  return {std::sregex_token_iterator(text.begin(), text.end(), number), std::sregex_token_iterator()};
}

TEST(Validate, MeetsEveryFigureAndWritesThePageOfTheDocumentation) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"validate", "-o", "validation.md", "--json", "validation.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  // A slow machine prints a note about a long run.
  for (const std::string& line : lines_of(outcome.err)) EXPECT_TRUE(line.starts_with("note: ")) << line;
  EXPECT_EQ(outcome.out, "wrote validation.md\n");
  EXPECT_EQ(folder.names(), (Arguments{"validation.json", "validation.md"}));
  EXPECT_EQ(numbers_of(folder.read("validation.md")),
            numbers_of(read_text(std::string(RETRACE_SOURCE_DIR) + "/docs/validation.md")))
      << "retrace validate -o docs/validation.md";

  const Json json = folder.json("validation.json");
  EXPECT_EQ(json["schema"], "retrace.validation/1");
  EXPECT_EQ(json["verdict"], "pass");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["warnings"], Json::array());
  EXPECT_EQ(json["figures"], json["rows"].size());
  EXPECT_GE(json["elapsed_s"].get<double>(), 0.0);
  std::set<std::string> references;
  std::set<std::string> names;
  for (const Json& row : json["rows"]) {
    const std::string name = row["topic"].get<std::string>() + ": " + row["quantity"].get<std::string>() +
                             row["reference"].get<std::string>();
    EXPECT_TRUE(names.insert(name).second) << name << " stands twice";
    references.insert(row["reference"]);
    for (const char* key : {"unit", "source", "why"}) EXPECT_TRUE(row[key].is_string()) << name << key;
    EXPECT_NE(row["source"], "") << name;
    EXPECT_NE(row["why"], "") << name;
    const double difference = row["computed"].get<double>() - row["expected"].get<double>();
    EXPECT_EQ(row["difference"], difference) << name;
    EXPECT_EQ(row.contains("allowed"), row.contains("holds")) << name;
    if (!row.contains("allowed")) {
      EXPECT_EQ(row["reference"], "published") << name << ": only of publications a figure may be missed";
      continue;
    }
    EXPECT_EQ(row["holds"], true) << name;
    EXPECT_LE(std::abs(difference), row["allowed"].get<double>()) << name;
  }
  EXPECT_EQ(references, (std::set<std::string>{"closed_form", "independent", "published"}));
}

TEST(Validate, RefusesWhatItDoesNotTake) {
  const TemporaryFolder folder;
  const auto refused = [&](const Arguments& arguments, int code = 2) {
    const Outcome outcome = retrace(folder, arguments);
    return refused_at(outcome, code);
  };
  EXPECT_EQ(refused({"validate", "--set", "element.base_mm=1"}), "--set");
  EXPECT_EQ(refused({"validate", "all"}), "");
  EXPECT_EQ(refused({"validate", "--threads", "0"}), "--threads");
  EXPECT_EQ(refused({"validate", "--json", "nowhere/v.json"}, 3), "nowhere/v.json");
  EXPECT_EQ(refused({"validate", "-o", "v.md", "--json", "v.md"}), "--json");
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace retrace::test::validate_test
