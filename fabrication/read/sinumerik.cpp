#include <fmt/format.h>

#include <map>
#include <vector>

#include "core/message_text.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

using namespace nc_effects;

/// G codes and their groups in the Programming Manual Fundamentals, section Tables.
constexpr NcCode kSinumerikCodes[] = {
    {0, 1, kRapid},
    {1, 1, kLinear},
    {4, 2, nullptr},
    {17, 6, kNone},
    {18, 6, kNone},
    {19, 6, kNone},
    {40, 7, kMarks<nc_setting::kRadiusOff>},
    {54, 8, kMarks<nc_setting::kWorkOffset>},
    {60, 10, kExactStop},
    {64, 10, kBlending},
    {601, 12, kMarks<nc_setting::kFineStop>},
    {700, 13, kInch},
    {710, 13, kMillimetre},
    {90, 14, kAbsolute},
    {91, 14, kIncremental},
    {93, 15, kInverseTime},
    {94, 15, kFeedPerMinute},
};

/// Returns the line without its comment, which begins at the first semicolon outside of quotes.
std::string_view without_comment(std::string_view line) {
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') in_text = !in_text;
    if (line[i] == ';' && !in_text) return line.substr(0, i);
  }
  return line;
}

bool is_name(std::string_view text) {
  if (text.size() < 2 || text[0] < 'A' || text[0] > 'Z') return false;
  return text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") == std::string_view::npos;
}

class SinumerikReader {
 public:
  explicit SinumerikReader(NcLines lines) : lines_(std::move(lines)), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::sinumerik;
  }

  NcProgram run() {
    std::string_view line;
    while (lines_.next(line))
      read_line_that_may_be_cut(lines_, program_, [&] { read(trimmed(without_comment(line))); });
    program_.lines = lines_.number();
    program_.main_last = program_.blocks.size();
    resolve_sections();
    // The dialect has no mark for the end of a file. A last line without line end therefore indicates a truncated file.
    if (lines_.is_open_end() && !program_.truncated) program_.truncated = "the last line is incomplete";
    return std::move(program_);
  }

 private:
  /// Section of the program between two labels, including the blocks of both labels.
  struct Section {
    std::string first_label;
    std::string last_label;
  };

  void read(std::string_view text) {
    std::string capitals;
    for (const char c : text) capitals += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    text = capitals;
    skip_block_number(text);
    read_label(text);
    if (text.empty()) return;
    if (text.front() == '/') lines_.fail("lines with block delete (/) are not supported");
    if (text.starts_with("MSG(")) return check_message(text);
    if (starts_with_word(text, "REPEAT")) return read_repeat(trimmed(text.substr(6)));
    if (starts_with_word(text, "CALL")) return read_call(trimmed(text.substr(4)));
    read_words(text);
  }

  void skip_block_number(std::string_view& text) {
    if (text.size() < 2 || text[0] != 'N' || text[1] < '0' || text[1] > '9') return;
    text.remove_prefix(1);
    check_line_number(take_number(text, lines_), lines_);
    text = trimmed(text);
  }

  void read_label(std::string_view& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos || text.find('"') < colon) return;
    const std::string label(text.substr(0, colon));
    if (!is_name(label)) lines_.fail("a label is required, got " + in_quotes(label));
    if (!labels_.emplace(label, program_.blocks.size()).second)
      lines_.fail("a label with this name already exists: " + label);
    text = trimmed(text.substr(colon + 1));
    // The words after a label belong to its block. A label without words gets an empty block, so that a section can end
    // there.
    if (text.empty() || text.starts_with("MSG(")) program_.blocks.emplace_back().line = lines_.number();
  }

  void check_message(std::string_view text) const {
    const bool is_empty = text == "MSG()";
    const bool is_text = text.starts_with("MSG(\"") && text.ends_with("\")") && text.size() >= 7 &&
                         text.substr(5, text.size() - 7).find('"') == std::string_view::npos;
    if (!is_empty && !is_text) lines_.fail("MSG must have one text between quotes");
  }

  void read_call(std::string_view text) {
    const auto refuse = [&] { lines_.fail("a call must have the form CALL BLOCK label TO label"); };
    if (!starts_with_word(text, "BLOCK")) refuse();
    text = trimmed(text.substr(5));
    const std::size_t to = text.find(" TO ");
    if (to == std::string_view::npos) refuse();
    const std::string first(trimmed(text.substr(0, to)));
    const std::string last(trimmed(text.substr(to + 4)));
    if (!is_name(first) || !is_name(last)) refuse();
    call(first, last);
  }

  void read_repeat(std::string_view text) {
    const std::size_t gap = text.find(' ');
    const std::string first(text.substr(0, gap));
    const std::string last(gap == std::string_view::npos ? text : trimmed(text.substr(gap)));
    // REPEAT with one label would repeat the program up to this call, without end.
    if (gap == std::string_view::npos || !is_name(first) || !is_name(last))
      lines_.fail("a repetition must have the form REPEAT label label");
    call(first, last);
  }

  void call(const std::string& first, const std::string& last) {
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.call = table_.index_of(first + " TO " + last);
    if (sections_.size() < program_.subroutines.size()) sections_.push_back({first, last});
  }

  void read_words(std::string_view text) {
    NcBlock block;
    block.line = lines_.number();
    IsoBlock iso(lines_, block);
    Setting<NcWord> feed;
    while (!text.empty()) {
      if (starts_with_word(text, "TRAFOOF")) {
        block.mark_setting(nc_setting::kTransformationOff);
        text = trimmed(text.substr(7));
        continue;
      }
      // TRANS without words cancels programmed frames. TRANS with words, which would shift the zero, is not supported.
      if (text == "TRANS") {
        block.mark_setting(nc_setting::kShiftOff);
        text = {};
        continue;
      }
      const NcWord word = take_assignment(text, block);
      if (word.letter == 'F') {
        if (feed) lines_.fail("the word F occurs twice in one line");
        feed = word;
      } else {
        read_word(word, iso, block);
      }
    }
    // In a line with G4, F is the dwell time in seconds and does not change the feed.
    if (feed && iso.expects_dwell_time())
      iso.set_dwell(feed->number.value);
    else if (feed)
      iso.set_feed(*feed);
    iso.finish();
    program_.blocks.push_back(block);
  }

  /// Reads an axis word: X1.5 or X=1.5. C=DC(1.5) moves a rotary axis along the shortest path. X=IC(1.5) is an
  /// increment.
  NcWord take_assignment(std::string_view& text, NcBlock& block) {
    if (text.size() > 5 && text[1] == '=' && (text.substr(2, 3) == "DC(" || text.substr(2, 3) == "IC(")) {
      const std::size_t axis = axis_index(text[0]);
      const bool is_shortest = text[2] == 'D';
      if (axis == kNcAxes || (is_shortest && axis < kFirstRotaryAxis)) lines_.fail_word(text);
      NcWord word{text[0], {}, text};
      text.remove_prefix(5);
      word.number = take_number(text, lines_);
      if (!text.starts_with(')')) lines_.fail("an opening parenthesis is not closed");
      text = trimmed(text.substr(1));
      constexpr double turn_deg = 360.0;
      if (is_shortest && !(word.number.value >= 0.0 && word.number.value < turn_deg))
        lines_.fail(fmt::format("DC must be within 0 and 360 degrees, got {}", word.number.value));
      std::uint8_t& bits = is_shortest ? block.shortest : block.increments;
      bits = static_cast<std::uint8_t>(bits | 1U << axis);
      return word;
    }
    if (text.size() > 2 && text[1] == '=') {
      const std::string joined = std::string(1, text[0]) + std::string(text.substr(2));
      std::string_view rest = joined;
      if (!begins_with_number(rest.substr(1))) lines_.fail_word(text);
      NcWord word = take_word(rest, lines_);
      word.remainder = text;
      text = trimmed(text.substr(text.size() - rest.size()));
      return word;
    }
    const NcWord word = take_word(text, lines_);
    text = trimmed(text);
    return word;
  }

  void read_word(const NcWord& word, IsoBlock& iso, NcBlock& block) {
    if (word.letter == 'D') {
      if (word.number.value != 0) lines_.fail("D must be 0, because tool offsets are not supported");
      block.mark_setting(nc_setting::kLengthOff);
    } else if (!iso.set(word, kSinumerikCodes)) {
      lines_.fail_word(word.remainder);
    }
  }

  void resolve_sections() {
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      const auto first = labels_.find(sections_[i].first_label);
      const auto last = labels_.find(sections_[i].last_label);
      if (first == labels_.end() || last == labels_.end() || last->second < first->second) continue;
      // If a file ends in the line of a label, the label exists but its block does not.
      if (last->second >= program_.blocks.size()) continue;
      program_.subroutines[i].first = first->second;
      program_.subroutines[i].last = last->second + 1;
      program_.subroutines[i].is_complete = true;
    }
  }

  NcLines lines_;
  NcProgram program_;
  SubroutineTable table_;
  std::map<std::string, std::size_t, std::less<>> labels_;
  std::vector<Section> sections_;  ///< section of each subroutine, in the order of the subroutines
};

}  // namespace

NcProgram parse_sinumerik(NcLines lines, const NcTexts&) {
  return SinumerikReader(std::move(lines)).run();
}

}  // namespace retrace::fabrication
