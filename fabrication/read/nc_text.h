#pragma once

// Tools of the NC readers: lines, numbers, words, and the G and M codes that dialects of ISO 6983 share.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Hands out the lines of a program, without their ends. \throw InputError for a line that is too long or binary
class NcLines {
 public:
  /// \throw InputError for an empty or too long text
  NcLines(std::string_view text, const std::string& file);

  bool next(std::string_view& line);
  std::int32_t number() const { return number_; }
  /// The line just handed out is the last one, and nothing ends it: the text may have been cut in it.
  bool is_open_end() const { return rest_.empty() && !ended_by_newline_; }
  const std::string& file() const { return file_; }
  /// Reports an error in the current line.
  /// \throw InputError with the file, the line number, `text` and the complete line
  [[noreturn]] void fail(std::string_view text) const;
  /// Reports that the first word of `rest` is not understood.
  /// \param rest remainder of the current line; it may be in capitals, has no blanks, and has marks in place of
  ///        comments
  /// \throw InputError as fail()
  [[noreturn]] void fail_word(std::string_view rest) const;

 private:
  std::string file_;
  std::string_view line_;  ///< line that next() has returned last
  std::string_view rest_;
  std::int32_t number_ = 0;
  bool ended_by_newline_ = true;
};

/// A number as NC text has it: sign, digits, point, digits; no exponent.
struct NcNumber {
  double value = 0.0;
  bool has_point = false;
  std::uint8_t decimals = 0;
  bool is_whole() const;
  /// Returns the maximum relative rounding error of the number: half of its last decimal, divided by the number.
  /// Returns 0 for 0.
  double relative_rounding() const;
};

/// Returns true if `text` begins with a number: an optional sign, an optional decimal point, then digits.
bool begins_with_number(std::string_view text);

/// Takes a number off the front of `text`. \throw InputError if there is none
NcNumber take_number(std::string_view& text, const NcLines& lines);

/// One letter and its number.
struct NcWord {
  char letter = ' ';
  NcNumber number;
  std::string_view rest = {};  ///< remainder of the line, beginning with `letter`
};

/// Checks a line number (word N). \throw InputError if it is negative or not a whole number
void check_line_number(const NcNumber& number, const NcLines& lines);

/// Takes a word such as off the front, its letter as a capital. \throw InputError if there is none
NcWord take_word(std::string_view& text, const NcLines& lines);

std::string in_capitals(std::string_view text);
/// `text` without blanks and tabs.
std::string without_gaps(std::string_view text);
/// The same in capitals.
std::string without_blanks(std::string_view text);

/// Stands for a comment within a line, so that it ends a word.
inline constexpr char kNcCommentMark = '(';
/// Words may have comments between them, and at both ends of the line.
void skip_comment_marks(std::string_view& text);

/// Takes a line that the integrator has given a meaning as a block. False for any other. \param misplaced why no such
/// line may stand here; empty: it may \throw InputError for one that may not
bool take_text(std::string_view line, const NcTexts& texts, std::string_view misplaced, const NcLines& lines,
               NcProgram& program);

bool starts_with_word(std::string_view text, std::string_view word);

/// A code of a dialect.
struct NcCode {
  double number = 0.0;
  int group = 0;                       ///< modal group, of which a line may have one code; 0: of none
  void (*effect)(NcBlock&) = nullptr;  ///< on its block; null: the line has the time of a dwell
};

/// What codes do, for the tables of dialects.
namespace nc_effects {
inline constexpr auto kRapid = [](NcBlock& b) { b.move = NcMove::rapid; };
inline constexpr auto kLinear = [](NcBlock& b) { b.move = NcMove::linear; };
inline constexpr auto kInch = [](NcBlock& b) { b.unit_mm = 25.4; };
inline constexpr auto kMillimetre = [](NcBlock& b) { b.unit_mm = 1.0; };
template <std::uint16_t what>
inline constexpr auto kSays = [](NcBlock& b) { b.say(what); };
inline constexpr auto kExactStop = [](NcBlock& b) { b.exact_stop = true; };
inline constexpr auto kBlending = [](NcBlock& b) { b.exact_stop = false; };
inline constexpr auto kAbsolute = [](NcBlock& b) { b.absolute = true; };
inline constexpr auto kIncremental = [](NcBlock& b) { b.absolute = false; };
inline constexpr auto kFeedPerMinute = [](NcBlock& b) {
  b.feed_time_s = 60.0;
  b.inverse_time = false;
};
/// F is one over the time of the move, per minute.
inline constexpr auto kInverseTime = [](NcBlock& b) { b.inverse_time = true; };
/// A plane, a cycle that is cancelled, S in turns per minute: nothing that a straight move depends on.
inline constexpr auto kNone = [](NcBlock&) {};
}  // namespace nc_effects

/// Turns the words of one ISO 6983 line into a block: what the dialects share. A dialect says which G codes it has.
class IsoBlock {
 public:
  IsoBlock(const NcLines& lines, NcBlock& block) : lines_(lines), block_(block) {}

  /// Takes a word that all dialects have: of an axis, G, M, F or S. False for any other.
  bool set(const NcWord& word, std::span<const NcCode> g_codes);
  void set_g(const NcWord& word, std::span<const NcCode> codes);
  /// M codes that all dialects share: 0, 1, 3, 4, 5, 7, 8, 9 and, as ends of the program, 2 and 30.
  void set_m(const NcWord& word);
  void set_feed(const NcWord& word);
  void set_spindle_speed(const NcWord& word);
  void set_axis(std::size_t axis, const NcNumber& place);
  void set_dwell(double seconds);
  /// A place and a velocity of an axis. \param cubic of the block
  void set_cubic(std::size_t axis, const NcNumber& place, double velocity, NcCubic& cubic);
  bool wants_dwell() const { return wants_dwell_; }
  /// \throw InputError for words that make no sense together
  void finish();

 private:
  void take_group(const NcCode& code, const NcWord& word);

  const NcLines& lines_;
  NcBlock& block_;
  unsigned groups_ = 0;
  bool wants_dwell_ = false;
};

/// The index of an axis letter, or kNcAxes.
std::size_t axis_index(char letter);

}  // namespace retrace::fabrication
