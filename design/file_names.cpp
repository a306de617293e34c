#include "design/file_names.h"

#include <fmt/format.h>

namespace retrace::design {

void require_no_files(const Design& design, std::string_view why) {
  const schema::Document& document = *design.document;
  const std::vector<std::string> keys = document.keys_of_files();
  if (!keys.empty()) throw InputError(document.where(keys.front()), fmt::format("this key names a file, {}", why));
}

double mesh_scale(const Design& design, std::string_view table) {
  return design.document ? design.document->number_if(schema::path_in(table, "scale")).value_or(1.0) : 1.0;
}

}  // namespace retrace::design
