#pragma once

// What all pages begin with, and texts in their data: whatever a text contains, it ends no element of the page.

#include <string>
#include <string_view>

namespace retrace::report {

/// Returns an HTML document up to its body. Its policy allows scripts and styles of the page itself and no request to a
/// network.
std::string html_head(std::string_view title, std::string_view style);

/// Returns a JSON text for use in an HTML document, with its quotes.
std::string json_string(std::string_view text);

}  // namespace retrace::report
