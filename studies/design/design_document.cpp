#include "studies/design/design_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/atomic_file.h"
#include "core/message_text.h"

namespace retrace::studies {
namespace {

constexpr std::string_view kBareKeyCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\t')
      result += "\\t";
    else
      result += c;
  }
  return result + '"';
}

toml::table parse_file(std::string_view text, const std::string& file) {
  require_short_text(text, file, DesignDocument::max_bytes);
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError(InputLocation{file, static_cast<int>(error.source().begin.line), ""},
                     "not valid TOML: " + printable(error.description(), 300));
  }
}

/// `key = value` as TOML; where that fails, with the value as a bare string.
toml::table parse_override(const std::string& text, const std::string& label) {
  const auto refuse = [&](std::string_view why) { return InputError(InputLocation{label, 0, ""}, why); };
  const auto is_control = [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; };
  constexpr std::size_t longest = 4096;
  if (text.size() > longest) throw refuse(fmt::format("at most {} characters are allowed", longest));
  // One line only: a second one would be a second assignment that nobody sees.
  if (std::any_of(text.begin(), text.end(), is_control)) throw refuse("must be one line of the form KEY=VALUE");
  try {
    toml::table table = toml::parse(text, std::string_view(label));
    if (table.size() == 1 && trimmed(text).front() != '[') return table;
  } catch (const toml::parse_error&) {
    // The value is taken as a bare string below.
  }
  const std::size_t equals = text.find('=');
  const std::string_view key = trimmed(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || key.empty() || key.find_first_not_of(kBareKeyCharacters) != std::string_view::npos)
    throw refuse("must be of the form KEY=VALUE, such as element.base_mm=0.5");
  const std::string_view value = trimmed(std::string_view(text).substr(equals + 1));
  try {
    return toml::parse(fmt::format("{} = {}", key, toml_string(value)), std::string_view(label));
  } catch (const toml::parse_error& error) {
    throw refuse("not valid TOML: " + printable(error.description(), 300));
  }
}

/// Moves everything of `from` into `into`; tables are merged, anything else is replaced.
void merge(toml::table& into, toml::table& from) {
  for (auto&& [key, node] : from) {
    toml::table* const source = node.as_table();
    toml::table* const target = source != nullptr ? into.get_as<toml::table>(key.str()) : nullptr;
    if (target != nullptr)
      merge(*target, *source);
    else
      node.visit([&, &name = key](auto& value) { into.insert_or_assign(name.str(), std::move(value)); });
  }
}

}  // namespace

DesignDocument::DesignDocument(std::string_view text, std::string_view source_name,
                               std::span<const std::string> overrides)
    : file_(printable(source_name, std::string::npos)),
      folder_(std::filesystem::path(source_name).parent_path()),
      root_(parse_file(text, file_)) {
  sources_.push_back(root_.source().path);
  for (const std::string& override_text : overrides) apply_override(override_text);
}

void DesignDocument::apply_override(const std::string& text) {
  toml::table table = parse_override(text, "--set " + printable(text, 200));
  sources_.push_back(table.source().path);
  merge(root_, table);
}

std::size_t DesignDocument::source_index(const toml::node& node) const {
  const auto found = std::find(sources_.begin(), sources_.end(), node.source().path);
  return found == sources_.end() ? 0 : static_cast<std::size_t>(found - sources_.begin());
}

InputLocation DesignDocument::location(const toml::node& node, std::string_view key) const {
  const std::size_t index = source_index(node);
  if (index > 0) return {*sources_[index], 0, std::string(key)};
  return {file_, static_cast<int>(node.source().begin.line), std::string(key)};
}

InputLocation DesignDocument::location_of_missing(const toml::node* table, std::string_view key) const {
  if (table == nullptr || table == &root_ || source_index(*table) > 0) return {file_, 0, std::string(key)};
  return location(*table, key);
}

std::filesystem::path DesignDocument::folder(const toml::node& node) const {
  return source_index(node) > 0 ? std::filesystem::path() : folder_;
}

DesignDocument::Position DesignDocument::position(const toml::node& node) const {
  return {source_index(node), node.source().begin.line, node.source().begin.column};
}

}  // namespace retrace::studies
