#pragma once

// The head of all HTML pages, and JSON strings in their data. Special characters in texts are escaped. A text therefore
// cannot close an element of the page.

#include <string>
#include <string_view>

namespace retrace::report {

/// Returns the part of an HTML document before its body. The Content-Security-Policy of the document allows scripts and
/// styles that the page contains, and forbids requests to a network.
std::string html_head(std::string_view title, std::string_view style);

/// Returns a text as a JSON string, including the quotes, for use in an HTML document.
std::string json_string(std::string_view text);

}  // namespace retrace::report
