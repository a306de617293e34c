#include <fmt/format.h>

#include <charconv>

#include "core/message_text.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

/// Removes a name, which consists of capital letters and underscores, from the front of `text` and returns it.
std::string_view take_name(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && ((text[end] >= 'A' && text[end] <= 'Z') || text[end] == '_')) ++end;
  const std::string_view name = text.substr(0, end);
  text.remove_prefix(end);
  return name;
}

class PmacReader {
 public:
  PmacReader(NcLines lines, const NcTexts& texts) : lines_(std::move(lines)), texts_(texts), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::pmac;
  }

  NcProgram run() {
    std::string_view line;
    while (lines_.next(line))
      if (!take_text(trimmed(line), texts_, is_in_main_ ? "" : "a line must be inside of open prog ... close", lines_,
                     program_))
        read_line_that_may_be_cut(lines_, program_, [&] { read(line.substr(0, line.find("//"))); });
    program_.lines = lines_.number();
    if (is_in_main_) end_main();
    if ((is_in_main_ || table_.is_open() || !has_main_) && !program_.truncated)
      program_.truncated = "the line close is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view line) {
    const std::string capitals = in_capitals(trimmed(line));
    std::string_view text = capitals;
    if (text.empty()) return;
    if (starts_with_word(text, "OPEN")) return open(trimmed(text.substr(4)));
    if (text == "CLOSE") return close();
    if (!is_in_main_ && !table_.is_open()) lines_.fail("each line must be located between open and close");
    NcBlock block;
    block.line = lines_.number();
    IsoBlock iso(lines_, block);
    if (text.starts_with("PVT")) {
      read_cubic(text.substr(3), iso, block);
      text = {};
    }
    while (!text.empty()) {
      read_statement(text, iso, block);
      text = trimmed(text);
    }
    if (block.dwell_s && (block.axes != 0 || block.move)) lines_.fail("dwell must be alone in its line");
    if (block.call >= 0 && block.axes != 0) lines_.fail("a call must not move axes");
    program_.blocks.push_back(block);
  }

  void open(std::string_view text) {
    if (is_in_main_ || table_.is_open()) lines_.fail("open is not allowed between open and close");
    const bool is_main = starts_with_word(text, "PROG");
    if (!is_main && !starts_with_word(text, "SUBPROG")) lines_.fail("open must be followed by prog or subprog");
    text = trimmed(text.substr(is_main ? 4 : 7));
    const std::string name = whole_number(text);
    if (!text.empty()) lines_.fail_word(text);
    if (is_main && has_main_) lines_.fail("a file must contain only one program");
    if (is_main) {
      has_main_ = is_in_main_ = true;
      program_.main_first = program_.blocks.size();
      return;
    }
    if (!table_.begin(name)) lines_.fail("a subprogram with this number already exists: " + name);
  }

  void close() {
    if (!is_in_main_ && !table_.is_open()) lines_.fail("close must follow an open");
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.ends = is_in_main_;
    block.returns = !is_in_main_;
    if (is_in_main_) {
      end_main();
      is_in_main_ = false;
      return;
    }
    table_.end();
  }

  void end_main() { program_.main_last = program_.blocks.size(); }

  std::string whole_number(std::string_view& text) {
    const NcNumber number = take_number(text, lines_);
    if (!number.is_integer() || number.has_point || number.value < 0)
      lines_.fail("the number of a program must be a whole number >= 0");
    return fmt::format("{}", number.value);
  }

  void read_statement(std::string_view& text, IsoBlock& iso, NcBlock& block) {
    if (text.starts_with("COORD[")) return read_coordinate_system(text, block);
    const std::string_view whole = text;
    const std::string_view name = take_name(text);
    if (name.size() == 1) {
      text = whole;
      return read_word(take_word(text, lines_), iso);
    }
    if (name == "RAPID")
      block.move = NcMove::rapid;
    else if (name == "LINEAR")
      block.move = NcMove::linear;
    else if (name == "ABS" || name == "INC")
      set_distance(name == "ABS", block);
    else if (name == "DWELL")
      iso.set_dwell(number_behind(text) / 1000.0);
    else if (name == "TM")
      read_move_time(text, block);
    else if (name == "TA" || name == "TS")
      read_ramp(text);
    else if (name == "CALL")
      read_call(text, block);
    else if (name == "FRAX")
      read_feed_axes(text, block);
    else if (name == "CCMODE" && number_behind(text) == 0)
      block.mark_setting(nc_setting::kRadiusOff);
    else
      lines_.fail_word(whole);
  }

  /// Reads a PVT line: a time in ms, then positions and velocities. The control would also accept lines without PVT or
  /// without velocities, but this reader requires complete lines.
  void read_cubic(std::string_view text, IsoBlock& iso, NcBlock& block) {
    NcCubic cubic;
    cubic.time_s = number_behind(text) / 1000.0;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
      const NcWord word = take_word(text, lines_);
      const std::size_t axis = axis_index(word.letter);
      if (axis == kNcAxes || !text.starts_with(':')) lines_.fail("PVT must contain position:velocity for each axis");
      text.remove_prefix(1);
      iso.set_cubic(axis, word.number, take_number(text, lines_).value, cubic);
    }
    if (block.axes == 0) lines_.fail("PVT must have axes on the same line");
    program_.set_cubic(block, cubic);
  }

  void set_distance(bool absolute, NcBlock& block) {
    if (block.absolute) lines_.fail("abs or inc occurs twice in one line");
    block.absolute = absolute;
  }

  /// Reads TM, the time of a move in ms.
  void read_move_time(std::string_view& text, NcBlock& block) {
    if (block.move_time_s) lines_.fail("the line contains two times for one move");
    text = trimmed(text);
    const NcNumber ms = take_number(text, lines_);
    if (!(ms.value > 0.0)) lines_.fail(fmt::format("TM must be > 0, got {}", ms.value));
    block.move_time_s = ms.value / 1000.0;
    block.rate_rounding = ms.relative_rounding();
  }

  /// Reads TA or TS, the acceleration times. They must be 0, because other values would round the path.
  void read_ramp(std::string_view& text) {
    if (number_behind(text) != 0.0) lines_.fail("TA and TS must be 0, because ramps between moves are not supported");
  }

  double number_behind(std::string_view& text) {
    text = trimmed(text);
    return take_number(text, lines_).value;
  }

  void read_call(std::string_view& text, NcBlock& block) {
    text = trimmed(text);
    if (block.call >= 0) lines_.fail("the line contains two calls");
    block.call = table_.index_of(whole_number(text));
  }

  /// Reads frax, the axes to which feeds apply. They must be the three linear axes.
  void read_feed_axes(std::string_view& text, NcBlock& block) {
    constexpr std::string_view all = "(X,Y,Z)";
    if (!text.starts_with(all)) lines_.fail("frax must contain the axes X, Y and Z");
    text.remove_prefix(all.size());
    block.mark_setting(nc_setting::kFeedAxes);
  }

  void read_coordinate_system(std::string_view& text, NcBlock& block) {
    text.remove_prefix(6);
    const std::string number = whole_number(text);
    if (coordinate_system_.empty()) coordinate_system_ = number;
    if (number != coordinate_system_)
      lines_.fail("the program uses a second coordinate system, but only one is supported");
    std::from_chars(number.data(), number.data() + number.size(), program_.coordinate_system);
    if (!text.starts_with("].")) lines_.fail("Coord must be followed by [number] and a point");
    text.remove_prefix(2);
    const std::string_view name = take_name(text);
    if (!text.starts_with('=')) lines_.fail("a setting must be followed by = and a number");
    text.remove_prefix(1);
    const double value = take_number(text, lines_).value;
    if (name == "NOBLEND" && (value == 0 || value == 1))
      block.exact_stop = value == 1;
    else if (name == "FEEDTIME" && value > 0)
      block.feed_time_s = value / 1000.0;  // the value is in ms
    else if (name == "SEGMOVETIME" && value == 0)
      block.mark_setting(
          nc_setting::kTransformationOff);  // without segmentation, the control applies no kinematic transformation
    else
      lines_.fail("Coord[" + number + "]." + printable(name) + " is not supported with this value");
  }

  void read_word(const NcWord& word, IsoBlock& iso) {
    if (word.letter == 'G' || word.letter == 'S' || !iso.set(word, {})) lines_.fail_word(word.remainder);
  }

  NcLines lines_;
  const NcTexts& texts_;
  NcProgram program_;
  SubroutineTable table_;
  std::string coordinate_system_;  ///< number of the coordinate system that the program sets
  bool is_in_main_ = false;
  bool has_main_ = false;
};

}  // namespace

NcProgram parse_pmac(NcLines lines, const NcTexts& texts) {
  return PmacReader(std::move(lines), texts).run();
}

}  // namespace retrace::fabrication
