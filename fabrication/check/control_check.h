#pragma once

// Checks that apply to the programs of all processes: settings before the first move, the first move itself, modal
// settings during cuts, spindle, mist, feeds, and limits of the axes.

#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "fabrication/check/findings.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/read/nc_program.h"
#include "fabrication/read/required_settings.h"

namespace retrace::fabrication {

/// Returns the tolerance, in mm or degrees, for comparing the position of an axis with a limit. It allows for the
/// rounding of the axis word in the program (docs/theory/verification.md).
double rounding_slack(const NcMotion& motion, char axis);

/// State of the spindle that is required while the tool cuts.
struct SpindleRule {
  NcSpindle state = NcSpindle::stopped;
  /// Required speed; not checked if the spindle is started by a program line that the machine file defines.
  double rpm = 0.0;

  bool is_by_text() const { return state == NcSpindle::started_by_text; }
};

/// Requirements of a process on its programs.
struct ControlRule {
  SpindleRule spindle;
  bool needs_mist = false;  ///< true: the mist must be on during cuts
  bool may_blend = false;   ///< true: blocks need no exact stop
  /// Maximum total time, in s, of consecutive dwells at one position in the material.
  double max_dwell_s = std::numeric_limits<double>::infinity();
  /// Set of axes, one bit for each axis of kNcAxisLetters (bit 0: the first axis). The positions of these axes must be
  /// known before Z goes below `safe_z_mm`.
  std::uint8_t axes = 0b111;
  /// Minimum Z, in mm, of the first move, which must move only Z. Z must stay above this value until the positions of
  /// all `axes` are known.
  double safe_z_mm = -std::numeric_limits<double>::infinity();
};

/// Checks the moves and settings of programs and adds findings to a list. A modal setting that stays wrong gives only
/// one finding. If the setting is corrected and becomes wrong again, there is another finding.
class ControlCheck {
 public:
  ControlCheck(FindingList& findings, const ControlRule& rule, const Control& control = {})
      : findings_(findings), rule_(rule), control_(control) {}

  /// Starts the checks of a program.
  void begin(const NcProgram& program);
  /// Checks a move. Before the first move, the program must contain all required settings, and the first move must move
  /// only Z.
  void move(const NcSettings& settings, const NcMotion& motion);
  /// Checks exact stop, spindle and mist during a move in the material.
  void cut(const NcSettings& settings, const NcLocation& place);
  /// Checks the settings after a block without motion.
  /// \param is_in_material true if the tool is in the material
  void state(const NcSettings& settings, const NcLocation& place, bool is_in_material);
  /// Checks that a dwell in the material is not too long.
  /// \param seconds duration; infinite if the program waits for the operator
  void dwell(double seconds, const NcLocation& place);
  /// Checks a stop at which the program waits for the operator. The tool must be at the safe height, the rotary axes
  /// must be at 0, and mist and spindle must be off. The rest of the program is then checked like a new program.
  void stop(const NcSettings& settings, const AxisPositions& at, const NcLocation& place);
  /// Returns the axes whose position was given since the start of the program or the last stop, as one bit for each
  /// axis of kNcAxisLetters.
  std::uint8_t known_axes() const { return known_axes_; }
  void spindle_at_end(const NcEnd& end);
  /// Checks that the machine has the axes that move, and that the axes stay within their limits, have a feed and do not
  /// exceed their speeds.
  void axes(const Machine& machine, const NcMotion& motion);
  /// Checks the feed of a cutting move.
  /// \param process_mm_per_min maximum feed of the process; the tool rubs at feeds far below this value
  void feed(const NcMotion& motion, double process_mm_per_min);

 private:
  void first_move(const NcSettings& settings, const NcMotion& motion);
  bool is_within_full_turn(const LimitExcess& excess) const;
  bool is_too_fast(double speed, double limit, const NcMotion& motion) const;
  void axis_speeds(const Machine& machine, const NcMotion& motion);
  void require_feed(const NcMotion& motion);
  void axis_words(const NcMotion& motion);
  void refuse_option(const NcSettings& settings, const NcLocation& place, bool is_there, const RequiredSetting& option);
  void spindle(const NcSettings& settings, const NcLocation& place);
  /// Records whether a modal setting is correct now.
  /// \param kind name of the setting
  /// \param holds true if the setting is correct now
  /// \return true if the setting was correct before this call and is wrong now
  bool becomes_wrong(const std::string& kind, bool holds);

  FindingList& findings_;
  ControlRule rule_;
  Control control_;
  NcDialect dialect_ = NcDialect::rs274ngc;
  bool has_moved_ = false;  ///< true if an axis has moved since the start of the program or the last stop
  /// Axes whose position was given since the start of the program or the last stop, as one bit for each axis of
  /// kNcAxisLetters.
  std::uint8_t known_axes_ = 0;
  double dwelled_s_ = 0.0;       ///< total dwell time in the material since the last move
  double z_slack_mm_ = 0.0;      ///< tolerance for the rounding of the last Z word
  std::set<std::string> wrong_;  ///< modal settings that are wrong at present
};

}  // namespace retrace::fabrication
