#pragma once

// Plans a chisel job for a machine: poses, stages and programs, with the time that they take.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "fabrication/chisel/plan/edge_use.h"
#include "fabrication/chisel/plan/section.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// What part of a job to make, and in how many programs.
struct PlanOptions {
  /// "all"; "roughing" or "finishing"; the name of one stage, such as "finishing-1-facet-2"; or such a name with "+":
  /// that stage and all after it.
  std::string phase = "all";
  std::optional<std::int64_t> from_element;  ///< number of the element at whose first visit the program starts
  std::optional<std::int64_t> from_pass;     ///< number, from 1, of the pass of this visit at which the program starts
  std::optional<std::int64_t> stop_every;    ///< an optional stop after so many visits of elements
  std::optional<double> split_hours;         ///< no program takes longer, if one visit does not
  std::string before;  ///< only the stages before that one, or before all of its group; empty: all
};

/// Seconds by what they are spent on.
struct TimeShares {
  double cutting_s = 0.0;  ///< plunging and ploughing, approach included
  double dwell_s = 0.0;
  double retract_s = 0.0;  ///< retracting and moving on within an element
  double rapid_s = 0.0;    ///< between elements
  double fixed_s = 0.0;    ///< rotary moves and the moves to and from the safe height: whatever the number of elements

  double total_s() const { return cutting_s + dwell_s + retract_s + rapid_s + fixed_s; }
};

/// One routine in one pose, for all elements of that orientation.
struct Stage {
  std::string name;      ///< "roughing", "finishing-1-facet-1", "layer-3-facet-2", with "-turned" for rotated elements
  std::size_t pose = 0;  ///< index in Plan::poses
  std::uint32_t subroutine = 0;
  bool roughs = false;
  int cut = 0;  ///< of `cuts`, from 1; 0 for roughing
  int cuts = 0;
  double left_mm = 0.0;     ///< then over the design, on the facets that it cuts
  std::int64_t visits = 0;  ///< that were planned
  TimeShares time;
};

/// A stop of a program, before the visit of an element.
struct PlannedStop {
  std::size_t program = 0;
  StopReason reason = StopReason::time;
  std::size_t stage = 0;     ///< index in Plan::stages
  std::int32_t element = 0;  ///< that the program goes on with
  double at_s = 0.0;         ///< since the program began
  EdgeUse used;              ///< since the stop before it, or since the edge began
};

/// Number of a program's first subroutine.
inline constexpr int kFirstSubroutine = 101;

/// A job as the moves of a machine.
struct Plan {
  std::vector<CutElement> elements;
  std::vector<CuttingPose> poses;
  std::vector<Stage> stages;  ///< that were requested
  std::vector<Subroutine> subroutines;
  int cuts_per_facet = 0;
  int passes = 1;                  ///< side by side, for elements wider than the tool
  int c_rotations = 0;             ///< moves of C by more than 45 degrees, the last return to 0 included
  double safe_z_mm = 0.0;          ///< height at which the rotary axes turn
  double stock_mm = 0.0;           ///< by which a blank with a base stands over its elements' rims
  double aperture_area_mm2 = 0.0;  ///< of all elements that are cut
  TimeShares time;
  std::vector<double> program_times_s;
  std::vector<PlannedStop> stops;
  std::vector<double> program_cuts_mm;  ///< length of cut of each program
  std::vector<Program> programs;
};

/// Plans a job on a machine.
/// \throw InputError for a job that the machine cannot do (which axis, which element), or options without meaning
Plan make_plan(const Job& job, const Machine& machine, const PlanOptions& options = {});

/// The least height of machine Z above which no corner of the blank, all of which lies below z = 0, comes while A goes
/// from 0 to that of the poses and C turns all the way; `rotary_clearance_mm` on top.
double safe_height_mm(const Job& job, const Machine& machine, const std::vector<CuttingPose>& poses);

}  // namespace retrace::fabrication
