// Tests of former names of tables, keys and words: a text with former names is read like the text with the current
// names, and each former name causes one warning.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/schema/conditions.h"
#include "core/schema/json.h"
#include "core/schema/json_schema.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "tests/support/refusals.h"

namespace retrace::former_names_test {
namespace {

using namespace schema;

constexpr Words kFinishes = {"polished", "matt"};
constexpr Words kSenses = {"max", "min"};
constexpr FormerWord kFormerFinishes[] = {{"bright", "polished"}};
constexpr FormerWord kFormerSenses[] = {{"most", "max"}, {"least", "min"}};
constexpr Row kFaceRows[] = {
    renamed("surface", {"finish", Word{.words = kFinishes, .former = kFormerFinishes}, "matt", "Its finish."}),
    renamed("big_mm", {"width_mm", Number{}, kNone, "Its width."}),
    renamed("big_mm", {"width_mm", Text{}, kNone, "The name of its width."})};
constexpr Row kGoalRows[] = {
    {"goals", ByName{.each = Word{.words = kSenses, .former = kFormerSenses}}, kNone, "Goals."}};
constexpr Words kNames = {"length_mm", "size"};
constexpr Rule kRules[] = {OneOf{kNames, "must have length_mm or size"}};
constexpr Row kRows[] = {renamed("long_mm", {"length_mm", Number{}, kNone, "Its length."}),
                         {"size", Text{}, kNone, "Its size."}};
constexpr Table kTables[] = {
    {.name = "face", .meaning = "A face.", .rows = kFaceRows, .presence = Presence::list, .former = "front"},
    {.name = "study", .meaning = "A study.", .rows = kGoalRows, .presence = Presence::optional, .former = "search"}};
constexpr Format kThing = {"thing", "retrace.thing/1", "Thing", {"", "A thing.", kRows, kTables, kRules}, true};

constexpr const char* kCurrent =
    "length_mm = 2.0\n[[face]]\nfinish = 'polished'\n[[face]]\nwidth_mm = 3.0\n[study]\ngoals = {rre = 'max', cost = "
    "'min'}\n";
constexpr const char* kFormer =
    "long_mm = 2.0\n[[front]]\nsurface = 'bright'\n[[front]]\nbig_mm = 3.0\n[search]\ngoals = {rre = 'most', cost = "
    "'least'}\n";

Document read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_document(kThing, text, "f.toml", kMaxTextBytes, overrides);
}

std::vector<std::string> facts(const Document& document) {
  std::vector<std::string> facts;
  for (const Warning& warning : renamed_keys(document)) facts.push_back(facts_of(warning));
  std::ranges::sort(facts);
  return facts;
}

TEST(FormerNames, AreReadLikeTheCurrentNames) {
  EXPECT_EQ(to_json(read(kFormer)), to_json(read(kCurrent)));
  EXPECT_EQ(facts(read(kCurrent)), std::vector<std::string>{});
}

TEST(FormerNames, CauseOneWarningEachWithTheirLine) {
  EXPECT_EQ(facts(read(kFormer)),
            (std::vector<std::string>{
                "renamed_key at f.toml:1: long_mm", "renamed_key at f.toml:2: front",
                "renamed_key at f.toml:3: face[1].finish", "renamed_key at f.toml:3: face[1].surface",
                "renamed_key at f.toml:5: face[2].big_mm", "renamed_key at f.toml:6: search",
                "renamed_key at f.toml:7: study.goals.cost", "renamed_key at f.toml:7: study.goals.rre"}));
}

TEST(FormerNames, AreReplacedInOverrides) {
  // The override takes precedence, whether the file and the override use the former or the current name.
  for (const std::string& text : {std::string(kCurrent), std::string(kFormer)})
    for (const char* const name : {"length_mm", "long_mm"}) {
      const Document document = read(text, {std::string(name) + "=7"});
      EXPECT_EQ(document.number("length_mm"), 7.0) << name << "\n" << text;
      EXPECT_EQ(document.source_of("length_mm"), 1U) << name << "\n" << text;
      EXPECT_FALSE(read(text, {std::string(name) + "=", "size=large"}).has("length_mm")) << name << "\n" << text;
    }
  EXPECT_EQ(read(kCurrent, {"search.goals.rre=least"}).named("study.goals"),
            read(kCurrent, {"study.goals.rre=min"}).named("study.goals"));
}

TEST(FormerNames, AreRefusedTogetherWithTheCurrentName) {
  EXPECT_EQ(refusal_of([] { read("length_mm = 1.0\nlong_mm = 2.0\n"); }), "f.toml:2: long_mm");
  EXPECT_EQ(refusal_of([] { read("size = 'x'\n[[front]]\nwidth_mm = 2.0\nbig_mm = 1.0\n"); }),
            "f.toml:4: face[1].big_mm");
}

TEST(FormerNames, KeepLinesInMessages) {
  EXPECT_EQ(refusal_of([] { read("size = 'x'\n[[front]]\n\nsurface = 'blue'\n"); }), "f.toml:4: face[1].finish");
  EXPECT_EQ(refusal_of([] { read("size = 'x'\n[[front]]\ncolour = 'blue'\n"); }), "f.toml:3: face[1].colour");
}

TEST(FormerNames, ArePathsOfTheCurrentNames) {
  const std::vector<TomlRename> names = former_names(kThing);
  const std::vector<std::pair<std::string, std::string>> paths = {
      {"front.surface", "face.finish"}, {"face.surface", "face.finish"}, {"front", "face"},
      {"long_mm", "length_mm"},         {"surface", "surface"},          {"frontal.surface", "frontal.surface"}};
  for (const auto& [written, current] : paths) EXPECT_EQ(current_path(written, names), current) << written;
}

TEST(FormerNames, WordsAreKeptAsTheyWereWritten) {
  EXPECT_EQ(read(kFormer).text_as_written("face[0].finish"), "bright");
  EXPECT_EQ(read(kFormer).text("face[0].finish"), "polished");
  EXPECT_EQ(read(kCurrent).text_as_written("face[0].finish"), "polished");
}

TEST(FormerNames, AreDeprecatedInTheJsonSchema) {
  const nlohmann::ordered_json schema = json_schema(kThing);
  const auto& properties = schema["properties"];
  EXPECT_EQ(properties["front"]["deprecated"], true);
  EXPECT_EQ(properties["long_mm"]["deprecated"], true);
  EXPECT_FALSE(properties["face"].contains("deprecated"));
  const auto& face = properties["face"]["items"]["properties"];
  EXPECT_EQ(face["surface"]["deprecated"], true);
  EXPECT_EQ(face["finish"]["enum"], nlohmann::ordered_json::parse(R"(["polished", "matt", "bright"])"));
  EXPECT_EQ(schema["oneOf"][0],
            nlohmann::ordered_json::parse(R"({"anyOf": [{"required": ["length_mm"]}, {"required": ["long_mm"]}]})"));
}

}  // namespace
}  // namespace retrace::former_names_test
