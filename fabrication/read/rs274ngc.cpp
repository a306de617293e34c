#include <fmt/format.h>

#include <array>

#include "core/joined_arrays.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/iso_codes.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

using namespace nc_effects;

/// Effect of G94 on LinuxCNC. Each G94 sets the feed to 0, even if G94 is already active (interp_convert.cc,
/// convert_feed_mode). Other controls keep the feed.
constexpr auto kFeedPerMinuteFromZero = [](NcBlock& b) {
  kFeedPerMinute(b);
  b.clears_feed = true;
};
/// Effect of G80 on LinuxCNC: no motion mode is active afterwards (interp_convert.cc, convert_motion).
constexpr auto kNoMotion = [](NcBlock& b) { b.cancels_move = true; };

/// Modal groups of NISTIR 6556, table 4. G97 means that S is in rpm.
constexpr auto kRs274ngcCodes = joined(
    kCommonIsoCodes, std::array{NcCode{4, 9, nullptr}, NcCode{54, 12, kMarks<nc_setting::kWorkOffset>},
                                NcCode{61, 13, kExactStop}, NcCode{61.1, 13, kExactStop}, NcCode{64, 13, kBlending},
                                NcCode{80, 1, kNoMotion}, NcCode{92.1, 0, kMarks<nc_setting::kShiftOff>},
                                NcCode{94, 5, kFeedPerMinuteFromZero}, NcCode{97, 14, kNone}});

/// Returns the line up to the first semicolon, with a mark instead of each comment ( ... ). Comments cannot be nested.
std::string with_marked_rs274ngc_comments(std::string_view line, const NcLines& lines) {
  std::string result;
  while (!line.empty() && line.front() != ';') {
    if (line.front() == ')') lines.fail("a closing parenthesis has no opening parenthesis");
    if (line.front() != '(') {
      result += line.front();
      line.remove_prefix(1);
      continue;
    }
    const std::size_t end = line.find_first_of("()", 1);
    if (end == std::string_view::npos || line[end] == '(')
      lines.fail("a comment is not closed, or contains another comment");
    result += kNcCommentMark;
    line.remove_prefix(end + 1);
  }
  return without_blanks(result);
}

/// Maximum length of a line without its line end, for the interpreter of LinuxCNC 2.9 (tested with rs274).
constexpr std::size_t kLongestLine = 252;

class Rs274Reader {
 public:
  explicit Rs274Reader(NcLines lines) : lines_(std::move(lines)), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::rs274ngc;
  }

  NcProgram run() {
    std::string_view line;
    while (!is_over_ && lines_.next(line)) {
      if (line.size() > kLongestLine) lines_.fail(fmt::format("a line may have at most {} characters", kLongestLine));
      if (trimmed(line) == "%")
        read_percent();
      else
        read_line_that_may_be_cut(lines_, program_, [&] { read(with_marked_rs274ngc_comments(line, lines_)); });
      has_text_ = has_text_ || !trimmed(line).empty();
    }
    program_.lines = lines_.number();
    program_.main_last = program_.blocks.size();
    // A file that ends in a subroutine has no main program.
    if (table_.is_open()) program_.main_first = program_.main_last;
    if (table_.is_open() && !program_.truncated) program_.truncated = "a subroutine has no endsub";
    if (percent_signs_ == 1 && !program_.truncated) program_.truncated = "the % at the end is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    const bool has_comment_first = text.starts_with(kNcCommentMark);
    skip_comment_marks(text);
    if (text.empty()) return;
    if (has_comment_first && (text.front() == 'N' || text.front() == 'O'))
      lines_.fail("an N or O word must precede all comments of its line");
    if (text.front() == '/') lines_.fail("lines with block delete (/) are not supported");
    skip_line_number(text);
    if (text.empty()) return;
    if (text.front() == 'O')
      read_o_word(text.substr(1));
    else
      read_words(text);
  }

  /// Reads a line that contains only %. A program either has no such line, or begins and ends with one.
  void read_percent() {
    if (percent_signs_ == 0 && has_text_) lines_.fail("the first % must be located before all other text");
    is_over_ = ++percent_signs_ == 2;
  }

  void skip_line_number(std::string_view& text) {
    if (text.front() != 'N') return;
    text.remove_prefix(1);
    check_line_number(take_number(text, lines_), lines_);
  }

  void read_o_word(std::string_view text) {
    const NcNumber number = take_number(text, lines_);
    if (!number.is_integer() || number.has_point) lines_.fail("the number of a subroutine must be a whole number");
    const std::string name = fmt::format("{}", number.value);
    if (text == "SUB")
      begin(name);
    else if (text == "ENDSUB")
      end(name);
    else if (text == "CALL")
      call(name);
    else
      lines_.fail(fmt::format("o{} must be followed by sub, endsub or call, without other words", name));
  }

  void begin(const std::string& name) {
    if (table_.is_open()) lines_.fail("a subroutine must end before the next subroutine begins");
    if (!is_before_main()) lines_.fail("a subroutine must be located before the main program");
    if (!table_.begin(name)) lines_.fail("a subroutine with this number already exists: " + name);
  }

  void end(const std::string& name) {
    if (!table_.is_open(name)) lines_.fail("endsub must follow a sub with the same number: " + name);
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.returns = true;
    table_.end();
    program_.main_first = program_.blocks.size();
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
    words_ = {};
    for (; !text.empty(); skip_comment_marks(text)) read_word(take_word(text, lines_), iso);
    finish(iso, block);
    program_.blocks.push_back(block);
  }

  void read_word(const NcWord& word, IsoBlock& iso) {
    if (word.letter == 'P' || word.letter == 'Q') {
      Setting<double>& given = word.letter == 'P' ? words_.p : words_.q;
      if (given) lines_.fail(fmt::format("the word {} occurs twice in one line", word.letter));
      given = word.number.value;
    } else if (!iso.set(word, kRs274ngcCodes)) {
      lines_.fail_word(word.remainder);
    }
  }

  /// Ends a line. P is the time of a dwell in seconds, or the path tolerance of blending. Q is the tolerance for
  /// merging blocks in blending.
  void finish(IsoBlock& iso, NcBlock& block) {
    const bool blends = block.exact_stop == false;
    if (words_.p && !blends) iso.set_dwell(*words_.p);
    if (words_.q && !(blends && words_.p)) lines_.fail("Q is allowed only with G64 P");
    if (block.axes != 0 && (block.settings_made & nc_setting::kShiftOff) != 0)
      lines_.fail("G92.1 must not have axis words");
    const bool is_negative = words_.p.value_or(0.0) < 0.0 || words_.q.value_or(0.0) < 0.0;
    if (blends && is_negative) lines_.fail("the values P and Q of G64 must be >= 0");
    // P limits the deviation due to rounded corners, and Q the deviation due to merged blocks. Both may add up. Q
    // defaults to P.
    if (words_.p && blends) block.blend_mm = *words_.p + words_.q.value_or(*words_.p);
    iso.finish();
  }

  struct Words {
    Setting<double> p;
    Setting<double> q;
  };

  NcLines lines_;
  NcProgram program_;
  SubroutineTable table_;
  int percent_signs_ = 0;
  bool has_text_ = false;  ///< true if a line before the current one has text
  bool is_over_ = false;
  Words words_;  ///< P and Q words of the current line
};

}  // namespace

NcProgram parse_rs274ngc(NcLines lines, const NcTexts&) {
  return Rs274Reader(std::move(lines)).run();
}

}  // namespace retrace::fabrication
