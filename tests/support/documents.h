#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/overloaded.h"
#include "core/schema/json.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"

// Random documents of any format, made from its rows, and checks of the documentation of a format.

namespace retrace::documents_test {

using namespace schema;

/// Returns a random number inside the range. Its shortest text is read back as exactly the same number.
inline double number_in(const NumberRange& range, const NumberRange& sane = {}) {
  const double low = std::max({range.low, sane.low, -1e3});
  const double high = std::min({range.high, sane.high, low + 1e3});
  return low + (high - low) * *rc::gen::inRange(1, 1 << 20) / static_cast<double>(1 << 20);
}
inline std::vector<double> numbers_in(const NumberRange& range, std::size_t least, std::size_t most) {
  std::vector<double> numbers(*rc::gen::inRange(least, most + 1));
  for (double& number : numbers) number = number_in(range);
  return numbers;
}
inline std::string word_of(std::span<const std::string_view> words) {
  return std::string(words[*rc::gen::inRange<std::size_t>(0, words.size())]);
}
inline std::string some_text() {
  return *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
}

inline Named some_named(const ByName& kind) {
  std::vector<std::string> names(kind.names.begin(), kind.names.end());
  if (names.empty()) names = {some_text(), "a.b"};
  Named named;
  for (const std::string& name : names)
    std::visit(Overloaded{[&](const Number& each) { named[name] = number_in(each.range); },
                          [&](const Word& each) { named[name] = word_of(each.words); }},
               kind.each);
  return named;
}

inline Value some_value(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) { return Value(number_in(number.range, number.plausible)); },
                 [](const Integer& whole) { return Value(std::ceil(number_in(whole.range))); },
                 [](const Flag&) { return Value(*rc::gen::arbitrary<bool>()); },
                 [](const Word& word) { return Value(word_of(word.words)); },
                 [](const Text&) { return Value(some_text()); }, [](const File&) { return Value(some_text()); },
                 [](const WordOrFile& either) {
                   return Value(*rc::gen::arbitrary<bool>() ? word_of(either.words)
                                                            : some_text() + std::string(either.ending));
                 },
                 [](const NumberOrNumbers& list) {
                   std::vector<double> numbers = numbers_in(list.range, 1, 4);
                   if (list.is_integer)
                     for (double& number : numbers) number = std::ceil(number);
                   return *rc::gen::arbitrary<bool>() ? Value(numbers.front()) : Value(std::move(numbers));
                 },
                 [](const Numbers& list) { return Value(numbers_in(list.range, list.count, list.count)); },
                 [](const Terms& terms) { return Value(numbers_in({}, terms.count, terms.count)); },
                 [](const NumberRows& rows) {
                   return Value(std::vector(rows.min_rows, numbers_in(rows.range, rows.columns, rows.columns)));
                 },
                 [](const Pairs& pairs) {
                   std::vector<std::vector<double>> list(*rc::gen::inRange<std::size_t>(1, 5));
                   for (auto& pair : list) pair = {number_in(pairs.first), number_in(pairs.second)};
                   return Value(std::move(list));
                 },
                 [](const Texts&) { return Value(std::vector<std::string>{some_text()}); },
                 [](const TextOrTexts&) { return Value(std::vector<std::string>(2, some_text())); },
                 [](const Anything&) {
                   return Value(std::vector<std::string>{"1.5", "[ 1, 2 ]", "'word'"});
                 },
                 [](const ByName& named) { return Value(some_named(named)); }},
      kind);
}

/// For each set of keys of which exactly one must be given, selects one key at random. The result is true for the
/// selected keys, and false for all other keys of the sets.
inline std::map<std::string_view, bool> chosen_keys(const Table& table) {
  std::map<std::string_view, bool> chosen;
  for (const Rule& rule : table.rules) {
    const auto* const one_of = std::get_if<OneOf>(&rule);
    if (one_of == nullptr) continue;
    for (const std::string_view key : one_of->keys) chosen[key] = false;
    chosen[one_of->keys[*rc::gen::inRange<std::size_t>(0, one_of->keys.size())]] = true;
  }
  return chosen;
}

/// Sets all required keys and, at random, some optional keys. Keys are set in the order of their rows, because the
/// allowed values of a key may depend on the values of earlier keys.
inline void fill(Document& document, const Table& table, const std::string& path) {
  const std::map<std::string_view, bool> chosen = chosen_keys(table);
  for (const Row& row : table.rows) {
    const std::string key = path_in(path, row.key);
    if (document.has(key) || !document.holds(row.when, path)) continue;
    const auto choice = chosen.find(row.key);
    if (choice != chosen.end() && !choice->second) continue;
    const bool is_required = std::holds_alternative<Required>(row.default_spec) || choice != chosen.end();
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

/// Expects that a random document can be written and read back unchanged. A condition may refer to a later key. If such
/// a condition does not hold, the document is invalid and is skipped.
inline void expect_random_document_to_read_back(const Format& format) {
  Document document(format.root);
  fill(document, format.root, "");
  const std::string text = document_text(format, document);
  try {
    document = read_document(format, text, "d.toml");
  } catch (const InputError&) {
    RC_DISCARD("a key that a later one rules out");
  }
  RC_ASSERT(document_text(format, document) == text);
  const auto json = to_json(document);
  RC_ASSERT(to_json(read_document(format, toml_of_json(format, json), "d.toml")) == json);
}

/// Returns the text in a page of docs/ between the marks of a table or format.
inline std::string documented(const std::string& page, std::string_view name) {
  const std::string text = read_file(std::string(RETRACE_SOURCE_DIR) + "/docs/" + page);
  const std::string mark = "<!-- keys of " + std::string(name) + " -->\n";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return "no mark in " + page;
  const std::size_t first = at + mark.size();
  return text.substr(first, text.find("<!-- end of keys -->", first) - first);
}

}  // namespace retrace::documents_test
