#pragma once

// Common functions of the NC readers: lines, numbers, words, and the G and M codes of ISO 6983.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Iterates over the lines of a program, without their line ends.
class NcLines {
 public:
  /// \throw InputError for an empty or too long text
  NcLines(std::string_view text, const std::string& file);

  /// Gets the next line. Returns false at the end of the text.
  /// \throw InputError for a line that is too long or binary
  bool next(std::string_view& line);
  std::int32_t number() const { return number_; }
  /// Returns true if the current line is the last one and has no line end. The file may then be truncated in this line.
  bool is_open_end() const { return remainder_.empty() && !ended_by_newline_; }
  const std::string& file() const { return file_; }
  /// Throws an error about the current line.
  /// \throw InputError with the file, the line number, `text` and the complete line
  [[noreturn]] void fail(std::string_view text) const;
  /// Throws an error which states that the first word of `remainder` is not understood.
  /// \param remainder remainder of the current line without blanks, with kNcCommentMark instead of each comment; it may
  /// have been converted to capitals
  /// \throw InputError as in fail()
  [[noreturn]] void fail_word(std::string_view remainder) const;

 private:
  std::string file_;
  std::string_view line_;  ///< current line
  std::string_view remainder_;
  std::int32_t number_ = 0;
  bool ended_by_newline_ = true;
};

/// Number in NC text: sign, digits, decimal point, digits. Exponents are not allowed.
struct NcNumber {
  double value = 0.0;
  bool has_point = false;
  std::uint8_t decimals = 0;
  bool is_integer() const;
  /// Returns the maximum relative rounding error of the number. It is half of its last decimal divided by the number,
  /// or 0 for the number 0.
  double relative_rounding() const;
};

/// Returns true if `text` begins with a number: an optional sign, an optional decimal point, then digits.
bool begins_with_number(std::string_view text);

/// Removes a number from the front of `text` and returns it.
/// \throw InputError if `text` does not begin with a number
NcNumber take_number(std::string_view& text, const NcLines& lines);

/// Word of an NC line: a letter and its number.
struct NcWord {
  char letter = ' ';
  NcNumber number;
  std::string_view remainder = {};  ///< remainder of the line, beginning with `letter`
};

/// Checks a line number (word N).
/// \throw InputError if it is negative or not a whole number
void check_line_number(const NcNumber& number, const NcLines& lines);

/// Removes a word such as from the front of `text` and returns it. Its letter is returned as a capital.
/// \throw InputError if `text` does not begin with a word
NcWord take_word(std::string_view& text, const NcLines& lines);

std::string in_capitals(std::string_view text);
/// Returns `text` without blanks and tabs.
std::string without_gaps(std::string_view text);
/// Returns `text` in capitals without blanks and tabs.
std::string without_blanks(std::string_view text);

/// Mark that replaces a comment in a line. It ends the preceding word.
inline constexpr char kNcCommentMark = '(';
/// Removes comment marks from the front of `text`.
void skip_comment_marks(std::string_view& text);

/// Reads a line whose meaning the machine file or the part file defines, and adds it to the program as a block.
/// \param misplaced error message if such a line is not allowed at this position; empty if it is allowed
/// \return false if the line is not one of these lines
/// \throw InputError for a line that is not allowed at this position
bool take_text(std::string_view line, const NcTexts& texts, std::string_view misplaced, const NcLines& lines,
               NcProgram& program);

bool starts_with_word(std::string_view text, std::string_view word);

/// G or M code of a dialect.
struct NcCode {
  double number = 0.0;
  int group = 0;  ///< modal group; a line may have one code of each group; 0 for no group
  /// Effect on the block; null for a dwell, because another word of the line gives its time.
  void (*effect)(NcBlock&) = nullptr;
};

/// Effects of codes, for the tables of the dialects.
namespace nc_effects {
inline constexpr auto kRapid = [](NcBlock& b) { b.move = NcMove::rapid; };
inline constexpr auto kLinear = [](NcBlock& b) { b.move = NcMove::linear; };
inline constexpr auto kInch = [](NcBlock& b) { b.unit_mm = 25.4; };
inline constexpr auto kMillimetre = [](NcBlock& b) { b.unit_mm = 1.0; };
template <std::uint16_t what>
inline constexpr auto kMarks = [](NcBlock& b) { b.mark_setting(what); };
inline constexpr auto kExactStop = [](NcBlock& b) { b.exact_stop = true; };
inline constexpr auto kBlending = [](NcBlock& b) { b.exact_stop = false; };
inline constexpr auto kAbsolute = [](NcBlock& b) { b.absolute = true; };
inline constexpr auto kIncremental = [](NcBlock& b) { b.absolute = false; };
inline constexpr auto kFeedPerMinute = [](NcBlock& b) {
  b.feed_time_s = 60.0;
  b.inverse_time = false;
};
/// Inverse time mode: F is the inverse of the move's duration, in 1/min.
inline constexpr auto kInverseTime = [](NcBlock& b) { b.inverse_time = true; };
/// No effect on straight moves, for example selection of a plane, cancellation of a cycle, or S in rpm.
inline constexpr auto kNone = [](NcBlock&) {};
}  // namespace nc_effects

/// Converts the words of one ISO 6983 line to a block. The G codes are given by a table of the dialect.
class IsoBlock {
 public:
  IsoBlock(const NcLines& lines, NcBlock& block) : lines_(lines), block_(block) {}

  /// Reads a word that is common to all dialects: an axis, G, M, F or S. Returns false for any other word.
  bool set(const NcWord& word, std::span<const NcCode> g_codes);
  void set_g(const NcWord& word, std::span<const NcCode> codes);
  /// Reads an M code that is common to all dialects: 0, 1, 3, 4, 5, 7, 8, 9, and the program ends 2 and 30.
  void set_m(const NcWord& word);
  void set_feed(const NcWord& word);
  void set_spindle_speed(const NcWord& word);
  void set_axis(std::size_t axis, const NcNumber& place);
  void set_dwell(double seconds);
  /// Sets the position and the velocity of an axis in a cubic move.
  /// \param cubic cubic move of the block
  void set_cubic(std::size_t axis, const NcNumber& place, double velocity, NcCubic& cubic);
  bool expects_dwell_time() const { return expects_dwell_time_; }
  /// Ends the block and checks its words.
  /// \throw InputError for words that are not allowed together
  void finish();

 private:
  void take_group(const NcCode& code, const NcWord& word);

  const NcLines& lines_;
  NcBlock& block_;
  unsigned groups_ = 0;
  bool expects_dwell_time_ = false;
};

/// Returns the index of an axis letter, or kNcAxes if it is not the letter of an axis.
std::size_t axis_index(char letter);

}  // namespace retrace::fabrication
