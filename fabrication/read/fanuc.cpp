#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/joined_arrays.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/iso_codes.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

using namespace nc_effects;

/// G codes and their groups in the operator's manual: G code system B of lathes, and the G codes of machining centres.
/// G97 means that S is in rpm.
constexpr auto kFanucCodes =
    joined(kCommonIsoCodes, std::array{NcCode{4, 0, nullptr}, NcCode{54, 14, kMarks<nc_setting::kWorkOffset>},
                                       NcCode{61, 15, kExactStop}, NcCode{64, 15, kBlending},
                                       NcCode{50.1, 18, kMarks<nc_setting::kMirrorOff>},
                                       NcCode{69, 16, kMarks<nc_setting::kRotationOff>}, NcCode{80, 9, kNone},
                                       NcCode{94, 5, kFeedPerMinute}, NcCode{97, 17, kNone}});

/// Returns the line with a mark instead of each comment ( ... ).
std::string with_marked_comments(std::string_view line, const NcLines& lines) {
  std::string result;
  while (!line.empty()) {
    const std::size_t open = line.find('(');
    result += line.substr(0, open);
    if (open == std::string_view::npos) break;
    result += kNcCommentMark;
    const std::size_t close = line.find(')', open);
    if (close == std::string_view::npos) lines.fail("a comment is not closed");
    line.remove_prefix(close + 1);
  }
  return without_blanks(result);
}

/// Line of words. It contains a block, and may contain the call of a subprogram or a return.
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
      read_line_that_may_be_cut(lines_, program_, [&] { read(with_marked_comments(line, lines_)); });
    program_.lines = lines_.number();
    close_part();
    if (table_.is_open() && !program_.truncated) program_.truncated = "a subprogram has no M99";
    if (percent_signs_ == 1 && !program_.truncated) program_.truncated = "the % at the end is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    skip_comment_marks(text);
    if (text.empty()) return;
    if (text == "%") {
      ++percent_signs_;
      return;
    }
    if (text.front() == '/') lines_.fail("lines with block delete (/) are not supported");
    if (text.front() == 'O') return begin_program(text.substr(1));
    if (!has_main_) lines_.fail("no line may precede the program number, such as O1");
    Line line;
    line.block.line = lines_.number();
    IsoBlock iso(lines_, line.block);
    for (; !text.empty(); skip_comment_marks(text)) read_word(take_word(text, lines_), iso, line);
    finish(iso, line);
  }

  void begin_program(std::string_view text) {
    const NcNumber number = take_number(text, lines_);
    if (!number.is_integer() || number.has_point || !text.empty())
      lines_.fail("O must have a whole number and be alone in its line");
    if (table_.is_open()) lines_.fail("a subprogram must end with M99 before the next subprogram begins");
    close_part();
    if (has_main_ && !table_.begin(fmt::format("{}", number.value)))
      lines_.fail(fmt::format("a program O{} already exists", number.value));
    has_main_ = true;
  }

  /// Ends the main program at the beginning of the first subprogram.
  void close_part() {
    if (!main_is_closed_) program_.main_last = program_.blocks.size();
    main_is_closed_ = main_is_closed_ || has_main_;
  }

  void read_word(const NcWord& word, IsoBlock& iso, Line& line) {
    if (axis_index(word.letter) < kNcAxes && !word.number.has_point)
      lines_.fail(fmt::format(
          "the number of {} must have a decimal point: without it, the control reads the number in least increments",
          word.letter));
    if (axis_index(word.letter) < kNcAxes) line.block.decimals = std::max(line.block.decimals, word.number.decimals);
    if (word.letter == 'N') return check_line_number(word.number, lines_);
    if (word.letter == 'P') {
      if (line.p) lines_.fail("the word P occurs twice in one line");
      line.p = word.number.value;
      line.p_has_point = word.number.has_point;
    } else if (word.letter == 'M' && word.number.value == 98) {
      line.has_call = true;
    } else if (word.letter == 'M' && word.number.value == 99) {
      line.has_return = true;
    } else if (!iso.set(word, kFanucCodes)) {
      lines_.fail_word(word.remainder);
    }
  }

  void finish(IsoBlock& iso, Line& line) {
    if (iso.expects_dwell_time() && line.p) {
      if (line.p_has_point) lines_.fail("P of a dwell is in milliseconds and must not have a decimal point");
      iso.set_dwell(*line.p / 1000.0);
    }
    // The axis words of G50.1 select axes, but do not move them.
    if ((line.block.settings_made & nc_setting::kMirrorOff) != 0) line.block.axes = 0;
    iso.finish();
    if ((line.has_call || line.has_return) && line.block.axes != 0) lines_.fail("a call or return must not move axes");
    if (line.p && !iso.expects_dwell_time() && !line.has_call) lines_.fail("P is allowed only with G4 or M98");
    if (line.has_call) set_call(line);
    if (line.has_return) set_return(line.block);
    program_.blocks.push_back(line.block);
    if (line.has_return) table_.end();
  }

  void set_call(Line& line) {
    constexpr double most = 9999;
    if (!line.p || line.p_has_point || *line.p < 1 || *line.p > most)
      lines_.fail("M98 requires P with a number from 1 to 9999");
    line.block.call = table_.index_of(fmt::format("{}", *line.p));
  }

  void set_return(NcBlock& block) {
    if (!table_.is_open())
      lines_.fail("M99 is allowed only in a subprogram; elsewhere, it would repeat the program endlessly");
    block.returns = true;
  }

  NcLines lines_;
  NcProgram program_;
  SubroutineTable table_;
  int percent_signs_ = 0;
  bool has_main_ = false;
  bool main_is_closed_ = false;
};

}  // namespace

NcProgram parse_fanuc(NcLines lines, const NcTexts&) {
  return FanucReader(std::move(lines)).run();
}

}  // namespace retrace::fabrication
