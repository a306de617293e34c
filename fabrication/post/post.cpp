#include "fabrication/post/post.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/message_text.h"
#include "fabrication/post/dialects.h"

namespace retrace::fabrication {
namespace {

/// Writes one file. Numbers of positions are written from integers, digit by digit.
class FileWriter {
 public:
  FileWriter(const DialectWords& dialect, const Program& program) : dialect_(dialect), program_(program) {
    for (const Subroutine& subroutine : program.subroutines) reach_.push_back(reach_of(subroutine).end);
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
    text_ += dialect_.prepare;
    if (const auto& spindle = program_.spindle)
      add(dialect_.spindle_start, spindle->rpm, spindle->is_clockwise ? "M3" : "M4", spindle->start_text);
    for (const Item& item : program_.items) std::visit(*this, item);
    mist(false);
    if (program_.spindle) add(dialect_.spindle_stop, program_.spindle->stop_text);
    text_ += dialect_.main_end;
    if (!dialect_.subroutines_first) subroutines();
    text_ += dialect_.file_ends;
    return std::move(text_);
  }

  void operator()(const Comment& comment) { add(dialect_.comment, comment.text); }
  void operator()(const Message& message) { add(dialect_.message, message.text); }
  void operator()(const OptionalStop&) {
    // Mist off during an optional stop: chips stay where they fell, for inspection.
    const bool had_mist = mist_on_;
    mist(false);
    text_ += "M1\n";
    mist(had_mist);
  }
  void operator()(const Move& move) {
    const bool is_rapid = move.motion == Motion::rapid;
    if (!is_rapid) mist(true);
    if (is_rapid && move.to[kZ] && !move.to[kX] && !move.to[kY]) mist(false);
    write(move);
    go_to(at_, move.to);
  }
  void operator()(const Path& path) {
    text_ += dialect_.path_begin;
    for (const Move& move : path.moves) {
      write(move);
      go_to(at_, move.to);
    }
    text_ += dialect_.path_end;
  }
  void operator()(const Visit& visit) {
    add(dialect_.comment, fmt::format("element {}", visit.element));
    for (const Move& move : approach(at_, visit)) write(move);
    mist(true);
    add(dialect_.call, program_.subroutines[visit.subroutine].number);
    go_to(at_, linear_words(visit.start + reach_[visit.subroutine]));
  }

 private:
  /// A format of the dialect, filled in.
  template <class... Values>
  void add(std::string_view format, const Values&... values) {
    fmt::format_to(std::back_inserter(text_), fmt::runtime(format), values...);
  }

  void header() {
    for (const std::string& line : program_.header) add(dialect_.comment, line);
  }

  void mist(bool on) {
    if (on == mist_on_ || !program_.has_mist) return;
    text_ += on ? "M7\n" : "M9\n";
    mist_on_ = on;
  }

  void subroutines() {
    for (const Subroutine& subroutine : program_.subroutines) {
      add(dialect_.subroutine_begin, subroutine.number, subroutine.title);
      for (const Step& step : subroutine.steps)
        if (const auto* const dwell = std::get_if<Dwell>(&step))
          add(dialect_.dwell, 1e-3 * dwell->ms, dwell->ms);
        else
          write(std::get<Move>(step));
      add(dialect_.subroutine_end, subroutine.number);
    }
  }

  void write(const Move& move) {
    text_ += move.motion == Motion::rapid ? dialect_.rapid : dialect_.linear;
    const std::array letters = {'X', 'Y', 'Z', program_.tilt_letter, 'C'};
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      if (move.to[axis]) word(letters[axis], *move.to[axis], axis < kTilt ? 6 : 7);
    if (move.seconds > 0.0)
      add(dialect_.path_time, 60.0 / move.seconds, 1e3 * move.seconds);
    else if (move.motion != Motion::rapid)
      feed(move.feed_mm_per_min);
    text_ += '\n';
  }

  /// " X1.000000": six decimals of a mm, seven of a degree.
  void word(char letter, std::int64_t value, int decimals) {
    std::uint64_t unit = 1;
    for (int k = 0; k < decimals; ++k) unit *= 10;
    const auto bits = static_cast<std::uint64_t>(value);
    const std::uint64_t size = value < 0 ? 0 - bits : bits;
    fmt::format_to(std::back_inserter(text_), " {}{}{}.{:0{}}", letter, value < 0 ? "-" : "", size / unit, size % unit,
                   decimals);
  }

  void feed(double mm_per_min) {
    const long long thousandths = std::llround(mm_per_min * 1e3);
    fmt::format_to(std::back_inserter(text_), " F{}.{:03}", thousandths / 1000, thousandths % 1000);
  }

  const DialectWords& dialect_;
  const Program& program_;
  std::vector<Place> reach_;  ///< end of each subroutine from its start
  std::string text_;
  Words at_{};
  bool mist_on_ = false;
};

const DialectWords& words_of(std::string_view dialect) {
  std::vector<std::string_view> names;
  for (const DialectWords& words : dialect_words()) {
    if (words.dialect.name == dialect) return words;
    names.push_back(words.dialect.name);
  }
  throw InputError({"", 0, "--dialect"}, fmt::format("must be {}, got {}", alternatives(names), in_quotes(dialect)));
}

}  // namespace

std::span<const Dialect> dialects() {
  static const std::vector<Dialect> all = [] {
    std::vector<Dialect> result;
    for (const DialectWords& words : dialect_words()) result.push_back(words.dialect);
    return result;
  }();
  return all;
}

std::string nc_text(const Program& program, std::string_view dialect) {
  return FileWriter(words_of(dialect), program).run();
}

std::string_view ending_of(std::string_view dialect) {
  return words_of(dialect).dialect.ending;
}

}  // namespace retrace::fabrication
