#pragma once

// G codes that the Aerotech controls A3200 and Automation1 have in common.

#include "fabrication/read/nc_text.h"

namespace retrace::fabrication {

/// Sets the time unit of feeds to a number of seconds.
template <int seconds>
inline constexpr auto kAerotechFeedTime = [](NcBlock& b) { b.feed_time_s = seconds; };

/// Supported G codes. Aerotech publishes no table of modal groups, so the groups follow from the meaning of the codes.
/// Not supported are inverse time (G93), feed per revolution (G95), arcs, compensations and offsets.
inline constexpr NcCode kAerotechCodes[] = {
    {0, 1, nc_effects::kRapid},
    {1, 1, nc_effects::kLinear},
    {4, 2, nullptr},
    {17, 3, nc_effects::kNone},
    {18, 3, nc_effects::kNone},
    {19, 3, nc_effects::kNone},
    {40, 4, nc_effects::kMarks<nc_setting::kRadiusOff>},
    {75, 5, kAerotechFeedTime<60>},
    {76, 5, kAerotechFeedTime<1>},
    {90, 6, nc_effects::kAbsolute},
    {91, 6, nc_effects::kIncremental},
    {94, 7, nc_effects::kMarks<nc_setting::kFeedMode>},
    {108, 8, nc_effects::kBlending},
    {109, 8, nc_effects::kExactStop},
    {149, 9, nc_effects::kMarks<nc_setting::kLengthOff>},
    // METRIC and ENGLISH of the A3200. For the Automation1, these codes are not documented.
    {70, 10, nc_effects::kInch},
    {71, 10, nc_effects::kMillimetre},
};

/// Reads a word. P is the time of a dwell in seconds. M codes for coolant are refused, because the machine builder
/// defines them.
inline void take_aerotech_word(const NcWord& word, IsoBlock& iso, const NcLines& lines) {
  if (word.letter == 'P') return iso.set_dwell(word.number.value);
  const double code = word.number.value;
  const bool is_coolant = word.letter == 'M' && code >= 7 && code <= 9;
  if (is_coolant) lines.fail_word(word.remainder);
  if (!iso.set(word, kAerotechCodes)) lines.fail_word(word.remainder);
}

/// Returns true if `text` is a valid name of a subroutine: letters, digits and underscores, not beginning with a digit.
inline bool is_aerotech_name(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
  if (text.empty() || letters.find(text.front()) == std::string_view::npos) return false;
  return text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_0123456789") ==
         std::string_view::npos;
}

}  // namespace retrace::fabrication
