#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/warning.h"

// Functions for tests of error messages. A test checks the position at which an input is refused, but not the wording
// of the message. The wordings of all messages are recorded in tests/messages.txt, one message per line.

namespace retrace {

/// Fails the test unless tests/messages.txt contains the message, which is one line. In that file, messages lack their
/// file and line, `TMP` replaces the path of a temporary folder, and long numbers are rounded. If the environment
/// variable RETRACE_WRITE_GOLDEN is set, a missing line is added to the file.
void record_message(std::string_view message);

/// Records a message and returns its beginning `file:line: key`. Parts that the message does not contain are omitted.
std::string recorded_place_of(std::string_view message);

/// Returns `file:line: key` of an error. Unknown parts are omitted; if all are unknown, returns "refused". Returns
/// "failed" for an error that is not an InputError. `TMP` replaces the path of a temporary folder. Expects that the
/// error has the exit code of its type.
std::string place_of(const Error& error);

/// Records the message of an error and returns place_of(error).
std::string recorded_place_of(const Error& error);

/// Records the text of a warning and returns `id at file:line: key`, without the parts of the place that are unknown.
std::string facts_of(const Warning& warning);
std::vector<std::string> facts_of(const Warnings& warnings);

/// Returns place_of() for the error that `read` throws. Use this function in tests of random inputs, because it does
/// not record the message.
/// \param taken result if `read` throws no error
template <class Read>
std::string unrecorded_refusal_of(const Read& read, const std::string& taken = "") {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string::npos) << error.what();
    return place_of(error);
  }
  return taken;
}

/// Returns place_of() for the error that `read` throws, and records the message of the error.
/// \param taken result if `read` throws no error
template <class Read>
std::string refusal_of(const Read& read, const std::string& taken = "") {
  try {
    read();
  } catch (const Error& error) {
    return recorded_place_of(error);
  }
  return taken;
}

/// Expects that `refused`, called with the first text of a pair, returns the second text, for all pairs.
template <class Refused>
void expect_refusals(const Refused& refused, const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [given, place] : cases) EXPECT_EQ(refused(given), place) << given;
}

/// Change of a text: `to` replaces `from`. `place` is `file:line: key` of the message for the changed text.
struct RefusedChange {
  std::string from;
  std::string to;
  std::string place;
};

/// Expects that `refused`, called with the two texts of a change, returns the place of the change, for all changes.
template <class Refused>
void expect_change_refusals(const Refused& refused, const std::vector<RefusedChange>& cases) {
  for (const auto& [from, to, place] : cases) EXPECT_EQ(refused(from, to), place) << from << " to " << to;
}

/// Returns the text with the first occurrence of `from` replaced by `to`. Expects that there is one.
inline std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "no " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace retrace
