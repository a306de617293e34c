#pragma once

// Output page and document of `retrace validate`.

#include <string>

#include "core/warning.h"
#include "studies/validation/validation.h"

namespace retrace::studies {

/// Returns a page in Markdown with a table for each topic. The text is identical on all machines, because numbers are
/// rounded to about a hundredth of the allowed difference, and the page contains neither times nor the version.
std::string validation_markdown(const ValidationResult& result);

/// Returns the document `retrace.validation/1`.
std::string validation_json(const ValidationResult& result);

/// Returns a warning for each row whose difference is larger than allowed.
Warnings validation_warnings(const ValidationResult& result);

}  // namespace retrace::studies
