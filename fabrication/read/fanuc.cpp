#include <fmt/format.h>

#include "core/message_text.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

using Code = IsoBlock::Code;

/// Groups of the operator's manual, G code system B of lathes and that of machining centres.
IsoBlock::Meaning fanuc_meaning_of(double g) {
  if (g == 0) return {Code::rapid, 1};
  if (g == 1) return {Code::linear, 1};
  if (g == 4) return {Code::dwell, 0};
  if (g == 17 || g == 18 || g == 19) return {Code::no_effect, 2};
  if (g == 20) return {Code::inch, 6};
  if (g == 21) return {Code::millimetre, 6};
  if (g == 40) return {Code::compensation_off, 7};
  if (g == 49) return {Code::compensation_off, 8};
  if (g == 54) return {Code::workpiece_offset, 14};
  if (g == 61) return {Code::exact_stop, 15};
  if (g == 64) return {Code::blending, 15};
  if (g == 69) return {Code::no_effect, 16};  // turned coordinates cancelled
  if (g == 80) return {Code::no_effect, 9};
  if (g == 90) return {Code::absolute, 3};
  if (g == 91) return {Code::incremental, 3};
  if (g == 93) return {Code::inverse_time, 5};
  if (g == 94) return {Code::feed_per_minute, 5};
  if (g == 97) return {Code::no_effect, 17};  // S counts turns per minute
  return {};
}

/// The line without its comments ( ... ).
std::string without_comments(std::string_view line, const NcLines& lines) {
  std::string result;
  while (!line.empty()) {
    const std::size_t open = line.find('(');
    result += line.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = line.find(')', open);
    if (close == std::string_view::npos) lines.fail("has a comment that does not end");
    line.remove_prefix(close + 1);
  }
  return without_blanks(result);
}

/// One line of words: a block, and how it leads to another program.
struct Line {
  NcBlock block;
  bool has_call = false;
  bool has_return = false;
  Setting<double> p;
  bool p_has_point = false;
};

class FanucReader {
 public:
  explicit FanucReader(NcLines lines) : lines_(std::move(lines)), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::fanuc;
  }

  NcProgram run() {
    std::string_view line;
    while (percent_signs_ < 2 && lines_.next(line))
      read_line_that_may_be_cut(lines_, program_, [&] { read(without_comments(line, lines_)); });
    program_.lines = lines_.number();
    close_part();
    if (open_ >= 0 && !program_.truncated) program_.truncated = "a subprogram has no M99";
    if (percent_signs_ == 1 && !program_.truncated) program_.truncated = "the % at the end is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    if (text.empty()) return;
    if (text == "%") {
      ++percent_signs_;
      return;
    }
    if (text.front() == '/') lines_.fail("a line that a switch of the controller may leave out is not understood");
    if (text.front() == 'O') return begin_program(text.substr(1));
    Line line;
    line.block.line = lines_.number();
    IsoBlock iso(lines_, line.block);
    while (!text.empty()) read_word(take_word(text, lines_), iso, line);
    finish(iso, line);
  }

  void begin_program(std::string_view text) {
    const NcNumber number = take_number(text, lines_);
    if (!number.is_whole() || number.has_point || !text.empty())
      lines_.fail("O must have a whole number and stand alone");
    if (open_ >= 0) lines_.fail("a subprogram must end with M99 before another begins");
    close_part();
    if (has_main_) {
      const std::int32_t index = table_.index_of(fmt::format("{}", number.value));
      if (table_.get(index).is_whole) lines_.fail(fmt::format("there is a program O{} already", number.value));
      table_.get(index).first = program_.blocks.size();
      open_ = index;
    }
    has_main_ = true;
  }

  /// Ends the main program where the first subprogram begins.
  void close_part() {
    if (!main_is_closed_) program_.main_last = program_.blocks.size();
    main_is_closed_ = main_is_closed_ || has_main_;
  }

  void read_word(const NcWord& word, IsoBlock& iso, Line& line) {
    const std::size_t axis = axis_index(word.letter);
    if (axis < kNcAxes) {
      if (!word.number.has_point)
        lines_.fail(fmt::format("{} needs a decimal point: without one it counts least increments", word.letter));
      return iso.set_axis(axis, word.number.value);
    }
    switch (word.letter) {
      case 'N':
        return;
      case 'G':
        return iso.set_g(word, fanuc_meaning_of(word.number.value));
      case 'M':
        return read_m(word, iso, line);
      case 'F':
        return iso.set_feed(word);
      case 'P':
        if (line.p) lines_.fail("has two words P");
        line.p = word.number.value;
        line.p_has_point = word.number.has_point;
        return;
      case 'S':
        return iso.set_spindle_speed(word);
      default:
        lines_.fail(fmt::format("a word {} is not understood", word.letter));
    }
  }

  void read_m(const NcWord& word, IsoBlock& iso, Line& line) {
    if (word.number.value == 98)
      line.has_call = true;
    else if (word.number.value == 99)
      line.has_return = true;
    else
      iso.set_m(word);
  }

  void finish(IsoBlock& iso, Line& line) {
    if (iso.wants_dwell() && line.p) {
      if (line.p_has_point) lines_.fail("P of a dwell counts milliseconds and takes no decimal point");
      iso.set_dwell(*line.p / 1000.0);
    }
    iso.finish();
    if ((line.has_call || line.has_return) && line.block.axes != 0) lines_.fail("a call or return must not move axes");
    if (line.p && !iso.wants_dwell() && !line.has_call) lines_.fail("P is not understood here");
    if (line.has_call) set_call(line);
    if (line.has_return) set_return(line.block);
    program_.blocks.push_back(line.block);
    if (line.has_return) end_subprogram();
  }

  void set_call(Line& line) {
    constexpr double most = 9999;
    if (!line.p || line.p_has_point || *line.p < 1 || *line.p > most)
      lines_.fail("M98 needs P with a number from 1 to 9999");
    line.block.call = table_.index_of(fmt::format("{}", *line.p));
  }

  void set_return(NcBlock& block) {
    if (open_ < 0) lines_.fail("M99 outside of a subprogram would run the program again without end");
    block.returns = true;
  }

  void end_subprogram() {
    table_.get(open_).last = program_.blocks.size();
    table_.get(open_).is_whole = true;
    open_ = -1;
  }

  NcLines lines_;
  NcProgram program_;
  SubroutineTable table_;
  std::int32_t open_ = -1;
  int percent_signs_ = 0;
  bool has_main_ = false;
  bool main_is_closed_ = false;
};

}  // namespace

NcProgram parse_fanuc(NcLines lines) {
  return FanucReader(std::move(lines)).run();
}

}  // namespace retrace::fabrication
