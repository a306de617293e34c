#pragma once

// Documents and tables of `retrace inspect`.

#include <string>

#include "studies/inspect/inspect.h"

namespace retrace::studies {

/// The inspection as a `retrace.inspect/1` document.
std::string inspect_json(const Inspection& inspection);

/// The same as lines for a terminal.
std::string inspect_text(const Inspection& inspection);

}  // namespace retrace::studies
