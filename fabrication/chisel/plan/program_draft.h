#pragma once

// Builds a program from moves and calls of subroutines. Tracks the axis positions and the run time.

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/chisel/plan/tool_life.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Z positions of the tool while it does not cut.
struct SafeHeights {
  Nanometres safe_nm = 0;   ///< minimum height for moves of the rotary axes
  Nanometres first_nm = 0;  ///< height of the first move of a program, and of the first move after a stop; >= safe_nm
};

/// Program under construction, to which moves, calls and stops are added. Tracks the axis positions, and adds up the
/// run time and the use of the cutting edge.
class ProgramDraft {
 public:
  /// Starts a program. The axis positions are not known, so Z moves up first.
  /// \param plan_time run time of all programs, to which the run time of this program is added
  /// \pre all arguments outlive this object
  ProgramDraft(const Job& job, const Machine& machine, const SafeHeights& heights, TimeBreakdown& plan_time);

  void add(Item item) { program_.items.push_back(std::move(item)); }
  /// Moves up to the safe height if the tool is below it.
  void raise();
  /// Moves the tilting axis to `a` and C to `c`, after a move up to the safe height. Does nothing if both axes are at
  /// these positions.
  void rotate_to(RotaryUnits a, RotaryUnits c);
  /// Moves one linear axis to a position.
  void traverse(Axis axis, double to_mm);
  /// Adds a call of a subroutine, after the rapid moves to its start.
  /// \param end end point of the subroutine's moves, relative to its start
  /// \param routine run time of the subroutine
  void add_cycle_call(const CycleCall& call, const LinearPosition& end, const TimeBreakdown& routine, Stage& stage);
  /// Adds a length of cut to the use of the cutting edge.
  void cut(double mm);
  /// Moves the tool up to the height of the first move, and the rotary axes to 0.
  void park();
  /// Adds a stop for the operator, and a comment after it. The program then continues like a new program: the axis
  /// positions are not known, so Z moves up first.
  /// \pre the axes are parked
  void stop(StopReason reason, std::string comment);

  const AxisWords& at() const { return at_; }
  double seconds() const { return seconds_; }
  double cut_mm() const { return cut_mm_; }
  const ToolLife& tool_life() const { return tool_life_; }
  bool has_cycle_calls() const { return !used_.empty(); }
  /// Returns the indices of the subroutines that the program calls.
  const std::set<std::uint32_t>& used() const { return used_; }
  /// Returns the number of moves of C by more than 45 degrees.
  int c_rotations() const { return c_rotations_; }

  /// Returns the program.
  /// \param all subroutines of the plan, in the order of CycleCall::subroutine
  /// \param only_used true: the program contains only the subroutines that it calls; false: it contains all subroutines
  Program take(const std::vector<Subroutine>& all, bool only_used);

 private:
  void raise_to(Nanometres z_nm);
  RotaryUnits rotation(char axis, RotaryUnits units) const;
  /// Updates the axis positions and the run time by a rapid move of linear axes.
  void go(const Move& move, double TimeBreakdown::*part, Stage* stage = nullptr);
  void add_time(double TimeBreakdown::*part, double seconds, Stage* stage = nullptr);

  const Job& job_;
  const Machine& machine_;
  const SafeHeights& heights_;
  TimeBreakdown& plan_time_;
  Program program_;
  AxisWords at_{};
  bool just_raised_ = true;  ///< true if no visit was added since the last move up to a safe height
  double seconds_ = 0.0;
  ToolLife tool_life_;
  double cut_mm_ = 0.0;
  int stops_ = 0;
  int c_rotations_ = 0;
  std::set<std::uint32_t> used_;
};

}  // namespace retrace::fabrication
