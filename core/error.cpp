#include "core/error.h"

#include <fmt/format.h>

namespace retrace {
namespace {

std::string located(const InputLocation& where, std::string_view text) {
  std::string message;
  if (!where.file.empty())
    message += where.line > 0 ? fmt::format("{}:{}: ", where.file, where.line) : where.file + ": ";
  if (!where.key.empty()) message += where.key + ": ";
  message += text;
  return message;
}

}  // namespace

InputError::InputError(const InputLocation& where, std::string_view text)
    : Error(ExitCode::bad_input, located(where, text)),
      where_{where.file, where.line, with_field_names(where.key)},
      text_(text) {}

InputError::InputError(Field field, std::string_view text)
    : Error(ExitCode::bad_input, located({"", 0, reference(field)}, text)),
      where_{"", 0, with_field_names(reference(field))},
      text_(text),
      field_(field.name) {}

}  // namespace retrace
