#pragma once

// Plans a chisel job for a machine: poses, stages, programs and machining time. The facets of prisms are plunged, and
// cube corners are cut by micro chiseling.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "fabrication/chisel/plan/section.h"
#include "fabrication/chisel/plan/tool_life.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Options that select a part of a job and its division into programs.
struct PlanOptions {
  /// Stages to plan: "all", "roughing", "finishing", or the name of one stage, such as "finishing-1-facet-2". A name
  /// followed by "+" selects this stage and all later stages.
  std::string phase = "all";
  std::optional<std::int64_t> from_element;  ///< number of the element at whose first visit the program starts
  /// Number, from 1, of the pass at which the program starts, in the first visit of `from_element`.
  std::optional<std::int64_t> from_pass;
  std::optional<std::int64_t> stop_every;  ///< number of visits between optional stops
  std::optional<double> split_hours;       ///< maximum run time of a program, unless a single visit takes longer
  /// Only the stages before this stage or group of stages are planned. Empty: no restriction. Verification sets it
  /// from the option `next_stage`, to obtain the programs that were run before that stage.
  std::string before;
};

/// Machining time in seconds, divided by kind of motion.
struct TimeBreakdown {
  double cutting_s = 0.0;  ///< plunging and ploughing, including the approach
  double dwell_s = 0.0;
  double retract_s = 0.0;  ///< retracting and positioning in an element
  double rapid_s = 0.0;    ///< rapid moves between elements
  double fixed_s = 0.0;    ///< rotary moves, and moves to and from the safe height

  double total_s() const { return cutting_s + dwell_s + retract_s + rapid_s + fixed_s; }
};

/// Stage of a plan: one subroutine that is executed in one pose for all elements of one orientation.
struct Stage {
  std::string name;      ///< "roughing", "finishing-1-facet-1", "layer-3-facet-2", with "-turned" for rotated elements
  std::size_t pose = 0;  ///< index in Plan::poses
  std::uint32_t subroutine = 0;
  /// True for roughing of prisms and for layers of cube corners. False for finishing cuts and for layers of prisms.
  bool roughs = false;
  int cut = 0;                ///< number of this layer or finishing cut, from 1; 0 for roughing in one stage
  int cuts = 0;               ///< total number of layers, or of finishing cuts, on each facet
  double remaining_mm = 0.0;  ///< thickness of the material that remains on the cut facets after this stage
  /// Number of planned visits of elements. A visit consists of one call of the subroutine for each parallel pass.
  std::int64_t visits = 0;
  TimeBreakdown time;
};

/// Stop of a program, before the visit of an element.
struct PlannedStop {
  std::size_t program = 0;
  StopReason reason = StopReason::time;
  std::size_t stage = 0;     ///< index in Plan::stages
  std::int32_t element = 0;  ///< element with which the program continues
  double at_s = 0.0;         ///< run time since the start of the program
  ToolWear wear;  ///< use of the edge since the previous stop, or since the edge was new if there was no stop
};

/// Number of a program's first subroutine.
inline constexpr int kFirstSubroutine = 101;

/// Plan of a job: elements, poses, stages, programs and machining times.
struct Plan {
  std::vector<CutElement> elements;
  std::vector<CuttingPose> poses;
  std::vector<Stage> stages;  ///< requested stages
  std::vector<Subroutine> subroutines;
  int cuts_per_facet = 0;
  int passes = 1;                  ///< number of parallel passes, if elements are wider than the tool
  int c_rotations = 0;             ///< number of moves of C by more than 45 degrees, including the return to 0
  double safe_z_mm = 0.0;          ///< Z of the tool while the rotary axes move
  double stock_mm = 0.0;           ///< height of the blank's face above the rims, for a blank with a substrate
  double aperture_area_mm2 = 0.0;  ///< total aperture area of the elements that are cut
  TimeBreakdown time;
  std::vector<double> program_times_s;
  std::vector<PlannedStop> stops;
  std::vector<double> program_cuts_mm;  ///< length of cut of each program
  std::vector<Program> programs;
};

/// Plans a job on a machine.
/// \pre `stop_every` is >= 1, `split_hours` is > 0, and `from_pass` is only given together with `from_element`
/// \throw InputError if the machine cannot cut the job (the message names axis and element), or if an option is not
///     applicable to the job
Plan make_plan(const Job& job, const Machine& machine, const PlanOptions& options = {});

/// Returns the minimum Z position, in mm, at which the rotary axes may move. It is the sum of `rotary_clearance_mm`,
/// `clearance_mm`, and the maximum height of the corners of the blank's face. This maximum is reached while A moves
/// from 0 to the poses and C rotates by a full turn.
/// \pre the whole blank is below z = 0 of the workpiece
double safe_height_mm(const Job& job, const Machine& machine, const std::vector<CuttingPose>& poses);

}  // namespace retrace::fabrication
