#pragma once

// Output documents and tables of `retrace inspect`.

#include <string>

#include "studies/inspect/inspect.h"

namespace retrace::studies {

/// Returns the properties as a document of the format `retrace.inspect/2`.
std::string inspect_json(const Inspection& inspection);

/// Returns the properties as lines for the terminal.
std::string inspect_text(const Inspection& inspection);

}  // namespace retrace::studies
