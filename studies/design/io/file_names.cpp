#include "studies/design/io/file_names.h"

#include <fmt/format.h>

#include "core/schema/reader.h"
#include "studies/design/io/design_format.h"

namespace retrace::studies {

void check_names_no_file(const Design& design, std::string_view why) {
  const schema::Document& document = *design.document;
  if (document.files().empty()) return;
  std::vector<std::string> keys = schema::keys_of(design_format());
  for (std::size_t zone = 0; zone < document.count("zone"); ++zone)
    keys.push_back(schema::path_of_entry("zone", zone) + ".mask");
  for (const std::string& key : keys) {
    const schema::Row* const row = document.has(key) ? document.row(key) : nullptr;
    if (row == nullptr) continue;
    const auto* const either = std::get_if<schema::WordOrFile>(&row->kind);
    const bool is_file = std::holds_alternative<schema::File>(row->kind) ||
                         (either != nullptr && document.text(key).ends_with(either->ending));
    if (is_file) throw InputError(document.where(key), fmt::format("names a file, {}", why));
  }
}

}  // namespace retrace::studies
