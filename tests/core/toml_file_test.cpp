#include "core/toml_file.h"
#include "tests/support/refusals.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

// Tests of tables of TOML files: the returned values, and refused values with file, line and key.

namespace retrace::toml_file_test {
namespace {

std::string refusal(const std::string& text, const std::function<void(TomlTable&)>& read) {
  return refusal_of([&] {
    TomlTable root = parse_toml(text, "f.toml");
    read(root);
    root.finish();
  });
}

TEST(TomlFile, HandsOutWhatIsThere) {
  TomlTable root = parse_toml(
      "n = 3\nr = 1.5\nt = 'a'\nb = true\nl = [1, 2]\ns = ['x', 'y']\n[in.ner]\nk = 'two'\n"
      "[[row]]\nv = 1\n[[row]]\nv = 2\n",
      "f.toml");
  EXPECT_EQ(root.integer("n", {}), 3);
  EXPECT_EQ(root.number("r"), 1.5);
  EXPECT_EQ(root.text("t"), "a");
  EXPECT_EQ(root.flag("b"), true);
  EXPECT_EQ(root.numbers("l", 2), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(root.texts("s"), (std::vector<std::string>{"x", "y"}));
  const std::string_view words[] = {"one", "two"};
  EXPECT_EQ(root.table("in").table("ner").choice("k", words), 1U);
  std::vector<TomlTable> rows = root.tables("row");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].number("v"), 1.0);
  EXPECT_EQ(rows[1].number("v"), 2.0);
  EXPECT_EQ(root.number("none"), std::nullopt);
  EXPECT_TRUE(root.table("nothing").names().empty());
  EXPECT_NO_THROW(root.finish());
}

TEST(TomlFile, RefusesWithFileLineAndKey) {
  const auto number = [](TomlTable& t) { t.required_number("a", {.low = 0.0, .low_included = false}); };
  EXPECT_EQ(refusal("\na = -1\n", number), "f.toml:2: a");
  EXPECT_EQ(refusal("a = 'x'\n", number), "f.toml:1: a");
  EXPECT_EQ(refusal("a = inf\n", number), "f.toml:1: a");
  EXPECT_EQ(refusal("", number), "f.toml: a");
  EXPECT_EQ(refusal("a = 1\nab = 2\n", number), "f.toml:2: ab");
  EXPECT_EQ(refusal("a = = 1\n", number), "f.toml:1");
  EXPECT_EQ(refusal("[t]\n\nk = 2.5\n", [](TomlTable& t) { t.table("t").integer("k", {}); }), "f.toml:3: t.k");
  EXPECT_EQ(refusal("t = 1\n", [](TomlTable& t) { t.table("t"); }), "f.toml:1: t");
  EXPECT_EQ(refusal("l = [1]\n", [](TomlTable& t) { t.numbers("l", 3); }), "f.toml:1: l");
  EXPECT_EQ(refusal("[t]\nx = 1\n", [](TomlTable& t) { t.table("t"); }).substr(0, 24), "f.toml:2: t.x");
}

TEST(TomlFile, RefusesWhatWouldNestTooDeeply) {
  std::string text = "a";
  for (int k = 0; k < 100000; ++k) text += ".a";
  EXPECT_EQ(refusal(text + " = 1\n", [](TomlTable&) {}), "f.toml:1");
  std::string numbers = "a = [0.5";
  for (int k = 0; k < 1000; ++k) numbers += k % 2 == 0 ? ", -1.25" : ",3.5e-2";
  EXPECT_EQ(refusal(numbers + "]\n", [](TomlTable& t) { t.numbers("a", 1001); }), "");
  std::string keys = "1.1";
  for (int k = 0; k < 10000; ++k) keys += ".1.1";
  EXPECT_EQ(refusal(keys + " = 1\n", [](TomlTable&) {}), "f.toml:1");
}

TEST(TomlFile, TextsAreEscaped) {
  const std::string text = "quote \" backslash \\ tab \t line \n end";
  TomlTable root = parse_toml("t = " + toml_text(text) + "\n", "f.toml");
  EXPECT_EQ(root.text("t"), text);
}

}  // namespace
}  // namespace retrace::toml_file_test
