#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/atomic_file.h"
#include "core/overloaded.h"
#include "core/schema/key_table.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "studies/design/design_format.h"

// Design files by their rows: what is written reads back the same, and the documentation says what the rows say.

namespace retrace::studies::design_format_test {
namespace {

using namespace schema;

/// A number of the range, which reads back from its shortest text.
double number_in(const NumberRange& range, const NumberRange& sane = {}) {
  const double low = std::max({range.low, sane.low, -1e3});
  const double high = std::min({range.high, sane.high, low + 1e3});
  return low + (high - low) * *rc::gen::inRange(1, 1 << 20) / static_cast<double>(1 << 20);
}
std::vector<double> numbers_in(const NumberRange& range, std::size_t least, std::size_t most) {
  std::vector<double> numbers(*rc::gen::inRange(least, most + 1));
  for (double& number : numbers) number = number_in(range);
  return numbers;
}
std::string word_of(std::span<const std::string_view> words) {
  return std::string(words[*rc::gen::inRange<std::size_t>(0, words.size())]);
}
std::string some_text() {
  return *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
}

Value some_value(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) { return Value(number_in(number.range, number.sane)); },
                 [](const Whole& whole) { return Value(std::ceil(number_in(whole.range))); },
                 [](const Flag&) { return Value(*rc::gen::arbitrary<bool>()); },
                 [](const Word& word) { return Value(word_of(word.words)); },
                 [](const Text&) { return Value(some_text()); }, [](const File&) { return Value(some_text()); },
                 [](const WordOrFile& either) {
                   return Value(*rc::gen::arbitrary<bool>() ? word_of(either.words)
                                                            : some_text() + std::string(either.ending));
                 },
                 [](const NumberOrNumbers& list) {
                   return *rc::gen::arbitrary<bool>() ? Value(number_in(list.range))
                                                      : Value(numbers_in(list.range, 1, 4));
                 },
                 [](const Numbers& list) { return Value(numbers_in(list.range, list.count, list.count)); },
                 [](const Terms& terms) { return Value(numbers_in({}, terms.count, terms.count)); },
                 [](const NumberRows& rows) {
                   return Value(std::vector(rows.least, numbers_in(rows.range, rows.columns, rows.columns)));
                 },
                 [](const Pairs& pairs) {
                   std::vector<std::vector<double>> list(*rc::gen::inRange<std::size_t>(1, 5));
                   for (auto& pair : list) pair = {number_in(pairs.first), number_in(pairs.second)};
                   return Value(std::move(list));
                 },
                 [](const Texts&) { return Value(std::vector<std::string>{some_text()}); }},
      kind);
}

/// Gives every required key and some of the others. Which rows serve is known as soon as the keys before them are.
void fill(Document& document, const Table& table, const std::string& path) {
  for (const Row& row : table.rows) {
    const std::string key = path_in(path, row.key);
    const bool is_required = std::holds_alternative<Required>(row.otherwise);
    if (document.has(key) || !document.holds(row.when, path)) continue;
    if (is_required || *rc::gen::arbitrary<bool>()) document.set(key, some_value(row.kind));
  }
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    if (!document.holds(inner.when, path)) continue;
    if (inner.presence == Presence::optional && *rc::gen::arbitrary<bool>()) continue;
    document.set(inner_path, {});
    if (inner.presence != Presence::list) {
      fill(document, inner, inner_path);
      continue;
    }
    for (std::size_t i = 0; i < *rc::gen::inRange<std::size_t>(1, 4); ++i) {
      document.set(path_of_entry(inner_path, i), {});
      fill(document, inner, path_of_entry(inner_path, i));
    }
  }
}

/// Conditions may look forward: keys that they rule out after all are dropped.
Document some_document() {
  Document document(design_format().root);
  fill(document, design_format().root, "");
  return document;
}

Document read(const std::string& text) {
  return read_document(design_format(), text, "d.toml", kMostTextBytes);
}

RC_GTEST_PROP(DesignFormat, DocumentsReadBackTheSame, ()) {
  const std::string text = document_text(design_format(), some_document());
  Document document(design_format().root);
  try {
    document = read(text);
  } catch (const InputError&) {
    RC_DISCARD("a key that a later one rules out");
  }
  RC_ASSERT(document_text(design_format(), document) == text);
}

TEST(DesignFormat, ExamplesReadBackTheSame) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(RETRACE_SOURCE_DIR) + "/examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Document document = read_document(design_format(), read_file(entry.path()), entry.path().string());
    const std::string text = document_text(design_format(), document);
    EXPECT_EQ(document_text(design_format(), read(text)), text) << entry.path();
  }
  EXPECT_GE(count, 10U);
}

/// What stands in the documentation between the marks of a table.
std::string documented(const std::string& table) {
  const std::string text = read_file(std::string(RETRACE_SOURCE_DIR) + "/docs/design_file.md");
  const std::string mark = "<!-- keys of " + table + " -->\n";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return "no mark of " + table;
  const std::size_t first = at + mark.size();
  return text.substr(first, text.find("<!-- end of keys -->", first) - first);
}

TEST(DesignFormat, DocumentationSaysWhatTheRowsSay) {
  for (const Table& table : design_format().root.tables)
    EXPECT_EQ(documented(std::string(table.name)), key_table(table)) << table.name;
}

TEST(DesignFormat, RowsOfAKeyStandTogether) {
  for (const Table& table : design_format().root.tables) {
    std::set<std::string_view> seen;
    std::string_view last;
    for (const Row& row : table.rows) {
      EXPECT_TRUE(row.key == last || seen.insert(row.key).second) << table.name << "." << row.key;
      last = row.key;
    }
  }
}

}  // namespace
}  // namespace retrace::studies::design_format_test
