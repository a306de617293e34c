#include "core/field.h"

namespace retrace {
namespace {

// Control character at the beginning and at the end of a reference. It cannot come from user input, because messages
// escape the control characters of user input.
constexpr char kMark = '\x1f';

}  // namespace

std::string reference(Field field) {
  return kMark + std::string(field.name) + kMark;
}

std::string with_fields(std::string_view text, FieldSpelling spelling) {
  std::string shown;
  while (true) {
    const std::size_t begin = text.find(kMark);
    const std::size_t end = begin == std::string_view::npos ? begin : text.find(kMark, begin + 1);
    if (end == std::string_view::npos) return shown += text;
    shown += text.substr(0, begin);
    shown += spelling(text.substr(begin + 1, end - begin - 1));
    text.remove_prefix(end + 1);
  }
}

std::string with_field_names(std::string_view text) {
  return with_fields(text, [](std::string_view name) { return std::string(name.substr(name.rfind('.') + 1)); });
}

}  // namespace retrace
