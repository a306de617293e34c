#include "fabrication/read/nc_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/leading_number.h"
#include "core/message_text.h"

namespace retrace::fabrication {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f;
}

/// M codes. The numbers of their modal groups are larger than the group numbers of all G codes. M8 (flood coolant) has
/// no effect on the mist.
constexpr NcCode kMCodes[] = {{0, 28, [](NcBlock& b) { b.stop = NcStop::always; }},
                              {1, 28, [](NcBlock& b) { b.stop = NcStop::optional; }},
                              {2, 28, [](NcBlock& b) { b.ends = true; }},
                              {3, 29, [](NcBlock& b) { b.spindle = NcSpindle::clockwise; }},
                              {4, 29, [](NcBlock& b) { b.spindle = NcSpindle::counterclockwise; }},
                              {5, 29, [](NcBlock& b) { b.spindle = NcSpindle::stopped; }},
                              {7, 30, [](NcBlock& b) { b.mist_on = true; }},
                              {8, 30, nc_effects::kNone},
                              {9, 30, [](NcBlock& b) { b.mist_on = false; }},
                              {30, 28, [](NcBlock& b) { b.ends = true; }}};

/// Returns true if `line` begins with the text of `rest`, up to the next comment mark in `rest`. Blanks, and
/// differences between capital and small letters, are ignored.
bool is_same_text(std::string_view line, std::string_view rest) {
  if (line.empty() || line.front() == ' ' || line.front() == '\t') return false;
  for (;; line.remove_prefix(1), rest.remove_prefix(1)) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (rest.empty() || rest.front() == kNcCommentMark) return true;
    if (line.empty() || capital(line.front()) != capital(rest.front())) return false;
  }
}

/// Returns the first word of `text`. It consists of letters and the number, value or bracketed list that follows. If
/// `text` does not begin with a letter, returns the text up to the next blank.
std::string_view whole_word(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
  const std::size_t blank = std::min(text.find_first_of(" \t"), text.size());
  const std::size_t name = std::min(text.find_first_not_of(letters), text.size());
  if (name == 0) return text.substr(0, blank);
  const std::size_t value = std::min(text.find_first_not_of(" \t", name), text.size());
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789", value), text.size());
  if (end < text.size() && (text[end] == '=' || (text[end] == '(' && end == name && name > 1)))
    return text.substr(0, std::max(end, blank));
  return text.substr(0, end > value ? end : name);
}

const NcCode* code_of(std::span<const NcCode> codes, const NcWord& word) {
  const auto found =
      std::find_if(codes.begin(), codes.end(), [&](const NcCode& code) { return code.number == word.number.value; });
  return found == codes.end() ? nullptr : &*found;
}

bool set_text(std::string_view line, const NcTexts& texts, NcBlock& block) {
  if (line.empty()) return false;
  if (line == texts.spindle_start)
    block.spindle = NcSpindle::started_by_text;
  else if (line == texts.spindle_stop)
    block.spindle = NcSpindle::stopped_by_text;
  else if (line == texts.mist_on || line == texts.mist_off)
    block.mist_on = line == texts.mist_on;
  else if (line == texts.optional_stop)
    block.stop = NcStop::optional;
  else if (line == texts.stop)
    block.stop = NcStop::always;
  else
    return false;
  return true;
}

}  // namespace

NcLines::NcLines(std::string_view text, const std::string& file) : file_(file), remainder_(text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError({file, 0, ""}, "the file must be an NC program, but is empty");
  if (text.size() > kLongestNcBytes)
    throw InputError({file, 0, ""},
                     fmt::format("the program is too long: at most {} bytes are allowed", kLongestNcBytes));
}

bool NcLines::next(std::string_view& line) {
  if (remainder_.empty()) return false;
  ++number_;
  line_ = {};
  const std::size_t end = remainder_.substr(0, kMaxNcLineBytes + 2).find('\n');
  if (end == std::string_view::npos && remainder_.size() > kMaxNcLineBytes)
    fail(fmt::format("a line may have at most {} characters", kMaxNcLineBytes));
  ended_by_newline_ = end != std::string_view::npos;
  line = remainder_.substr(0, end);
  remainder_ = ended_by_newline_ ? remainder_.substr(end + 1) : std::string_view{};
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  line_ = line;
  const auto control = std::find_if(line.begin(), line.end(), is_control);
  if (control != line.end())
    throw InputError({file_, number_, ""},
                     fmt::format("the file must be a text file, but contains a byte with the value {}",
                                 static_cast<unsigned>(static_cast<unsigned char>(*control))));
  return true;
}

void NcLines::fail(std::string_view text) const {
  const std::string block = line_.empty() ? "" : "; the NC line is " + in_quotes(trimmed(line_));
  throw InputError({file_, number_, ""}, std::string(text) + block);
}

void NcLines::fail_word(std::string_view remainder) const {
  for (std::size_t i = 0; i < line_.size(); ++i)
    if (is_same_text(line_.substr(i), remainder))
      fail(in_quotes(whole_word(line_.substr(i))) + " is not supported or not valid here");
  fail(in_quotes(whole_word(remainder)) + " is not supported or not valid here");
}

bool NcNumber::is_integer() const {
  return value == std::floor(value) && std::abs(value) < 1e9;
}

double NcNumber::relative_rounding() const {
  return value == 0.0 ? 0.0 : half_decimal(decimals) / std::abs(value);
}

void check_line_number(const NcNumber& number, const NcLines& lines) {
  if (!number.is_integer() || number.value < 0.0 || std::signbit(number.value))
    lines.fail(fmt::format("a line number must be whole and >= 0, got {}", number.value));
}

bool begins_with_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('.')) text.remove_prefix(1);
  return !text.empty() && is_digit(text.front());
}

NcNumber take_number(std::string_view& text, const NcLines& lines) {
  std::size_t end = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t first = end;
  std::size_t digits = 0;
  NcNumber number;
  for (; end < text.size(); ++end) {
    if (is_digit(text[end])) {
      ++digits;
      if (number.has_point) ++number.decimals;
    } else if (text[end] == '.' && !number.has_point) {
      number.has_point = true;
    } else {
      break;
    }
  }
  constexpr std::size_t most_digits = 20;
  if (digits == 0 || digits > most_digits)
    lines.fail(fmt::format("a number of at most {} digits is required at {}", most_digits, in_quotes(text)));
  number.value = leading_number(text.substr(first, end - first))->value;
  if (text[0] == '-') number.value = -number.value;
  text.remove_prefix(end);
  return number;
}

NcWord take_word(std::string_view& text, const NcLines& lines) {
  NcWord word;
  word.remainder = text;
  word.letter = capital(text.front());
  if (word.letter < 'A' || word.letter > 'Z') lines.fail_word(word.remainder);
  text.remove_prefix(1);
  if (!begins_with_number(text)) lines.fail_word(word.remainder);
  word.number = take_number(text, lines);
  return word;
}

std::string in_capitals(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), capital);
  return result;
}

std::string without_gaps(std::string_view text) {
  std::string result(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '\t'; });
  return result;
}

std::string without_blanks(std::string_view text) {
  return in_capitals(without_gaps(text));
}

void skip_comment_marks(std::string_view& text) {
  while (text.starts_with(kNcCommentMark)) text.remove_prefix(1);
  while (text.ends_with(kNcCommentMark)) text.remove_suffix(1);
}

bool take_text(std::string_view line, const NcTexts& texts, std::string_view misplaced, const NcLines& lines,
               NcProgram& program) {
  NcBlock block;
  block.line = lines.number();
  if (!set_text(line, texts, block)) return false;
  if (!misplaced.empty()) lines.fail(misplaced);
  program.blocks.push_back(block);
  return true;
}

bool starts_with_word(std::string_view text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  return text.size() == word.size() || text[word.size()] == ' ' || text[word.size()] == '\t';
}

std::size_t axis_index(char letter) {
  const std::size_t index = kNcAxisLetters.find(letter);
  return index == std::string_view::npos ? kNcAxes : index;
}

bool IsoBlock::set(const NcWord& word, std::span<const NcCode> g_codes) {
  const std::size_t axis = axis_index(word.letter);
  if (axis < kNcAxes)
    set_axis(axis, word.number);
  else if (word.letter == 'G')
    set_g(word, g_codes);
  else if (word.letter == 'M')
    set_m(word);
  else if (word.letter == 'F')
    set_feed(word);
  else if (word.letter == 'S')
    set_spindle_speed(word);
  else
    return false;
  return true;
}

void IsoBlock::take_group(const NcCode& code, const NcWord& word) {
  const unsigned bit = 1U << static_cast<unsigned>(code.group);
  if (code.group != 0 && (groups_ & bit) != 0)
    lines_.fail(fmt::format("the line contains two {0} codes that exclude each other ({0}{1} is the second of them)",
                            word.letter, word.number.value));
  groups_ |= bit;
}

void IsoBlock::set_g(const NcWord& word, std::span<const NcCode> codes) {
  const NcCode* const code = code_of(codes, word);
  if (code == nullptr) lines_.fail_word(word.remainder);
  take_group(*code, word);
  if (code->effect == nullptr)
    expects_dwell_time_ = true;
  else
    code->effect(block_);
}

void IsoBlock::set_m(const NcWord& word) {
  const NcCode* const code = code_of(kMCodes, word);
  if (code == nullptr) lines_.fail_word(word.remainder);
  take_group(*code, word);
  code->effect(block_);
}

void IsoBlock::set_feed(const NcWord& word) {
  if (block_.feed) lines_.fail("the line contains two feeds");
  if (word.number.value < 0.0) lines_.fail(fmt::format("F must be >= 0, got {}", word.number.value));
  block_.feed = word.number.value;
  block_.rate_rounding = word.number.relative_rounding();
}

void IsoBlock::set_spindle_speed(const NcWord& word) {
  if (block_.spindle_rpm) lines_.fail("the word S occurs twice in one line");
  if (word.number.value < 0.0) lines_.fail(fmt::format("S must be >= 0, got {}", word.number.value));
  block_.spindle_rpm = word.number.value;
}

void IsoBlock::set_axis(std::size_t axis, const NcNumber& place) {
  const auto bit = static_cast<std::uint8_t>(1U << axis);
  if ((block_.axes & bit) != 0) lines_.fail(fmt::format("the axis {} occurs twice in one line", kNcAxisLetters[axis]));
  block_.axes = static_cast<std::uint8_t>(block_.axes | bit);
  block_.words[axis] = place.value;
  block_.axis_decimals[axis] = place.decimals;
}

void IsoBlock::set_cubic(std::size_t axis, const NcNumber& place, double velocity, NcCubic& cubic) {
  set_axis(axis, place);
  cubic.velocities[axis] = velocity;
}

void IsoBlock::set_dwell(double seconds) {
  if (block_.dwell_s) lines_.fail("the line contains two dwell times");
  if (seconds < 0.0) lines_.fail(fmt::format("a dwell must be >= 0, got {}", seconds));
  block_.dwell_s = seconds;
}

void IsoBlock::finish() {
  if (expects_dwell_time_ != block_.dwell_s.has_value())
    lines_.fail(expects_dwell_time_ ? "G4 requires a dwell time" : "a dwell time is allowed only with G4");
  if (expects_dwell_time_ && (block_.axes != 0 || block_.move)) lines_.fail("G4 must be alone in its line");
}

}  // namespace retrace::fabrication
