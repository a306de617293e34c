#pragma once

// The page and the document of `retrace validate`.

#include <string>

#include "core/warning.h"
#include "studies/validation/validation.h"

namespace retrace::studies {

/// A page of Markdown with a table for each topic. The same bytes wherever it is computed: numbers are rounded to about
/// a hundredth of the difference that is allowed, and neither time nor version stands in it.
std::string validation_markdown(const ValidationResult& result);

/// The document `retrace.validation/1`.
std::string validation_json(const ValidationResult& result);

/// A line for each row that is outside of what it is allowed.
Warnings validation_warnings(const ValidationResult& result);

}  // namespace retrace::studies
