#include <fmt/format.h>

#include <vector>

#include "core/message_text.h"
#include "fabrication/read/aerotech_codes.h"
#include "fabrication/read/dialects.h"
#include "fabrication/read/subroutine_table.h"

namespace retrace::fabrication {
namespace {

/// Call of an AeroScript function that makes a setting. Capital and small letters are different.
struct AeroScriptSetting {
  std::string_view call;
  void (*effect)(NcBlock&) = nullptr;
};
constexpr AeroScriptSetting kAeroScriptSettings[] = {
    {"SetupTaskDistanceUnits(DistanceUnits.Primary)", nc_effects::kMillimetre},
    {"SetupTaskTimeUnits(TimeUnits.Minutes)", kAerotechFeedTime<60>},
    {"SetupTaskTimeUnits(TimeUnits.Seconds)", kAerotechFeedTime<1>},
    {"SetupTaskTargetMode(TargetMode.Absolute)", nc_effects::kAbsolute},
    {"SetupTaskTargetMode(TargetMode.Incremental)", nc_effects::kIncremental},
    {"SetupTaskWaitMode(WaitMode.InPosition)", nc_effects::kMarks<nc_setting::kFineStop>},
    {"VelocityBlendingOn()", nc_effects::kBlending},
    {"VelocityBlendingOff()", nc_effects::kExactStop},
    {"CornerRoundingOff()", nc_effects::kMarks<nc_setting::kRoundingOff>},
};

class Automation1Reader {
 public:
  Automation1Reader(NcLines lines, const NcTexts& texts) : lines_(std::move(lines)), texts_(texts), table_(program_) {
    program_.file = lines_.file();
    program_.dialect = NcDialect::automation1;
  }

  NcProgram run() {
    std::string_view line;
    while (lines_.next(line))
      if (!take_text(trimmed(line), texts_, is_in_main_ ? "" : "a line must be inside of program ... end", lines_,
                     program_))
        read_line_that_may_be_cut(lines_, program_, [&] { read(trimmed(line.substr(0, line.find("//")))); });
    program_.lines = lines_.number();
    if (is_in_main_) program_.main_last = program_.blocks.size();
    if ((is_in_main_ || table_.is_open() || !has_main_) && !program_.truncated)
      program_.truncated = "the line end is missing";
    return std::move(program_);
  }

 private:
  void read(std::string_view text) {
    if (text.empty()) return;
    if (text.find("/*") != std::string_view::npos) lines_.fail("comments of the form /* ... */ are not supported");
    if (text == "program") return begin_main();
    if (starts_with_word(text, "function")) return begin_function(trimmed(text.substr(8)));
    if (text == "end") return end();
    if (!is_in_main_ && !table_.is_open())
      lines_.fail("each line must be located between program and end, or between function and end");
    NcBlock block;
    block.line = lines_.number();
    const std::size_t bracket = text.find('(');
    if (bracket != std::string_view::npos && is_aerotech_name(trimmed(text.substr(0, bracket))))
      read_call(without_gaps(text), block);
    else
      read_words(text, block);
    program_.blocks.push_back(block);
  }

  void begin_main() {
    if (is_in_main_ || table_.is_open()) lines_.fail("program is not allowed within a block that has not ended");
    if (has_main_) lines_.fail("a file must contain only one program");
    has_main_ = is_in_main_ = true;
    program_.main_first = program_.blocks.size();
  }

  void begin_function(std::string_view text) {
    if (is_in_main_ || table_.is_open()) lines_.fail("function is not allowed within a block that has not ended");
    const std::string whole = without_gaps(text);
    const std::string name = whole.substr(0, whole.find('('));
    if (!is_aerotech_name(name) || whole != name + "()")
      lines_.fail("a function must be defined as function NAME(), without arguments");
    if (!table_.begin(name)) lines_.fail("a function with this name already exists: " + name);
  }

  void end() {
    if (!is_in_main_ && !table_.is_open()) lines_.fail("end must follow a program or function");
    NcBlock& block = program_.blocks.emplace_back();
    block.line = lines_.number();
    block.ends = is_in_main_;
    block.returns = !is_in_main_;
    if (!is_in_main_) return table_.end();
    program_.main_last = program_.blocks.size();
    is_in_main_ = false;
  }

  void read_call(std::string_view text, NcBlock& block) {
    for (const AeroScriptSetting& setting : kAeroScriptSettings)
      if (text == setting.call) return setting.effect(block);
    const std::size_t bracket = text.find('(');
    const std::string name(text.substr(0, bracket));
    const std::string_view whole = text;
    text.remove_prefix(bracket + 1);
    if (!text.ends_with(')')) lines_.fail("a call must end with a closing parenthesis");
    text.remove_suffix(1);
    IsoBlock iso(lines_, block);
    if (name == "Dwell") {
      iso.set_dwell(take_number(text, lines_).value);
    } else if (name == "SetupCoordinatedSpeed") {
      iso.set_feed({'F', take_number(text, lines_)});
    } else if (name == "MovePvt") {
      read_cubic(text, iso, block);
    } else if (name == "MoveLinear" || name == "MoveRapid") {
      block.move = name == "MoveLinear" ? NcMove::linear : NcMove::rapid;
      read_axes(text, iso);
    } else if (text.empty()) {
      block.call = table_.index_of(name);
    }
    if (!text.empty()) lines_.fail(in_quotes(whole) + " is not supported or not valid here");
  }

  /// Reads axes and their positions: X,1.5 or [X,Y],[1.5,2]. Speeds of single moves are not supported.
  void read_axes(std::string_view& text, IsoBlock& iso) {
    const bool is_list = text.starts_with('[');
    const std::size_t end = is_list ? text.find("],[") : text.find(',');
    if (end == std::string_view::npos)
      lines_.fail("a move requires a list of axes and a list with the same number of positions");
    std::string_view axes = text.substr(is_list ? 1 : 0, end - (is_list ? 1 : 0));
    text.remove_prefix(end + (is_list ? 3 : 1));
    for (; !axes.empty(); axes.remove_prefix(axes.size() > 1 ? 2 : 1)) {
      const std::size_t axis = axis_index(axes.front());
      const bool is_one = axes.size() == 1 || axes[1] == ',';
      if (axis == kNcAxes || !is_one) lines_.fail("the axis is unknown: got " + in_quotes(axes));
      iso.set_axis(axis, take_number(text, lines_));
      if (axes.size() > 1 && !text.starts_with(','))
        lines_.fail("a move requires a list of axes and a list with the same number of positions");
      if (axes.size() > 1) text.remove_prefix(1);
    }
    if (is_list && !text.starts_with(']'))
      lines_.fail("a move requires a list of axes and a list with the same number of positions");
    if (is_list) text.remove_prefix(1);
  }

  /// Reads a cubic move such as [X,C],[1,2],[3,4],0.5: axes, positions, velocities, and the time of the move.
  void read_cubic(std::string_view& text, IsoBlock& iso, NcBlock& block) {
    constexpr std::string_view needs = "MovePvt must have the arguments [axes], [positions], [velocities], time";
    const auto numbers = [&] {
      std::vector<NcNumber> result;
      if (!text.starts_with('[')) lines_.fail(needs);
      while (!text.starts_with(']')) {
        if (!text.starts_with(result.empty() ? '[' : ',')) lines_.fail(needs);
        text.remove_prefix(1);
        result.push_back(take_number(text, lines_));
      }
      text.remove_prefix(1);
      if (!text.starts_with(',')) lines_.fail(needs);
      text.remove_prefix(1);
      return result;
    };
    const std::size_t end = text.find("],");
    if (!text.starts_with('[') || end == std::string_view::npos) lines_.fail(needs);
    const std::string_view axes = text.substr(1, end - 1);
    text.remove_prefix(end + 2);
    const std::vector<NcNumber> places = numbers();
    const std::vector<NcNumber> velocities = numbers();
    const std::size_t count = places.size();
    if (axes.size() != 2 * count - 1 || velocities.size() != count)
      lines_.fail("MovePvt must have equal numbers of axes, positions and velocities");
    NcCubic cubic;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t axis = axis_index(axes[2 * k]);
      if (axis == kNcAxes || (k > 0 && axes[2 * k - 1] != ','))
        lines_.fail("the axis is unknown: got " + in_quotes(axes));
      iso.set_cubic(axis, places[k], velocities[k].value, cubic);
    }
    cubic.time_s = take_number(text, lines_).value;
    program_.set_cubic(block, cubic);
  }

  /// Reads a line of words. G codes may be written in small letters. Names of axes must be capitals.
  void read_words(std::string_view text, NcBlock& block) {
    IsoBlock iso(lines_, block);
    const std::string packed = without_gaps(text);
    bool is_first = true;
    for (std::string_view rest = packed; !rest.empty(); is_first = false) {
      const char letter = rest.front();
      const NcWord word = take_word(rest, lines_);
      if (word.letter == 'N' && is_first) {
        check_line_number(word.number, lines_);
        continue;
      }
      if (axis_index(word.letter) < kNcAxes && letter != word.letter)
        lines_.fail(fmt::format("the names of axes must be capital letters, got {}", letter));
      const bool is_unit = word.letter == 'G' && (word.number.value == 70 || word.number.value == 71);
      if (is_unit) lines_.fail("units must be set by SetupTaskDistanceUnits(), not by G70 or G71");
      take_aerotech_word(word, iso, lines_);
    }
    iso.finish();
  }

  NcLines lines_;
  const NcTexts& texts_;
  NcProgram program_;
  SubroutineTable table_;
  bool is_in_main_ = false;
  bool has_main_ = false;
};

}  // namespace

NcProgram parse_automation1(NcLines lines, const NcTexts& texts) {
  return Automation1Reader(std::move(lines), texts).run();
}

}  // namespace retrace::fabrication
