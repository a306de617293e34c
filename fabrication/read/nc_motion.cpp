#include "fabrication/read/nc_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"

namespace retrace::fabrication {
namespace {

constexpr double kTurnDeg = 360.0;

/// Returns the maximum number of nested calls. LinuxCNC 2.9 refuses the tenth call (tested with rs274), and a Fanuc 30i
/// refuses the eleventh (operator's manual B-63944). The value for the other controls is an upper bound.
std::size_t max_nested_calls(NcDialect dialect) {
  if (dialect == NcDialect::rs274ngc) return 9;
  return dialect == NcDialect::fanuc ? 10 : 16;
}

template <class Value>
void take_over(std::optional<Value>& setting, const Setting<Value>& given) {
  if (given) setting = given;
}

class Runner {
 public:
  Runner(const NcProgram& program, NcSink& sink)
      : program_(program), sink_(sink), stops_in_main_(is_in_main(program, program.stop_line)) {}

  NcEnd run() {
    NcEnd end = carry_out_all();
    end.settings = settings_;
    return end;
  }

 private:
  NcEnd carry_out_all() {
    next_ = program_.main_first;
    while (next_ < program_.main_last || !calls_.empty()) {
      if (!calls_.empty() && next_ >= calls_.back().end) {
        go_back();
        continue;
      }
      const NcBlock& block = program_.blocks[next_++];
      if (block.cubic < 0) expect_standstill(block);
      if (stops_before(block)) return stopped();
      if (++carried_out_ > kMaxNcBlocks)
        fail(block, fmt::format("the program executes more than {} lines", kMaxNcBlocks));
      carry_out(block);
      if (block.call >= 0 && !call(block)) return missing_subroutine(block);
      if (block.returns && !calls_.empty()) go_back();
      if (block.ends) return end_at(block);
      if (program_.stop_line > 0 && !stops_in_main_ && block.line == program_.stop_line) return {};
    }
    if (program_.stop_line > 0) return stopped();
    return {false, program_.lines, program_.truncated.value_or("the program has no end"), {}};
  }

  /// Returns true if a line belongs to the main program. Lines of subroutines between its lines do not belong to it.
  static bool is_in_main(const NcProgram& program, std::int32_t line) {
    const auto holds = [&](std::size_t first, std::size_t last) {
      return first < last && line >= program.blocks[first].line && line <= program.blocks[last - 1].line;
    };
    return holds(program.main_first, program.main_last) &&
           std::none_of(program.subroutines.begin(), program.subroutines.end(),
                        [&](const NcSubroutine& s) { return holds(s.first, s.last); });
  }
  /// Ends the execution after the requested line of the main program.
  /// \throw InputError if there was no motion up to this line
  NcEnd stopped() const {
    if (motions_ == 0 || !stops_in_main_) fail_to_stop();
    return {};
  }
  [[noreturn]] void fail_to_stop() const {
    throw InputError(
        {program_.file, program_.stop_line, ""},
        "the program cannot be stopped after this line: nothing is executed in this line, or no axis has moved before");
  }
  /// Returns true if the execution must stop before a block: a block of the main program after the stop line. A
  /// subroutine that the stop line calls is executed completely.
  bool stops_before(const NcBlock& block) const {
    return program_.stop_line > 0 && calls_.empty() && stops_in_main_ && block.line > program_.stop_line;
  }

  static std::uint16_t said_by(const NcBlock& block) {
    unsigned said = block.settings_made;
    if (block.unit_mm) said |= nc_setting::kUnit;
    if (block.absolute) said |= nc_setting::kDistance;
    if (block.feed_time_s) said |= nc_setting::kFeedTime;
    if (block.exact_stop == true) said |= nc_setting::kExactStop;
    return static_cast<std::uint16_t>(said);
  }

  struct Call {
    std::size_t back = 0;  ///< index of the block after the call
    std::size_t end = 0;   ///< index after the last block of the subroutine
    std::int32_t line = 0;
  };

  [[noreturn]] void fail(const NcBlock& block, std::string_view text) const {
    throw InputError({program_.file, block.line, ""}, text);
  }

  /// Ends the execution at the end of the program.
  /// \throw InputError if the program never reaches the line at which it was stopped
  NcEnd end_at(const NcBlock& block) const {
    if (program_.stop_line > 0 && (!stops_in_main_ || block.line < program_.stop_line)) fail_to_stop();
    return end();
  }

  NcEnd end() const {
    if (!program_.truncated) return {};
    return {false, program_.lines, *program_.truncated, {}};
  }

  NcEnd missing_subroutine(const NcBlock& block) const {
    const std::string& name = program_.subroutines[static_cast<std::size_t>(block.call)].name;
    return {false, block.line, fmt::format("the file does not contain the complete subroutine {}", name), {}};
  }

  bool call(const NcBlock& block) {
    const NcSubroutine& subroutine = program_.subroutines[static_cast<std::size_t>(block.call)];
    if (!subroutine.is_complete) return false;
    const std::size_t most = max_nested_calls(program_.dialect);
    if (calls_.size() >= most)
      fail(block, fmt::format("subroutine calls are nested more than {} deep; check whether subroutine {} calls itself",
                              most, subroutine.name));
    calls_.push_back({next_, subroutine.last, block.line});
    next_ = subroutine.first;
    return true;
  }

  void go_back() {
    next_ = calls_.back().back;
    calls_.pop_back();
  }

  NcLocation place_of(const NcBlock& block) const { return {block.line, calls_.empty() ? 0 : calls_.front().line}; }

  void carry_out(const NcBlock& block) {
    take_over(settings_.absolute, block.absolute);
    take_over(settings_.unit_mm, block.unit_mm);
    take_over(settings_.feed_time_s, block.feed_time_s);
    take_over(settings_.exact_stop, block.exact_stop);
    // Each block that sets blending or exact stop resets the path tolerance.
    if (block.exact_stop) settings_.blend_mm.reset();
    if (block.blend_mm) settings_.blend_mm = *block.blend_mm * settings_.unit_mm.value_or(1.0);
    settings_.settings_made = static_cast<std::uint16_t>(settings_.settings_made | said_by(block));
    take_over(settings_.spindle, block.spindle);
    take_over(settings_.spindle_rpm, block.spindle_rpm);
    take_over(settings_.mist_on, block.mist_on);
    if (block.spindle || block.mist_on || block.exact_stop || block.settings_made != 0)
      sink_.state(settings_, place_of(block));
    if (block.cancels_move) move_.reset();
    if (block.move) move_ = block.move;
    set_rate(block);
    if (block.dwell_s) sink_.dwell(*block.dwell_s, place_of(block), axes_of(position_));
    if (block.begins_cubics) cubics_s_ = 0.0;
    if (block.cubic >= 0)
      cubic(block);
    else if (block.axes != 0)
      move(block);
    if (block.stop != NcStop::none) stop(block);
  }

  void set_rate(const NcBlock& block) {
    // Controls discard the feed when the mode changes between feed per minute and inverse time.
    const bool changes_mode = block.inverse_time && inverse_time_ && block.inverse_time != inverse_time_;
    if (block.clears_feed || changes_mode) feed_ = 0.0;
    take_over(inverse_time_, block.inverse_time);
    // In inverse time mode, an F word applies only to its own block.
    const bool is_feed = block.feed && !inverse_time_.value_or(false);
    if (is_feed) feed_ = *block.feed;
    if (is_feed) move_time_s_ = 0.0;
    if (block.move_time_s) move_time_s_ = *block.move_time_s;
    if (block.feed || block.move_time_s) rate_rounding_ = block.rate_rounding;
    const bool is_empty_g1 = block.move == NcMove::linear && block.axes == 0 && program_.dialect == NcDialect::rs274ngc;
    if (is_empty_g1 && !(inverse_time_.value_or(false) ? block.feed.value_or(0.0) > 0.0 : feed_ > 0.0))
      fail(block, "G1 requires a feed F, even if no axis moves");
  }

  void stop(const NcBlock& block) {
    sink_.stop(block.stop, settings_, place_of(block));
    if (block.stop != NcStop::always) return;
    // During a stop, the operator may change settings and move axes, so the settings are not known afterwards.
    settings_.settings_made = 0;
    settings_.spindle.reset();
    settings_.mist_on.reset();
  }

  /// Returns the motion to the positions of a block, and updates the present positions.
  NcMotion motion_of(const NcBlock& block, NcMove move) {
    NcMotion motion;
    motion.move = move;
    motion.location = place_of(block);
    motion.shortest = block.shortest;
    motion.decimals = block.decimals;
    ++motions_;
    motion.known = known_;
    motion.from = axes_of(position_);
    for (std::size_t axis = 0; axis < kNcAxes; ++axis)
      if ((block.axes >> axis & 1U) != 0) move_axis(block, axis, motion);
    motion.to = axes_of(position_);
    motion.rounding = rounding_;
    return motion;
  }

  void move(const NcBlock& block) {
    if (!move_) fail(block, "axes must not move before the first G0 or G1");
    NcMotion motion = motion_of(block, *move_);
    if (motion.move == NcMove::linear) motion.duration_s = duration_of(block, motion);
    if (motion.move == NcMove::linear && motion.duration_s == 0.0) motion.feed_mm_per_min = feed_mm_per_min();
    if (motion.move == NcMove::linear) motion.rate_rounding = rate_rounding_ + length_rounding(motion);
    motion.is_exact_stop = settings_.exact_stop.value_or(true);
    sink_.motion(motion, settings_);
  }

  /// Checks that all axes are at rest after a sequence of cubic moves.
  void expect_standstill(const NcBlock& block) const {
    for (std::size_t axis = 0; axis < kNcAxes; ++axis)
      if (velocities_[axis] != 0.0)
        fail(block,
             fmt::format("axis {} must have the velocity 0 at the end of the preceding move", kNcAxisLetters[axis]));
  }

  /// Converts velocities from the units of the program to mm/s and degrees/s.
  std::array<double, kNcAxes> velocities_of(const NcBlock& block, const NcCubic& cubic) const {
    const double per_s = 1.0 / settings_.feed_time_s.value_or(default_feed_time_s());
    std::array<double, kNcAxes> velocities{};
    for (std::size_t axis = 0; axis < kNcAxes; ++axis)
      if ((block.axes >> axis & 1U) != 0)
        velocities[axis] =
            cubic.velocities[axis] * per_s * (axis < kFirstRotaryAxis ? settings_.unit_mm.value_or(1.0) : 1.0);
      else if (velocities_[axis] != 0.0)
        fail(block,
             fmt::format(
                 "axis {} does not stop at the end of the preceding move, and must therefore be given in this move",
                 kNcAxisLetters[axis]));
    return velocities;
  }

  double cubic_time_s(const NcBlock& block, const NcCubic& cubic) {
    double time_s = cubic.time_s;
    if (has_times_since_begin(program_.dialect)) {
      if (!cubics_s_)
        fail(block,
             "PVT INIT TIME ABS must precede moves with velocities, because it defines the time origin of these moves");
      time_s -= std::exchange(*cubics_s_, cubic.time_s);
    }
    if (!(time_s > 0.0)) fail(block, fmt::format("a move with velocities must have a duration > 0, got {} s", time_s));
    return time_s;
  }

  void cubic(const NcBlock& block) {
    const NcCubic& cubic = program_.cubics[static_cast<std::size_t>(block.cubic)];
    // For other time units, the documents of the control contradict each other about the units of times and velocities.
    if (has_feeds_of_all_axes(program_.dialect) && settings_.feed_time_s != 1.0)
      fail(block, "the time unit must be seconds for moves with velocities");
    if ((block.axes & ~known_) != 0) fail(block, "a move with velocities begins at an unknown position");
    const double time_s = cubic_time_s(block, cubic);
    const std::array<double, kNcAxes> from = position_;
    const std::array<double, kNcAxes> begin = velocities_;
    NcMotion motion = motion_of(block, NcMove::linear);
    velocities_ = velocities_of(block, cubic);
    motion.is_exact_stop = false;
    const int pieces = pieces_of(from, begin, time_s);
    motion.duration_s = time_s / pieces;
    for (int k = 1; k <= pieces; ++k) {
      motion.is_continued = k < pieces;
      motion.to =
          axes_of(motion.is_continued ? place_along(from, begin, time_s, static_cast<double>(k) / pieces) : position_);
      sink_.motion(motion, settings_);
      motion.from = motion.to;
    }
  }

  /// Evaluates the cubic Hermite polynomial of each axis, from the start position and velocity to the present position
  /// and velocity.
  /// \param t fraction of the duration, 0 to 1
  std::array<double, kNcAxes> place_along(const std::array<double, kNcAxes>& from,
                                          const std::array<double, kNcAxes>& begin, double time_s, double t) const {
    std::array<double, kNcAxes> at{};
    for (std::size_t axis = 0; axis < kNcAxes; ++axis)
      at[axis] = from[axis] + t * t * (3.0 - 2.0 * t) * (position_[axis] - from[axis]) +
                 t * (1.0 - t) * time_s * ((1.0 - t) * begin[axis] - t * velocities_[axis]);
    return at;
  }

  /// Returns the number of straight segments for a cubic move. The deviation of a segment from the curve is at most the
  /// maximum second derivative times 0.125 h^2, where h is the duration of the segment.
  int pieces_of(const std::array<double, kNcAxes>& from, const std::array<double, kNcAxes>& begin,
                double time_s) const {
    double most = 1.0;
    for (std::size_t axis = 0; axis < kNcAxes; ++axis) {
      const double by = position_[axis] - from[axis];
      const double at_begin = 6.0 * by - time_s * (4.0 * begin[axis] + 2.0 * velocities_[axis]);
      const double at_end = -6.0 * by + time_s * (2.0 * begin[axis] + 4.0 * velocities_[axis]);
      const double bend = std::max(std::abs(at_begin), std::abs(at_end));
      most = std::max(most, bend / (8.0 * (axis < kFirstRotaryAxis ? kCubicToleranceMm : kCubicToleranceDeg)));
    }
    constexpr double kMaxSegments = 4096.0;
    return static_cast<int>(std::min(kMaxSegments, std::ceil(std::sqrt(most))));
  }

  double default_feed_time_s() const { return program_.dialect == NcDialect::pmac ? 1.0 : 60.0; }

  /// Returns the feed in mm/min. Without a setting, feeds are in mm/min, except for the PMAC, which starts with mm/s.
  double feed_mm_per_min() const {
    return feed_ * settings_.unit_mm.value_or(1.0) * 60.0 / settings_.feed_time_s.value_or(default_feed_time_s());
  }

  /// Returns the duration of a linear move, or 0 if the move has a feed.
  double duration_of(const NcBlock& block, const NcMotion& motion) const {
    if (has_feeds_of_all_axes(program_.dialect)) return duration_by_way(block, motion);
    if (!inverse_time_.value_or(false)) return move_time_s_;
    if (!block.feed || !(*block.feed > 0.0))
      fail(block, "in inverse time mode (G93), every linear move requires a word F > 0");
    return 60.0 / *block.feed;
  }

  /// Returns the duration of a linear move whose feed is the speed of all axes together. It is needed if rotary axes
  /// move, because the feed is then not the speed of the linear axes. It is also needed for blended moves, which follow
  /// each other at this speed. Returns 0 for all other moves.
  double duration_by_way(const NcBlock& block, const NcMotion& motion) const {
    const bool is_known = (block.axes & ~motion.known) == 0;
    const bool turns = block.axes >> kFirstRotaryAxis != 0;
    if (!is_known || !(turns || settings_.exact_stop == false)) return 0.0;
    const AxisPositions& from = motion.from;
    const AxisPositions& to = motion.to;
    const double way = std::hypot(std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm, to.z_mm - from.z_mm),
                                  std::hypot(to.a_deg - from.a_deg, to.b_deg - from.b_deg, to.c_deg - from.c_deg));
    const double feed = feed_mm_per_min();
    return feed > 0.0 ? 60.0 * way / feed : 0.0;
  }

  /// Returns the maximum relative error of the length of a move whose time is given, due to the rounded end positions
  /// of each axis. Returns 0 for a move with a feed, because the feed does not depend on the length.
  static double length_rounding(const NcMotion& motion) {
    const double length = motion.path_length();
    if (motion.duration_s == 0.0 || length == 0.0) return 0.0;
    double rounding = 0.0;
    for (std::size_t axis = 0; axis < kNcAxes; ++axis)
      if ((motion.moved >> axis & 1U) != 0) rounding = std::hypot(rounding, 2.0 * motion.rounding[axis]);
    return rounding / length;
  }

  void move_axis(const NcBlock& block, std::size_t axis, NcMotion& motion) {
    const auto bit = static_cast<std::uint8_t>(1U << axis);
    const bool is_increment = (block.increments & bit) != 0;
    const bool is_absolute = settings_.absolute.value_or(true) && !is_increment;
    const double unit = axis < kFirstRotaryAxis ? settings_.unit_mm.value_or(1.0) : 1.0;
    if (!is_absolute && (known_ & bit) == 0)
      fail(block,
           fmt::format("axis {} must not have an incremental move before its position is known", kNcAxisLetters[axis]));
    if (is_absolute && (block.shortest & bit) == 0) motion.absolute = static_cast<std::uint8_t>(motion.absolute | bit);
    double to = block.words[axis] * unit + (is_absolute ? 0.0 : position_[axis]);
    if ((block.shortest & bit) != 0) to += kTurnDeg * std::round((position_[axis] - to) / kTurnDeg);
    if ((known_ & bit) == 0 || to != position_[axis]) motion.moved = static_cast<std::uint8_t>(motion.moved | bit);
    position_[axis] = to;
    rounding_[axis] = half_decimal(block.axis_decimals[axis]) * unit;
    known_ = static_cast<std::uint8_t>(known_ | bit);
  }

  static AxisPositions axes_of(const std::array<double, kNcAxes>& p) { return {p[0], p[1], p[2], p[3], p[4], p[5]}; }

  const NcProgram& program_;
  NcSink& sink_;
  bool stops_in_main_;
  std::size_t next_ = 0;
  std::vector<Call> calls_;
  std::int64_t carried_out_ = 0;
  std::int32_t motions_ = 0;
  NcSettings settings_;
  std::optional<NcMove> move_;
  double feed_ = 0.0;
  std::optional<bool> inverse_time_;
  double move_time_s_ = 0.0;
  double rate_rounding_ = 0.0;  ///< maximum relative rounding error of the last F word or time word
  std::array<double, kNcAxes> position_{};
  std::array<double, kNcAxes> rounding_{};
  std::array<double, kNcAxes> velocities_{};  ///< velocities at the end of the last cubic move, per second
  std::optional<double> cubics_s_;            ///< time since the start of the cubic moves
  std::uint8_t known_ = 0;
};

}  // namespace

double NcMotion::path_length() const {
  constexpr std::uint8_t linear_axes = 0b111;
  if ((moved & linear_axes) != 0) return std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm, to.z_mm - from.z_mm);
  return std::hypot(to.a_deg - from.a_deg, to.b_deg - from.b_deg, to.c_deg - from.c_deg);
}

NcEnd run_nc(const NcProgram& program, NcSink& sink) {
  return Runner(program, sink).run();
}

}  // namespace retrace::fabrication
