#pragma once

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/error.h"

namespace retrace::fuzz {

/// Aborts unless the message of the error is one line of printable characters.
inline void require_one_line(const InputError& error) {
  const std::string_view message = error.what();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  if (message.empty() || std::any_of(message.begin(), message.end(), is_control)) std::abort();
}

}  // namespace retrace::fuzz
