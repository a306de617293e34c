#pragma once

// Bytes as text, for documents that hold files within themselves.

#include <string>
#include <string_view>

namespace retrace {

/// Bytes in Base64 (RFC 4648), without line breaks.
std::string base64(std::string_view bytes);

}  // namespace retrace
