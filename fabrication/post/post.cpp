#include "fabrication/post/post.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/post/dialects.h"

namespace retrace::fabrication {
namespace {

std::string for_control(std::string_view format, const Control& control) {
  const std::string codes =
      std::string(control.has_rotation ? " G69" : "") + (control.has_mirror ? "\nG50.1 X0. Y0. Z0." : "");
  return fmt::format(fmt::runtime(format), control.coordinate_system,
                     kIncrementSystemWords[static_cast<std::size_t>(control.increment_system)], codes);
}

/// Program line that the machine file or the part file defines, and the key of this line.
struct OwnLine {
  std::string_view key;
  std::string text;
  LineUse use = LineUse::output;
};

std::vector<OwnLine> control_lines(const Control& control) {
  return {{"control.mist_on", control.mist_on},
          {"control.mist_off", control.mist_off},
          {"control.optional_stop", control.optional_stop, LineUse::stop},
          {"control.stop", control.stop, LineUse::stop}};
}

std::vector<OwnLine> spindle_lines(const Spindle& spindle) {
  return {{"lathe.spindle_start", spindle.start_text}, {"lathe.spindle_stop", spindle.stop_text}};
}

bool is_unchecked(const OwnLine& line, std::string_view dialect) {
  return !line.text.empty() && !is_harmless_line(line.text, line.use, dialect);
}

std::string unchecked_text(const OwnLine& line) {
  return fmt::format("Not checked: the line of {}, which may move axes or wait", line.key);
}

/// Checks that a line neither moves axes nor waits, unless the file permits any line.
/// \param table table of the file with the key `has_unchecked_lines`
/// \param may_be_any value of this key
/// \throw InputError if the line is not allowed
void check_line(const OwnLine& line, std::string_view dialect, std::string_view table, bool may_be_any) {
  if (may_be_any || !is_unchecked(line, dialect)) return;
  throw InputError(Field{"dialect"},
                   fmt::format("{} {} for {}; any other line requires {}.has_unchecked_lines = true, got {}", line.key,
                               line_form_error(line.text, line.use, dialect), dialect, table, in_quotes(line.text)));
}

/// Writes one file. Positions are converted from integers to text without rounding.
class FileWriter {
 public:
  FileWriter(const DialectFormats& dialect, const Program& program) : dialect_(dialect), program_(program) {
    for (const Subroutine& subroutine : program.subroutines) reach_.push_back(extent_of(subroutine).end);
    increments_ = position_increments(dialect.dialect.name, program.control);
  }

  std::string run() {
    text_ += dialect_.file_ends;
    if (dialect_.subroutines_first) {
      header();
      subroutines();
      text_ += dialect_.main_begin;
    } else {
      text_ += dialect_.main_begin;
      header();
    }
    prepare();
    for (const Item& item : program_.items) std::visit(*this, item);
    still();
    text_ += dialect_.main_end;
    if (!dialect_.subroutines_first) subroutines();
    text_ += dialect_.file_ends;
    return std::move(text_);
  }

  void operator()(const Comment& comment) { add(dialect_.comment, comment.text); }
  void operator()(const Message& message) { add(dialect_.message, message.text); }
  void operator()(const OptionalStop&) {
    // The mist is off during an optional stop, so that chips remain in place for inspection.
    const bool had_mist = mist_on_;
    mist(false);
    add(dialect_.optional_stop, program_.control.optional_stop);
    mist(had_mist);
  }
  void operator()(const Stop& stop) {
    still();
    add(dialect_.message, stop.text);
    add(dialect_.stop, program_.control.stop);
    prepare();
    at_ = {};
  }
  void operator()(const Move& move) {
    const bool is_rapid = move.motion == Motion::rapid;
    if (!is_rapid) mist(true);
    if (is_rapid && move.to[kZ] && !move.to[kX] && !move.to[kY]) mist(false);
    write(move);
    go_to(at_, move.to);
  }
  void operator()(const Path& path) {
    if (!path.end_velocities.empty()) return cubics(path);
    add(dialect_.path_begin, path.blend_mm, program_.control.coordinate_system);
    is_in_path_ = true;
    for (const Move& move : path.moves) {
      write(move);
      go_to(at_, move.to);
    }
    is_in_path_ = false;
    add_for_control(dialect_.path_end);
  }
  void operator()(const CycleCall& visit) {
    const std::string pass = visit.passes > 1 ? fmt::format(" pass {} of {}", visit.pass, visit.passes) : "";
    add(dialect_.comment, fmt::format("element {}{}", visit.element, pass));
    for (const Move& move : approach(at_, visit)) write(move);
    mist(true);
    add(dialect_.call, program_.subroutines[visit.subroutine].number);
    go_to(at_, linear_words(visit.start + reach_[visit.subroutine]));
  }

 private:
  void cubics(const Path& path) {
    if (dialect_.cubic_move.empty())
      throw InputError(Field{"dialect"}, fmt::format("the dialect {} has no moves with positions, velocities and times",
                                                     dialect_.dialect.name));
    add_for_control(dialect_.cubic_begin);
    double since_begin_s = 0.0;
    for (std::size_t i = 0; i < path.moves.size(); ++i) {
      const Move& move = path.moves[i];
      since_begin_s += move.seconds;
      cubic(move, path.end_velocities[i], since_begin_s);
      go_to(at_, move.to);
    }
    add_for_control(dialect_.cubic_end);
  }

  void cubic(const Move& move, const Velocities& velocities, double since_begin_s) {
    const std::string letters = axis_letters();
    std::string words;
    std::vector<std::string> axes;
    std::vector<std::string> places;
    std::vector<std::string> speeds;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      if (!move.to[axis]) continue;
      axes.emplace_back(1, letters[axis]);
      places.push_back(number(*move.to[axis], axis >= kTilt ? 7 : 6));
      // With seven decimals, the rounding error is far below 1 nm at the tool, because all moves are shorter than 1 s.
      speeds.push_back(fixed(velocities[axis] * dialect_.cubic_time_s, 7));
      words += fmt::format(fmt::runtime(dialect_.cubic_word), axes.back(), places.back(), speeds.back());
    }
    add(dialect_.cubic_move, words, fmt::join(axes, ", "), fmt::join(places, ", "), fmt::join(speeds, ", "),
        fixed(1e3 * move.seconds, 6), fixed(move.seconds, 9), fixed(since_begin_s, 9));
  }

  std::string axis_letters() const { return {'X', 'Y', 'Z', program_.tilt_letter, 'C'}; }

  /// Adds a format of the dialect with its arguments to the text.
  template <class... Values>
  void add(std::string_view format, const Values&... values) {
    fmt::format_to(std::back_inserter(text_), fmt::runtime(format), values...);
  }

  void add_for_control(std::string_view format) { text_ += for_control(format, program_.control); }

  /// Adds the settings that are required before the first move of the program or after a stop.
  void prepare() {
    add_for_control(dialect_.prepare);
    if (const auto& spindle = program_.spindle)
      add(dialect_.spindle_start, spindle->rpm, spindle->is_clockwise ? "M3" : "M4", spindle->start_text);
  }

  /// Switches mist and spindle off.
  void still() {
    mist(false);
    if (program_.spindle) add(dialect_.spindle_stop, program_.spindle->stop_text);
  }

  void header() {
    for (const std::string& line : program_.header) add(dialect_.comment, line);
    for (const std::string& line : control_needs(dialect_.dialect.name, program_.control))
      add(dialect_.comment, in_comment(line));
    if (!program_.spindle || !dialect_.has_own_texts) return;
    for (const OwnLine& line : spindle_lines(*program_.spindle))
      if (is_unchecked(line, dialect_.dialect.name)) add(dialect_.comment, unchecked_text(line));
  }

  void mist(bool on) {
    const bool has_words = !dialect_.has_own_texts || !program_.control.mist_on.empty();
    if (on == mist_on_ || !program_.has_mist || !has_words) return;
    add(on ? dialect_.mist_on : dialect_.mist_off, on ? program_.control.mist_on : program_.control.mist_off);
    mist_on_ = on;
  }

  void subroutines() {
    is_in_subroutine_ = true;
    for (const Subroutine& subroutine : program_.subroutines) {
      add(dialect_.subroutine_begin, subroutine.number, subroutine.title);
      for (const Step& step : subroutine.steps)
        if (const auto* const dwell = std::get_if<Dwell>(&step))
          add(dialect_.dwell, 1e-3 * dwell->ms, dwell->ms);
        else
          write(std::get<Move>(step));
      add(dialect_.subroutine_end, subroutine.number);
    }
    is_in_subroutine_ = false;
  }

  /// Replaces parentheses by square brackets, because comments of RS274/NGC and Fanuc end at the first parenthesis.
  static std::string in_comment(std::string text) {
    std::replace(text.begin(), text.end(), '(', '[');
    std::replace(text.begin(), text.end(), ')', ']');
    return text;
  }

  void write(const Move& move) {
    text_ += move.motion == Motion::rapid ? dialect_.rapid : dialect_.linear;
    const std::string letters = axis_letters();
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      if (move.to[axis]) word(axis, letters[axis], *move.to[axis]);
    if (move.seconds > 0.0)
      time_of(move);
    else if (move.motion != Motion::rapid)
      feed(move.feed_mm_per_min);
    text_ += '\n';
  }

  void time_of(const Move& move) {
    const double way = way_of(move);
    if (dialect_.has_paths_by_speed && way == 0.0)
      throw InputError(
          Field{"dialect"},
          fmt::format(
              "{} cannot contain a move of zero length within a path, because the feed cannot define its duration",
              dialect_.dialect.name));
    add(dialect_.path_time, 60.0 / move.seconds, 1e3 * move.seconds, 60.0 * way / move.seconds);
  }

  /// Returns the path length of a move over all linear and rotary axes. One degree counts as 1 mm.
  double way_of(const Move& move) const {
    double way = 0.0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double by = static_cast<double>(move.to[axis].value_or(0) - at_[axis].value_or(0));
      if (move.to[axis]) way = std::hypot(way, by / (axis >= kTilt ? kRotaryUnitsPerDeg : kNanometresPerMm));
    }
    return way;
  }

  /// Adds the word of an axis, as a position or an increment, in the form that the dialect requires.
  void word(std::size_t axis, char letter, std::int64_t value) {
    const bool is_rotary = axis >= kTilt;
    const std::int64_t step = is_rotary ? increments_.rotary_units : increments_.linear_nm;
    const int decimals = (is_rotary ? 7 : 6) - digits_of(step);
    const std::int64_t steps = rounded(value, step);
    const bool is_modulo = is_rotary && program_.control.modulo_axes.find(letter) != std::string::npos;
    const std::int64_t increment = steps - rounded(at_[axis].value_or(0), step);
    if (is_in_path_ && dialect_.has_incremental_paths)
      plain_word(letter, increment, decimals);
    else if (is_in_path_ && is_modulo && !dialect_.increment.empty())
      add(dialect_.increment, letter, number(increment, decimals));
    else if (is_modulo && !is_in_subroutine_ && !dialect_.shortest.empty())
      add(dialect_.shortest, letter, number(within_turn(steps, decimals), decimals));
    else
      plain_word(letter, steps, decimals);
  }

  void plain_word(char letter, std::int64_t steps, int decimals) {
    constexpr std::int64_t kMaxSteps = 999'999'999;
    if (dialect_.has_increment_systems && (steps > kMaxSteps || steps < -kMaxSteps))
      refuse(fmt::format("{}{}", letter, number(steps, decimals)));
    fmt::format_to(std::back_inserter(text_), " {}{}", letter, number(steps, decimals));
  }

  /// Returns a number of steps as decimal text, such as "-1.000000".
  static std::string number(std::int64_t steps, int decimals) {
    const std::uint64_t unit = power_of_ten(decimals);
    const auto bits = static_cast<std::uint64_t>(steps);
    const std::uint64_t size = steps < 0 ? 0 - bits : bits;
    return fmt::format("{}{}.{:0{}}", steps < 0 ? "-" : "", size / unit, size % unit, decimals);
  }

  static std::uint64_t power_of_ten(int exponent) {
    std::uint64_t power = 1;
    for (int k = 0; k < exponent; ++k) power *= 10;
    return power;
  }
  static int digits_of(std::int64_t step) {
    int digits = 0;
    for (; step >= 10; step /= 10) ++digits;
    return digits;
  }
  static std::int64_t rounded(std::int64_t value, std::int64_t step) {
    return step == 1 ? value : to_step(static_cast<double>(value), step) / step;
  }
  static std::int64_t within_turn(std::int64_t steps, int decimals) {
    const auto turn = static_cast<std::int64_t>(360 * power_of_ten(decimals));
    return (steps % turn + turn) % turn;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(
        Field{"dialect"},
        fmt::format("{} cannot write {} in increment system IS-{}, which allows nine digits", dialect_.dialect.name,
                    what, kIncrementSystemWords[static_cast<std::size_t>(program_.control.increment_system)]));
  }

  void feed(double mm_per_min) {
    const long long thousandths = std::llround(mm_per_min * 1e3);
    if (dialect_.has_increment_systems && thousandths > max_feed_thousandths())
      refuse(fmt::format("F{}.{:03}", thousandths / 1000, thousandths % 1000));
    fmt::format_to(std::back_inserter(text_), " F{}.{:03}", thousandths / 1000, thousandths % 1000);
  }
  /// Returns the maximum feed of the increment system, IS-B to IS-E (parameter 1422), in thousandths of mm/min.
  long long max_feed_thousandths() const {
    constexpr std::array kMost = {999'000'000, 99'999'900, 9'999'990, 999'999};
    return kMost[static_cast<std::size_t>(program_.control.increment_system)];
  }

  const DialectFormats& dialect_;
  const Program& program_;
  std::vector<LinearPosition> reach_;  ///< end of each subroutine, relative to its start
  std::string text_;
  AxisWords at_{};
  bool mist_on_ = false;
  bool is_in_path_ = false;
  bool is_in_subroutine_ = false;
  Increments increments_;
};

const DialectFormats& words_of(std::string_view dialect) {
  std::vector<std::string_view> names;
  for (const DialectFormats& words : dialect_formats()) {
    if (words.dialect.name == dialect) return words;
    names.push_back(words.dialect.name);
  }
  throw InputError(Field{"dialect"}, fmt::format("must be {}, got {}", alternatives(names), in_quotes(dialect)));
}

}  // namespace

std::span<const Dialect> dialects() {
  static const std::vector<Dialect> all = [] {
    std::vector<Dialect> result;
    for (const DialectFormats& words : dialect_formats()) result.push_back(words.dialect);
    return result;
  }();
  return all;
}

std::vector<std::string> control_needs(std::string_view dialect, const Control& control) {
  const std::string needs = for_control(words_of(dialect).needs, control);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < needs.size();) {
    const std::size_t end = std::min(needs.find('\n', begin), needs.size());
    lines.push_back(needs.substr(begin, end - begin));
    begin = end + 1;
  }
  if (!words_of(dialect).has_own_texts) return lines;
  for (const OwnLine& line : control_lines(control))
    if (is_unchecked(line, dialect)) lines.push_back(unchecked_text(line));
  return lines;
}

void check_supported(const Program& program, std::string_view dialect) {
  const DialectFormats& words = words_of(dialect);
  if (!words.has_own_texts) return;
  const auto need = [&](const std::string& text, std::string_view what, std::string_view key,
                        std::string_view otherwise) {
    if (text.empty())
      throw InputError(Field{"dialect"},
                       fmt::format("{} has no standard code for {}: give control.{} in the machine file, or {}",
                                   dialect, what, key, otherwise));
  };
  for (const OwnLine& line : control_lines(program.control))
    check_line(line, dialect, "control", program.control.has_unchecked_lines);
  if (program.spindle)
    for (const OwnLine& line : spindle_lines(*program.spindle))
      check_line(line, dialect, "lathe", program.spindle->has_unchecked_lines);
  if (program.needs_mist) need(program.control.mist_on, "mist", "mist_on", "set process.mist = false in the job");
  if (program.needs_mist) need(program.control.mist_off, "mist", "mist_off", "set process.mist = false in the job");
  for (const Item& item : program.items) {
    if (std::holds_alternative<OptionalStop>(item))
      need(program.control.optional_stop, "an optional stop", "optional_stop", "omit " + reference({"stop_every"}));
    if (std::holds_alternative<Stop>(item))
      need(program.control.stop, "a stop", "stop",
           "avoid stops in the job: omit tool.edge_life_mm, process.stop_every_min and process.stop_before_finishing");
  }
}

std::string nc_text(const Program& program, std::string_view dialect) {
  check_supported(program, dialect);
  return FileWriter(words_of(dialect), program).run();
}

Increments position_increments(std::string_view dialect, const Control& control) {
  return words_of(dialect).has_increment_systems ? increments_of(control.increment_system) : Increments{};
}

std::string shortest_axes(std::string_view dialect, const Control& control) {
  return words_of(dialect).shortest.empty() ? "" : control.modulo_axes;
}

bool supports_cubics(std::string_view dialect) {
  return !words_of(dialect).cubic_move.empty();
}

std::string_view ending_of(std::string_view dialect) {
  return words_of(dialect).dialect.ending;
}

}  // namespace retrace::fabrication
