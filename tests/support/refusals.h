#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace retrace {

/// The message with which an input is refused, which is one line. \param read what reads or checks it
/// \param taken the answer if it is not refused
template <class Read>
std::string refusal_of(const Read& read, const std::string& taken = "") {
  try {
    read();
  } catch (const InputError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return taken;
}

/// A text with the first `from` in it replaced.
inline std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "no " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace retrace
