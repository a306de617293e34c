#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

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

/// Expects `complain` to say of each first text what stands beside it.
template <class Complain>
void expect_messages(const Complain& complain, const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [given, message] : cases) EXPECT_EQ(complain(given), message) << given;
}

/// A text with the first `from` in it replaced.
inline std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "no " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace retrace
