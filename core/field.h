#pragma once

// References to request fields in messages. A field is spelled differently in C++, in Python and on the command line,
// for example target_error and --target-error. A message therefore contains a reference to the field. The program or
// module that shows the message replaces the reference by its own spelling.

#include <string>
#include <string_view>

#include "api.h"  // without the folder core/, because the installed copies of both headers are in the same folder

namespace retrace {

/// Field of a request, such as the field `target_error` of RreRequest. If several requests have fields of the same name
/// but with different options, the name of the request precedes the name of the field: "road.distance_m".
struct Field {
  std::string_view name;
};

/// Returns a reference to a field, to be inserted into the text of a message.
RETRACE_API std::string reference(Field field);

/// Function that returns the spelling of a field for its name, such as "--target-error" for "target_error".
using FieldSpelling = std::string (*)(std::string_view name);

/// Returns the text with each reference replaced by the spelling of its field.
RETRACE_API std::string with_fields(std::string_view text, FieldSpelling spelling);
/// Returns the text with each reference replaced by the C++ name of its field, such as "distance_m" for
/// "road.distance_m".
RETRACE_API std::string with_field_names(std::string_view text);

}  // namespace retrace
