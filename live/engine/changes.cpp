#include "live/engine/changes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "design/io/design_format.h"
#include "design/io/init_templates.h"
#include "live/engine/form.h"

namespace retrace::live {
namespace {

using namespace schema;

/// Adds the paths of all keys and tables that a document contains. The keys of a table follow the table.
void add_given(const Document& document, const Table& table, const std::string& path, std::vector<std::string>& paths) {
  for (const Row& row : table.rows)
    if (std::string key = path_in(path, row.key); document.has(key) && (paths.empty() || paths.back() != key))
      paths.push_back(std::move(key));
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    if (!document.has(inner_path)) continue;
    paths.push_back(inner_path);
    if (inner.presence != Presence::list) add_given(document, inner, inner_path, paths);
    for (std::size_t i = 0; inner.presence == Presence::list && i < document.count(inner_path); ++i) {
      paths.push_back(path_of_entry(inner_path, i));
      add_given(document, inner, path_of_entry(inner_path, i), paths);
    }
  }
}

std::vector<std::string> given_of(const Document& document) {
  std::vector<std::string> paths;
  add_given(document, document.table(), "", paths);
  return paths;
}

bool lies_in(std::string_view path, std::string_view table) {
  return path == table || (path.starts_with(table) && (path[table.size()] == '.' || path[table.size()] == '['));
}

/// Removes a key, or a table with all its keys.
void drop(Document& document, const std::string& path) {
  for (const std::string& given : given_of(document))
    if (lies_in(given, path)) document.drop(given);
}

/// A document and the changes to be applied.
class Changes {
 public:
  Changes(Document document, const Json& changes) : document_(std::move(document)) {
    for (const auto& [path, value] : changes.items()) {
      if (const std::string complaint = complaint_about_key(design::design_format(), path); !complaint.empty())
        throw InputError({document_.source(), 0, path}, complaint);
      if (value.is_null())
        drop(document_, path);
      else
        give(path, toml_of(value));
    }
  }

  /// Removes keys without an effect and adds missing required keys. This is repeated until the document does not
  /// change, because the validity of a key may depend on other keys.
  void adapt() {
    for (bool goes_on = true; goes_on;) goes_on = drop_meaningless() || give_missing();
  }

  /// \throw InputError if the result is not a valid design
  ChangedText result() const {
    try {
      const Document read =
          read_document(design::design_format(), text(), document_.source(), kMaxTextBytes, overrides());
      return {document_text(design::design_format(), read), adapted_};
    } catch (const InputError& error) {
      // A change has no position in a file, so file and line are removed.
      const InputLocation& at = error.where();
      if (!at.file.starts_with("--set")) throw;
      throw InputError({document_.source(), 0, at.key}, error.text());
    }
  }

 private:
  void give(const std::string& path, std::string toml) { values_.push_back({path, std::move(toml)}); }
  bool is_changed(const std::string& path) const {
    return std::ranges::any_of(values_, [&](const auto& value) { return value.first == path; });
  }
  std::string text() const { return document_text(design::design_format(), document_); }
  std::vector<std::string> overrides() const {
    std::vector<std::string> all;
    for (const auto& [path, toml] : values_) all.push_back(path + "=" + toml);
    return all;
  }
  /// Returns the changed document without checking its values.
  Document unchecked() const {
    return unchecked_names(design::design_format(), text(), document_.source(), kMaxTextBytes, overrides());
  }

  /// Returns true if a key or table in the document has an effect, given the other keys.
  static bool has_meaning(const Document& document, const std::string& path) {
    const auto [around, name] = split_path(path);
    const Table* const outer = table_at(document.table(), around);
    if (outer == nullptr) return true;
    for (const Table& table : outer->tables)
      if (table.name == name) return document.holds(table.when, around);
    for (const Row& row : outer->rows)
      if (row.key == name && document.holds(row.when, around)) {
        const Word* const word = std::get_if<Word>(&row.kind);
        const Value value = document.value(path);
        const std::string* const text = std::get_if<std::string>(&value);
        if (word == nullptr || text == nullptr || std::ranges::count(word->words, std::string_view(*text)) > 0)
          return true;
      }
    return path.ends_with(']');
  }

  bool drop_meaningless() {
    const Document all = unchecked();
    for (const std::string& path : given_of(document_)) {
      if (is_changed(path) || has_meaning(all, path)) continue;
      drop(document_, path);
      adapted_.push_back(path);
      return true;
    }
    return false;
  }

  /// Adds missing required keys, with the values in the template for this kind of element.
  bool give_missing() {
    const Document all = unchecked();
    const std::optional<Document> model = template_for(all);
    if (!model) return false;
    for (const std::string& path : given_of(*model)) {
      const Row* const row = all.row(path);
      if (row == nullptr || !std::holds_alternative<Required>(row->default_spec) || all.has(path)) continue;
      give(path, override_text("", model->value(path)).substr(1));
      adapted_.push_back(path);
      return true;
    }
    return false;
  }

  static std::optional<Document> template_for(const Document& document) {
    const std::string kind = document.text_if("element.kind");
    if (std::ranges::count(design::design_kinds(), std::string_view(kind)) == 0) return std::nullopt;
    return read_document(design::design_format(), design::design_template(kind), kind);
  }

  Document document_;
  std::vector<std::pair<std::string, std::string>> values_;
  std::vector<std::string> adapted_;
};

}  // namespace

ChangedText changed(const Document& document, const Json& changes, bool adapt) {
  Changes all(document, changes);
  if (adapt) all.adapt();
  return all.result();
}

}  // namespace retrace::live
