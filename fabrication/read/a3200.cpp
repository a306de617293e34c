#include <algorithm>

#include "core/message_text.h"
#include "fabrication/read/aerotech_codes.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

/// AeroBasic statement that must be the only text of its line and has the effect of a G code.
struct A3200Statement {
  std::string_view words;
  void (*effect)(NcBlock&) = nullptr;
};
constexpr A3200Statement kA3200Statements[] = {
    {"ABSOLUTE", nc_effects::kAbsolute},
    {"INCREMENTAL", nc_effects::kIncremental},
    {"METRIC", nc_effects::kMillimetre},
    {"ENGLISH", nc_effects::kInch},
    {"MINUTES", kAerotechFeedTime<60>},
    {"SECONDS", kAerotechFeedTime<1>},
    {"VELOCITY ON", nc_effects::kBlending},
    {"VELOCITY OFF", nc_effects::kExactStop},
    {"WAIT MODE INPOS", nc_effects::kMarks<nc_setting::kFineStop>},
};

/// Returns the line without its comment, which begins with //, ' or ;.
std::string_view without_a3200_comment(std::string_view line) {
  return line.substr(0, std::min({line.find("//"), line.find('\''), line.find(';')}));
}

/// Returns `text` in capitals, with a single blank instead of each sequence of blanks and tabs.
std::string with_single_blanks(std::string_view text) {
  std::string result = in_capitals(trimmed(text));
  std::replace(result.begin(), result.end(), '\t', ' ');
  const auto is_gap = [](char a, char b) { return a == ' ' && b == ' '; };
  result.erase(std::unique(result.begin(), result.end(), is_gap), result.end());
  return result;
}

class A3200Reader {
 public:
  A3200Reader(NcLines lines, const NcTexts& texts) : lines_(std::move(lines)), texts_(texts), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::a3200;
  }

  NcProgram run() {
    std::string_view line;
    while (lines_.next(line))
      if (!take_text(trimmed(line), texts_, is_over_ ? "no line may follow the end of the program" : "", lines_,
                     program_))
        read_line_that_may_be_cut(lines_, program_, [&] { read(with_single_blanks(without_a3200_comment(line))); });
    program_.lines = lines_.number();
    if (!is_over_) program_.main_last = program_.blocks.size();
    if (!is_over_ && !program_.truncated) program_.truncated = "the line END PROGRAM is missing";
    if (table_.is_open() && !program_.truncated) program_.truncated = "a subroutine has no ENDDFS";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    skip_line_number(text);
    if (text.empty()) return;
    if (text == "PROGRAM" && program_.blocks.empty()) return;
    if (text == "END PROGRAM") return end_program();
    if (text == "ENDDFS") return end_subroutine();
    if (starts_with_word(text, "DFS")) return begin_subroutine(trimmed(text.substr(3)));
    if (is_over_ && !table_.is_open()) lines_.fail("no line may follow the end of the program");
    NcBlock block;
    block.line = lines_.number();
    if (starts_with_word(text, "CALL"))
      block.call = table_.index_of(name_in(trimmed(text.substr(4))));
    else
      read_statement(text, block);
    program_.blocks.push_back(block);
    if (block.ends && !table_.is_open()) end_main();
  }

  void skip_line_number(std::string_view& text) {
    if (text.size() < 2 || text[0] != 'N' || text[1] < '0' || text[1] > '9') return;
    text.remove_prefix(1);
    check_line_number(take_number(text, lines_), lines_);
    text = trimmed(text);
  }

  void read_statement(std::string_view text, NcBlock& block) {
    for (const A3200Statement& statement : kA3200Statements)
      if (text == statement.words) return statement.effect(block);
    if (starts_with_word(text, "WAIT")) lines_.fail("the wait mode must be set by WAIT MODE INPOS");
    IsoBlock iso(lines_, block);
    if (starts_with_word(text, "PVT")) return read_cubic(text, iso, block);
    if (starts_with_word(text, "DWELL")) {
      text = trimmed(text.substr(5));
      iso.set_dwell(take_number(text, lines_).value);
      if (!text.empty()) lines_.fail("DWELL must be followed by one time in seconds");
      return;
    }
    const bool is_rapid = starts_with_word(text, "RAPID");
    if (is_rapid || starts_with_word(text, "LINEAR")) {
      block.move = is_rapid ? NcMove::rapid : NcMove::linear;
      text = text.substr(is_rapid ? 5 : 6);
    }
    const std::string packed = without_blanks(text);
    for (std::string_view rest = packed; !rest.empty();) take_aerotech_word(take_word(rest, lines_), iso, lines_);
    iso.finish();
  }

  /// Reads a line such as PVT X 1,0.5 C 2,3 TIME 4: position and velocity of each axis, and the time since PVT INIT
  /// TIME ABS.
  void read_cubic(std::string_view text, IsoBlock& iso, NcBlock& block) {
    if (text == "PVT INIT TIME ABS") {
      block.begins_cubics = true;
      return;
    }
    if (text.starts_with("PVT INIT")) lines_.fail("the time of PVT moves must be set by PVT INIT TIME ABS");
    NcCubic cubic;
    const std::string packed = without_blanks(text.substr(3));
    std::string_view rest = packed;
    while (!rest.empty() && !rest.starts_with("TIME")) {
      const NcWord word = take_word(rest, lines_);
      const std::size_t axis = axis_index(word.letter);
      if (axis == kNcAxes || !rest.starts_with(',')) lines_.fail("PVT must contain position,velocity for each axis");
      rest.remove_prefix(1);
      iso.set_cubic(axis, word.number, take_number(rest, lines_).value, cubic);
    }
    if (rest.empty() || block.axes == 0) lines_.fail("PVT must contain at least one axis and a TIME");
    rest.remove_prefix(4);
    cubic.time_s = take_number(rest, lines_).value;
    if (!rest.empty()) lines_.fail("PVT must end with its TIME");
    program_.set_cubic(block, cubic);
  }

  std::string name_in(std::string_view text) const {
    if (!is_aerotech_name(text))
      lines_.fail("DFS must be followed by the name of a subroutine, got " + in_quotes(text));
    return std::string(text);
  }

  void begin_subroutine(std::string_view text) {
    if (table_.is_open()) lines_.fail("a subroutine must end before the next subroutine begins");
    if (!is_over_) lines_.fail("subroutines must be located after END PROGRAM");
    const std::string name = name_in(text);
    if (!table_.begin(name)) lines_.fail("a subroutine with this name already exists: " + name);
  }

  void end_subroutine() {
    if (!table_.is_open()) lines_.fail("ENDDFS must follow a DFS");
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.returns = true;
    table_.end();
  }

  void end_program() {
    if (table_.is_open() || has_end_program_)
      lines_.fail("END PROGRAM is allowed only one time, at the end of the main program");
    has_end_program_ = true;
    if (is_over_) return;
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.ends = true;
    end_main();
  }

  void end_main() {
    is_over_ = true;
    program_.main_last = program_.blocks.size();
  }

  NcLines lines_;
  const NcTexts& texts_;
  NcProgram program_;
  SubroutineTable table_;
  bool is_over_ = false;  ///< true after the end of the main program
  bool has_end_program_ = false;
};

}  // namespace

NcProgram parse_a3200(NcLines lines, const NcTexts& texts) {
  return A3200Reader(std::move(lines), texts).run();
}

}  // namespace retrace::fabrication
