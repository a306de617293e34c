#pragma once

// Texts in HTML documents: whatever they hold, they are shown as texts and end nothing that they stand in.

#include <string>
#include <string_view>

namespace retrace::report {

/// `text` with what HTML gives a meaning replaced.
std::string html_text(std::string_view text);

/// A text in JSON that stands in an HTML document, with its quotes.
std::string json_string(std::string_view text);

}  // namespace retrace::report
