#pragma once

// Output documents and tables of `retrace inspect`.

#include <string>

#include "studies/inspect/inspect.h"

namespace retrace::studies {

/// Returns the properties as a document of the format `retrace.inspect/2`.
std::string inspect_json(const Inspection& inspection);

/// Returns the properties as lines for the terminal.
std::string inspect_text(const Inspection& inspection);

/// Returns the angles between the axes of the elements and the normal of a curved entrance face as CSV, or an empty
/// text if there are none.
std::string pin_axes_csv(const Inspection& inspection);

/// Returns the faces with less draft than the limit as CSV, or an empty text if there are none.
std::string draft_csv(const Inspection& inspection);

}  // namespace retrace::studies
