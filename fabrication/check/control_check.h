#pragma once

// What every process asks of a program, whatever it cuts: what it must say before it moves, how it must begin, modal
// settings at every cut, spindle, mist, feeds, and axes within their limits.

#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "fabrication/check/findings.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/read/nc_needs.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Returns the tolerance, in mm or degrees, for comparing the position of an axis with a limit. It allows for the
/// rounding of the axis word in the program (docs/theory/verification.md).
double rounding_slack(const NcMotion& motion, char axis);

/// How the spindle is to turn while the tool cuts.
struct SpindleRule {
  NcSpindle turns = NcSpindle::stopped;
  double rpm = 0.0;  ///< of one that a program's words start; a text that starts it says nothing of speed

  bool is_by_text() const { return turns == NcSpindle::started_by_text; }
};

/// What a process asks of the control.
struct ControlRule {
  SpindleRule spindle;
  bool needs_mist = false;  ///< while it cuts
  bool may_blend = false;   ///< blocks need no exact stop
  /// In the material, at one place: dwells add up.
  double most_rest_s = std::numeric_limits<double>::infinity();
  std::uint8_t axes = 0b111;  ///< bit i: axis i of kNcAxisLetters must be known before the tool comes down
  /// Z, alone, goes there or higher first, and no lower before all those axes are known.
  double safe_z_mm = -std::numeric_limits<double>::infinity();
};

/// Follows programs and adds what it finds to a list. What is wrong with a modal setting is found once, and again if it
/// was mended in between.
class ControlCheck {
 public:
  ControlCheck(FindingList& findings, const ControlRule& rule, const Control& control = {})
      : findings_(findings), rule_(rule), control_(control) {}

  /// A program begins.
  void begin(const NcProgram& program);
  /// Of every move: before the first one, what the program must say itself; Z first, and alone.
  void way(const NcSettings& settings, const NcMotion& motion);
  /// Of every move in the material: exact stops, spindle, mist.
  void cut(const NcSettings& settings, const NcPlace& place);
  /// What a block says where nothing moves. \param is_in_material where the tool stands
  void state(const NcSettings& settings, const NcPlace& place, bool is_in_material);
  /// The tool rests in the material. \param seconds infinite: until the operator goes on
  void rest(double seconds, const NcPlace& place);
  /// The program waits for the operator: above all, rotary axes at 0, with mist and spindle off. What follows begins
  /// like a program.
  void stop(const NcSettings& settings, const AxisPositions& at, const NcPlace& place);
  /// Axes whose place was said since the program began or stopped.
  std::uint8_t known() const { return known_; }
  void spindle_at_end(const NcEnd& end);
  /// That the machine has the axes that move, that they stay within their limits, have a feed and are not fed faster
  /// than they go.
  void axes(const Machine& machine, const NcMotion& motion);
  /// Of a cutting move. \param process_mm_per_min the most that the process allows; far below it the tool rubs
  void feed(const NcMotion& motion, double process_mm_per_min);

 private:
  void first_move(const NcSettings& settings, const NcMotion& motion);
  bool is_within_turn(const LimitExcess& excess) const;
  bool is_too_fast(double speed, double limit, const NcMotion& motion) const;
  void axis_speeds(const Machine& machine, const NcMotion& motion);
  void has_feed(const NcMotion& motion);
  void words_of_axes(const NcMotion& motion);
  void refuse_option(const NcSettings& settings, const NcPlace& place, bool is_there, const NcNeed& option);
  void spindle(const NcSettings& settings, const NcPlace& place);
  /// A modal setting: a finding where it becomes wrong. \return whether it has just become so
  bool turns_wrong(const std::string& kind, bool holds);

  FindingList& findings_;
  ControlRule rule_;
  Control control_;
  NcDialect dialect_ = NcDialect::rs274ngc;
  bool has_moved_ = false;       ///< since the program began or stopped
  std::uint8_t known_ = 0;       ///< axes whose place was said since then
  double rested_s_ = 0.0;        ///< in the material, since the last move
  double z_slack_mm_ = 0.0;      ///< tolerance for the rounding of the last Z word
  std::set<std::string> wrong_;  ///< modal settings that are wrong at present
};

}  // namespace retrace::fabrication
