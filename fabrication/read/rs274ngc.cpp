#include <fmt/format.h>

#include "core/message_text.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

using Code = IsoBlock::Code;

/// Modal groups of NISTIR 6556, table 4.
IsoBlock::Meaning rs274ngc_meaning_of(double g) {
  if (g == 0) return {Code::rapid, 1};
  if (g == 1) return {Code::linear, 1};
  if (g == 4) return {Code::dwell, 9};
  if (g == 17 || g == 18 || g == 19) return {Code::no_effect, 2};
  if (g == 20) return {Code::inch, 6};
  if (g == 21) return {Code::millimetre, 6};
  if (g == 40) return {Code::compensation_off, 7};
  if (g == 49) return {Code::compensation_off, 8};
  if (g == 54) return {Code::workpiece_offset, 12};
  if (g == 61 || g == 61.1) return {Code::exact_stop, 13};
  if (g == 64) return {Code::blending, 13};
  if (g == 80) return {Code::no_effect, 1};
  if (g == 90) return {Code::absolute, 3};
  if (g == 91) return {Code::incremental, 3};
  if (g == 92.1) return {Code::no_effect, 0};  // shifts of G92 cancelled
  if (g == 93) return {Code::inverse_time, 5};
  if (g == 94) return {Code::feed_per_minute, 5};
  if (g == 97) return {Code::no_effect, 14};  // S counts turns per minute
  return {};
}

/// The line without comments: ( ... ), which do not nest, and what follows a semicolon.
std::string without_rs274ngc_comments(std::string_view line, const NcLines& lines) {
  std::string result;
  while (!line.empty() && line.front() != ';') {
    if (line.front() == ')') lines.fail("has a ) without a (");
    if (line.front() != '(') {
      result += line.front();
      line.remove_prefix(1);
      continue;
    }
    const std::size_t end = line.find_first_of("()", 1);
    if (end == std::string_view::npos || line[end] == '(')
      lines.fail("has a comment that does not end, or a nested one");
    line.remove_prefix(end + 1);
  }
  return without_blanks(result);
}

class Rs274Reader {
 public:
  explicit Rs274Reader(NcLines lines) : lines_(std::move(lines)), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::rs274ngc;
  }

  NcProgram run() {
    std::string_view line;
    while (!is_over_ && lines_.next(line))
      read_line_that_may_be_cut(lines_, program_, [&] { read(without_rs274ngc_comments(line, lines_)); });
    program_.lines = lines_.number();
    program_.main_last = program_.blocks.size();
    // Of a file that stops within a subroutine there is no main program to carry out.
    if (open_ >= 0) program_.main_first = program_.main_last;
    if (open_ >= 0 && !program_.truncated) program_.truncated = "a subroutine has no endsub";
    if (percent_signs_ == 1 && !program_.truncated) program_.truncated = "the % at the end is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    if (text.empty()) return;
    if (text == "%") {
      is_over_ = ++percent_signs_ == 2;
      return;
    }
    if (text.front() == '/') lines_.fail("a line that a switch of the controller may leave out is not understood");
    skip_line_number(text);
    if (text.empty()) return;
    if (text.front() == 'O')
      read_o_word(text.substr(1));
    else
      read_words(text);
  }

  void skip_line_number(std::string_view& text) {
    if (text.front() != 'N') return;
    text.remove_prefix(1);
    if (!take_number(text, lines_).is_whole()) lines_.fail("a line number must be whole");
  }

  void read_o_word(std::string_view text) {
    const NcNumber number = take_number(text, lines_);
    if (!number.is_whole() || number.has_point) lines_.fail("a subroutine must have a whole number");
    const std::string name = fmt::format("{}", number.value);
    if (text == "SUB")
      begin(name);
    else if (text == "ENDSUB")
      end(name);
    else if (text == "CALL")
      call(name);
    else
      lines_.fail(fmt::format("o{} is followed by what is not understood, {}", name, in_quotes(text)));
  }

  void begin(const std::string& name) {
    if (open_ >= 0) lines_.fail("a subroutine must end before another begins");
    if (!is_before_main()) lines_.fail("a subroutine must stand before the main program");
    open_ = table_.index_of(name);
    if (table_.get(open_).is_whole) lines_.fail("there is a subroutine of that number already: " + name);
    table_.get(open_).first = program_.blocks.size();
  }

  void end(const std::string& name) {
    if (open_ < 0 || open_ != table_.index_of(name)) lines_.fail("endsub without its sub: " + name);
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.returns = true;
    table_.get(open_).last = program_.blocks.size();
    table_.get(open_).is_whole = true;
    program_.main_first = program_.blocks.size();
    open_ = -1;
  }

  void call(const std::string& name) {
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.call = table_.index_of(name);
  }

  bool is_before_main() const { return program_.blocks.size() == program_.main_first; }

  void read_words(std::string_view text) {
    NcBlock block;
    block.line = lines_.number();
    IsoBlock iso(lines_, block);
    while (!text.empty()) read_word(take_word(text, lines_), iso);
    iso.finish();
    program_.blocks.push_back(block);
  }

  void read_word(const NcWord& word, IsoBlock& iso) {
    const std::size_t axis = axis_index(word.letter);
    if (axis < kNcAxes) return iso.set_axis(axis, word.number.value);
    switch (word.letter) {
      case 'G':
        return iso.set_g(word, rs274ngc_meaning_of(word.number.value));
      case 'M':
        return iso.set_m(word);
      case 'F':
        return iso.set_feed(word);
      case 'P':
        return iso.set_dwell(word.number.value);  // seconds
      case 'S':
        return iso.set_spindle_speed(word);
      default:
        lines_.fail(fmt::format("a word {} is not understood", word.letter));
    }
  }

  NcLines lines_;
  NcProgram program_;
  SubroutineTable table_;
  std::int32_t open_ = -1;  ///< subroutine that is being read
  int percent_signs_ = 0;
  bool is_over_ = false;
};

}  // namespace

NcProgram parse_rs274ngc(NcLines lines) {
  return Rs274Reader(std::move(lines)).run();
}

}  // namespace retrace::fabrication
