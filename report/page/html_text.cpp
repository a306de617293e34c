#include "report/page/html_text.h"

#include <fmt/format.h>

namespace retrace::report {

std::string html_text(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&': html += "&amp;"; break;
      case '<': html += "&lt;"; break;
      case '>': html += "&gt;"; break;
      case '"': html += "&quot;"; break;
      case '\'': html += "&#39;"; break;
      default: html += c;
    }
  }
  return html;
}

std::string json_string(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      json += {'\\', c};
    else if (byte < 0x20 || c == '<' || c == '>' || c == '&')
      json += fmt::format("\\u{:04x}", byte);
    else
      json += c;
  }
  return json + "\"";
}

}  // namespace retrace::report
