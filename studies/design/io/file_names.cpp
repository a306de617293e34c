#include "studies/design/io/file_names.h"

#include <fmt/format.h>

#include "core/schema/reader.h"
#include "studies/design/io/design_format.h"

namespace retrace::studies {

void check_names_no_file(const Design& design, std::string_view why) {
  const schema::Document& document = *design.document;
  if (document.files().empty()) return;
  for (const std::string& key : schema::keys_of(design_format())) {
    const schema::Row* const row = document.has(key) ? document.row(key) : nullptr;
    if (row == nullptr) continue;
    const auto* const either = std::get_if<schema::WordOrFile>(&row->kind);
    const bool is_file = std::holds_alternative<schema::File>(row->kind) ||
                         (either != nullptr && document.text(key).ends_with(either->ending));
    if (is_file) throw InputError(document.where(key), fmt::format("names a file, {}", why));
  }
}

}  // namespace retrace::studies
