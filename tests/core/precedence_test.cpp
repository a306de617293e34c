// Tests of keys that have no effect because another key takes precedence. A warning names both keys. The tests cover
// every kind of table that a file can contain.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/schema/conditions.h"
#include "core/schema/json_schema.h"
#include "core/schema/reader.h"
#include "tests/support/refusals.h"

namespace retrace::precedence_test {
namespace {

using namespace schema;

constexpr Words kColours = {"red", "any"};
constexpr Words kAny = {"any"};
constexpr Row kPartRows[] = {{"colour", Word{kColours}, "red", "Its colour."},
                             {"dye", Text{}, kNone, "Its dye."},
                             {"length_mm", Number{}, kNone, "Its length."},
                             {"size_mm", Number{}, 1.0, "Its size."}};
constexpr Words kDye = {"dye"};
constexpr Words kSize = {"size_mm"};
constexpr Rule kPartRules[] = {
    Precedence{is("colour", kAny), kDye, "on the colour", "A part of any colour has no dye."},
    Precedence{is_given("length_mm"), kSize, "on the length", "A length takes precedence over the size.", true}};
constexpr Table kTables[] = {
    {.name = "part", .meaning = "A part.", .rows = kPartRows, .rules = kPartRules, .presence = Presence::list}};
constexpr Format kThing = {"thing", "retrace.thing/1", "Thing", {"", "A thing.", {}, kTables}, true};

Warnings warnings(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Document document = read_document(kThing, text, "f.toml", kMaxTextBytes, overrides);
  return superseded_keys(document);
}

TEST(Precedence, WarningsNameBothKeys) {
  EXPECT_EQ(warnings("[[part]]\ndye = 'x'\n"), Warnings{});
  const Warnings of_dye = warnings("[[part]]\n[[part]]\ndye = 'x'\ncolour = 'any'\n");
  ASSERT_EQ(of_dye.size(), 1U);
  EXPECT_EQ(facts_of(of_dye[0]), "superseded_key at f.toml:3: part[2].dye");
  EXPECT_EQ(warnings("[[part]]\nsize_mm = 2\nlength_mm = 3\n"), Warnings{})
      << "a file may give both keys of a refinement";
}

TEST(Precedence, IsSaidWithItsKeys) {
  const std::string json = json_schema(kThing).dump();
  EXPECT_NE(json.find("Its dye. A part of any colour has no dye."), std::string::npos) << json;
}

}  // namespace
}  // namespace retrace::precedence_test
