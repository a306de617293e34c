#pragma once

// What the G codes of Aerotech's controls share.

#include "fabrication/read/nc_text.h"

namespace retrace::fabrication {

/// Time that feeds are per.
template <int seconds>
inline constexpr auto kAerotechFeedTime = [](NcBlock& b) { b.feed_time_s = seconds; };

/// Groups by meaning: Aerotech publishes no table of modal groups. Feeds that are times (G93) or per turn (G95), arcs,
/// compensations and offsets are not understood.
inline constexpr NcCode kAerotechCodes[] = {
    {0, 1, nc_effects::kRapid},
    {1, 1, nc_effects::kLinear},
    {4, 2, nullptr},
    {17, 3, nc_effects::kNone},
    {18, 3, nc_effects::kNone},
    {19, 3, nc_effects::kNone},
    {40, 4, nc_effects::kSays<nc_said::kRadiusOff>},
    {75, 5, kAerotechFeedTime<60>},
    {76, 5, kAerotechFeedTime<1>},
    {90, 6, nc_effects::kAbsolute},
    {91, 6, nc_effects::kIncremental},
    {94, 7, nc_effects::kSays<nc_said::kFeedMode>},
    {108, 8, nc_effects::kBlending},
    {109, 8, nc_effects::kExactStop},
    {149, 9, nc_effects::kSays<nc_said::kLengthOff>},
    // METRIC and ENGLISH of the A3200; what they are of Automation1 is not published.
    {70, 10, nc_effects::kInch},
    {71, 10, nc_effects::kMillimetre},
};

/// P is the time of a dwell in seconds. M codes for coolant are those of the machine's builder.
inline void take_aerotech_word(const NcWord& word, IsoBlock& iso, const NcLines& lines) {
  if (word.letter == 'P') return iso.set_dwell(word.number.value);
  const double code = word.number.value;
  const bool is_coolant = word.letter == 'M' && code >= 7 && code <= 9;
  if (is_coolant) lines.fail_word(word.rest);
  if (!iso.set(word, kAerotechCodes)) lines.fail_word(word.rest);
}

/// A name of a subroutine: letters, digits and underscores, no digit first.
inline bool is_aerotech_name(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
  if (text.empty() || letters.find(text.front()) == std::string_view::npos) return false;
  return text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_0123456789") ==
         std::string_view::npos;
}

}  // namespace retrace::fabrication
