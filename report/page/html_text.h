#pragma once

// Writes the head of HTML pages, and JSON strings within HTML. Special characters of texts are escaped, so that a text
// cannot inject HTML into the page.

#include <string>
#include <string_view>

namespace retrace::report {

/// Returns the part of an HTML document before its body. It contains a Content-Security-Policy, which allows only
/// scripts and styles in the page itself and forbids requests to a network.
/// \param style content of the style element (CSS)
std::string html_head(std::string_view title, std::string_view style);

/// Returns a text as a JSON string with quotes, which can be embedded in an HTML document: <, > and & are escaped.
std::string json_string(std::string_view text);

}  // namespace retrace::report
