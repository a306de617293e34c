#include "tests/support/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/number_format.h"
#include "core/overloaded.h"

namespace retrace::schema {
namespace {

std::string codes(std::span<const std::string_view> words, std::string_view separator) {
  std::vector<std::string> texts;
  for (const std::string_view word : words) texts.push_back(fmt::format("`\"{}\"`", word));
  return fmt::format("{}", fmt::join(texts, separator));
}

/// Returns a number with a short exponent, such as 1e6 instead of 1e+06.
std::string bound(double value) {
  if (!std::isfinite(value)) return {};
  std::string text = shortest(value);
  for (const auto& [from, to] : {std::pair{"e+0", "e"}, std::pair{"e-0", "e-"}})
    if (const std::size_t at = text.find(from); at != std::string::npos) text.replace(at, 3, to);
  return text;
}

/// Returns a range as text, such as "above 0, to 100", "0 to 60" or "at least 1". Returns an empty text for a range
/// without bounds.
std::string range_text(const NumberRange& range) {
  const std::string low = bound(range.low);
  const std::string high = bound(range.high);
  const std::string_view up_to = range.high_included ? "to " : "to below ";
  if (low.empty() && high.empty()) return "";
  if (low.empty()) return (range.high_included ? "at most " : "below ") + high;
  if (high.empty()) return (range.low_included ? "at least " : "above ") + low;
  return fmt::format("{}{}{}{}", range.low_included ? "" : "above ", low, range.low_included ? " " : ", ",
                     fmt::format("{}{}", up_to, high));
}

/// Returns the text followed by the range, if the range has bounds.
std::string with_range(std::string text, const NumberRange& range) {
  const std::string limits = range_text(range);
  return limits.empty() ? text : text + ", " + limits;
}

std::string allowed_words(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) {
                   const std::string sane = range_text(number.plausible);
                   const std::string limits = sane.empty() ? range_text(number.range) : sane;
                   return limits.empty() ? std::string("a number") : limits;
                 },
                 [](const Integer& whole) { return with_range("a whole number", whole.range); },
                 [](const Flag&) { return std::string("true or false"); },
                 [](const Word& word) { return codes(word.words, ", "); },
                 [](const Text&) { return std::string("a text"); },
                 [](const File& file) { return "the name of " + std::string(file.what); },
                 [](const WordOrFile& either) {
                   return fmt::format("{}, or a file that ends in {}", codes(either.words, ", "), either.ending);
                 },
                 [](const NumberOrNumbers& list) { return with_range(allowed(Kind(list)), list.range); },
                 [](const Pairs& pairs) { return fmt::format("a list of pairs `{}`", pairs.shape); },
                 [](const Numbers& list) { return with_range(fmt::format("{} numbers", list.count), list.range); },
                 [](const Terms& terms) { return fmt::format("a list of numbers, {} for each term", terms.count); },
                 [](const NumberRows& rows) {
                   return with_range(
                       fmt::format("{} to {} {} of {} numbers", rows.min_rows, rows.max_rows, rows.what, rows.columns),
                       rows.range);
                 },
                 [](const Texts&) { return std::string("a list of texts"); },
                 [](const TextOrTexts& texts) { return std::string(texts.what); },
                 [](const Anything&) { return std::string("a list of numbers, texts or lists"); },
                 [](const ByName& named) { return std::string(named.what); }},
      kind);
}

std::string default_words(const Default& otherwise) {
  return std::visit(Overloaded{[](const Required&) { return std::string("required"); },
                               [](const None&) { return std::string("none"); },
                               [](const Computed& computed) { return std::string(computed.sentence); },
                               [](bool flag) { return std::string(flag ? "true" : "false"); },
                               [](double number) { return shortest(number); },
                               [](std::string_view text) { return fmt::format("`\"{}\"`", text); },
                               [](std::span<const double> numbers) {
                                 std::vector<std::string> texts;
                                 for (const double number : numbers) texts.push_back(shortest(number));
                                 return fmt::format("{}", fmt::join(texts, ", "));
                               }},
                    otherwise);
}

/// Returns "required" for a required table, "one of these" if the file must contain one of several tables, and
/// otherwise the meaning of a missing table.
std::string presence_words(const Table& inner, const Table& table) {
  for (const Rule& rule : table.rules) {
    const auto* const one_of = std::get_if<OneOf>(&rule);
    if (one_of == nullptr || std::count(one_of->keys.begin(), one_of->keys.end(), inner.name) == 0) continue;
    return "one of these";
  }
  return inner.presence == Presence::always ? "required" : std::string(inner.default_text);
}

/// Returns the conditions under which a key has an effect. Conditions that exclude a key are not listed, because
/// messages explain them.
std::string conditions_words(When when) {
  std::vector<std::string> texts;
  for (const Condition& condition : when) {
    if (condition.is == Condition::Is::one_of)
      texts.push_back(fmt::format("for `{}` {}", condition.key, codes(condition.words, " or ")));
    if (condition.is == Condition::Is::given) texts.push_back(fmt::format("with `{}`", condition.key));
  }
  return texts.empty() ? "" : fmt::format(" Only {}.", fmt::join(texts, ", "));
}

std::string line(std::string_view key, std::string_view otherwise, std::string_view text) {
  return fmt::format("| `{}` | {} | {} |\n", key, otherwise, text);
}

/// Returns the meanings of all rules of the table that contain names of keys.
std::string rule_words(const Table& table) {
  std::string text;
  for (const Rule& rule : table.rules)
    if (const Check* const check = std::get_if<Check>(&rule); check != nullptr && !check->keys.empty())
      text += fmt::format(" {}", check->meaning);
  return text;
}

/// Returns the allowed values of a table that is written in one line. They are the allowed values of the first key of
/// the table. For a list of tables, returns all keys with their allowed values.
std::string in_line_words(const Table& table) {
  if (table.presence != Presence::list) return allowed_words(table.rows.front().kind);
  std::string text = "a list of tables";
  for (const Row& row : table.rows)
    text += fmt::format("{} `{}` ({}; {})", row.key == table.rows.front().key ? " of" : ",", row.key,
                        allowed_words(row.kind), row.meaning.substr(0, row.meaning.size() - 1));
  return text;
}

std::string rows_text(const Table& table) {
  std::string text;
  for (const Row& row : table.rows)
    if (&row == &table.rows.front() || (&row - 1)->key != row.key || (&row - 1)->when.data() != row.when.data())
      text += line(row.key, default_words(row.default_spec),
                   fmt::format("{}. {}{}", allowed_words(row.kind), row.meaning, conditions_words(row.when)));
  for (const Table& inner : table.tables)
    if (inner.layout == Layout::in_line)
      text += line(inner.name, presence_words(inner, table),
                   fmt::format("{}. {}{}{}", in_line_words(inner), inner.meaning, rule_words(inner),
                               conditions_words(inner.when)));
  return text;
}

/// Returns the text that follows the rows of a table.
std::string rules_text(const Table& table) {
  const std::string rules = rule_words(table);
  return rules.empty() ? "" : fmt::format("\n{}\n", rules.substr(1));
}

bool have_same_keys(const Table& a, const Table& b) {
  return a.rows.data() == b.rows.data() && a.tables.data() == b.tables.data();
}

std::string head(std::string_view names) {
  return fmt::format("| {} | default | allowed |\n|---|---|---|\n", names);
}

std::string path_of(const Table& table, const std::string& around) {
  return around.empty() ? std::string(table.name) : fmt::format("{}.{}", around, table.name);
}

std::string head_of(const Table& table, const std::string& path) {
  return table.presence == Presence::list ? fmt::format("`[[{}]]`", path) : fmt::format("`[{}]`", path);
}

std::string tables_text(const Table& table, const std::string& path) {
  std::string text;
  const auto& all = table.tables;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].layout == Layout::in_line) continue;
    const std::size_t first = i;
    std::vector<std::string> heads;
    for (; i < all.size() && have_same_keys(all[first], all[i]); ++i)
      heads.push_back(head_of(all[i], path_of(all[i], path)));
    --i;
    text += "\n" + head(fmt::format("{}", fmt::join(heads, ", "))) + rows_text(all[i]) + rules_text(all[i]) +
            tables_text(all[i], path_of(all[i], path));
  }
  return text;
}

}  // namespace

std::string key_table(const Table& table) {
  return head("key") + rows_text(table) + rules_text(table);
}

std::string rule_table(const Table& root) {
  std::string text;
  for (const Rule& rule : root.rules) {
    if (const Check* const check = std::get_if<Check>(&rule); check != nullptr && !check->keys.empty())
      text += fmt::format("| `{}` | {} |\n", fmt::join(check->keys, "`, `"), check->meaning);
    if (const Precedence* const precedence = std::get_if<Precedence>(&rule))
      text += fmt::format("| `{}` | {} |\n", fmt::join(precedence->keys, "`, `"), precedence->meaning);
  }
  return text.empty() ? text : "| keys | rule for these keys |\n|---|---|\n" + text;
}

std::string key_tables(const Format& format) {
  const std::string rules = rule_table(format.root);
  return head("key") + line("schema", format.id_is_optional ? "none" : "required", fmt::format("`\"{}\"`", format.id)) +
         rows_text(format.root) + tables_text(format.root, "") + (rules.empty() ? "" : "\n" + rules);
}

}  // namespace retrace::schema
