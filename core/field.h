#pragma once

// References to fields of requests in messages. A field has one name in the library, in Python and on the command line,
// but is spelled differently in each: target_error, or --target-error. A message therefore contains a reference, and
// the program or module that shows the message spells it.

#include <string>
#include <string_view>

#include "api.h"  // without a folder, because these headers are installed together with the library

namespace retrace {

/// Field of a request, such as the field `target_error` of RreRequest. If fields of several requests have the same name
/// but different options, the name of the request precedes it: "road.distance_m".
struct Field {
  std::string_view name;
};

/// Returns a reference to a field for use in the text of a message.
RETRACE_API std::string reference(Field field);

/// Function that returns the spelling of a field by its name, such as "--target-error" for "target_error".
using FieldSpelling = std::string (*)(std::string_view name);

/// Returns a text in which each reference is replaced by the spelling of its field.
RETRACE_API std::string with_fields(std::string_view text, FieldSpelling spelling);
/// Returns a text in which each reference is replaced by the name of its field, without a request.
RETRACE_API std::string with_field_names(std::string_view text);

}  // namespace retrace
