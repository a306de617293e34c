#pragma once

// Converts bytes to Base64 text, for documents that embed files.

#include <string>
#include <string_view>

namespace retrace {

/// Returns bytes in Base64 (RFC 4648), without line breaks.
std::string base64(std::string_view bytes);

}  // namespace retrace
