#pragma once

#include <cstddef>
#include <cstdint>
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
  [[noreturn]] void fail(std::string_view text) const;

 private:
  std::string file_;
  std::string_view rest_;
  std::int32_t number_ = 0;
  bool ended_by_newline_ = true;
};

/// A number as NC text has it: sign, digits, point, digits; no exponent.
struct NcNumber {
  double value = 0.0;
  bool has_point = false;
  bool is_whole() const;
};

/// Takes a number off the front of `text`. \throw InputError if there is none
NcNumber take_number(std::string_view& text, const NcLines& lines);

/// One letter and its number.
struct NcWord {
  char letter = ' ';
  NcNumber number;
};

/// Takes a word such as off the front, its letter as a capital. \throw InputError if there is none
NcWord take_word(std::string_view& text, const NcLines& lines);

/// `text` without blanks and tabs, in capitals.
std::string without_blanks(std::string_view text);

bool starts_with_word(std::string_view text, std::string_view word);

/// Turns the words of one ISO 6983 line into a block: what the dialects share. A dialect says which codes it has.
class IsoBlock {
 public:
  /// What a G code does.
  enum class Code {
    unknown,
    rapid,
    linear,
    dwell,
    no_effect,  ///< a plane, or a cycle that is cancelled: nothing that a straight move depends on
    inch,
    millimetre,
    compensation_off,
    workpiece_offset,
    exact_stop,
    blending,
    absolute,
    incremental,
    feed_per_minute,
    inverse_time  ///< F is one over the time of the move, per minute
  };

  /// Codes of one modal group exclude each other in a line; 0: of no group.
  struct Meaning {
    Code code = Code::unknown;
    int group = 0;
  };

  IsoBlock(const NcLines& lines, NcBlock& block) : lines_(lines), block_(block) {}

  void set_g(const NcWord& word, Meaning meaning);
  /// M codes that all dialects share: 0, 1, 3, 4, 5, 7, 8, 9 and, as ends of the program, 2 and 30.
  void set_m(const NcWord& word);
  void set_feed(const NcWord& word);
  void set_spindle_speed(const NcWord& word);
  void set_axis(std::size_t axis, double value);
  void set_dwell(double seconds);
  bool wants_dwell() const { return wants_dwell_; }
  /// \throw InputError for words that make no sense together
  void finish();

 private:
  const NcLines& lines_;
  NcBlock& block_;
  unsigned groups_ = 0;
  bool wants_dwell_ = false;
};

/// The index of an axis letter, or kNcAxes.
std::size_t axis_index(char letter);

}  // namespace retrace::fabrication
