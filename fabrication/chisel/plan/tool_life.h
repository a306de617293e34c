#pragma once

// Computes how much a cutting edge is used (length of cut and run time) and decides where a program must stop.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fabrication/chisel/plan/section.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Returns the length of cut of a visit, which is one call of a subroutine at an element. It is the length of the tip's
/// path below the blank's face, along plunges and ploughs. For a V-shaped tool, it is the length of the path down and
/// up the dihedral edges.
/// \param stock_mm height of the blank's face above the rims
double length_of_cut_mm(const Job& job, const Machine& machine, const CutElement& element, const CuttingPose& pose,
                        const CycleCall& visit, const Subroutine& routine, double stock_mm);

/// Reason for a stop of a program: tool life, run time, or inspection before finishing.
enum class StopReason : std::uint8_t { edge, time, finishing };
/// Names of the reasons in documents, in the order of the enumerators.
inline constexpr std::string_view kStopReasonWords[] = {"edge", "time", "finishing"};

/// Use of a cutting edge, by one visit or since the last stop: length of cut and run time.
struct ToolWear {
  double cut_mm = 0.0;
  double seconds = 0.0;
};

/// Adds up the length of cut and the run time of the edge in use, in one program. Decides whether a stop or a new
/// program is required before the next visit.
class ToolLife {
 public:
  explicit ToolLife(const Job& job) : job_(job) {}

  void stop();
  void add_time(double seconds) { wear_.seconds += seconds; }
  void add_cut(double mm) { wear_.cut_mm += mm; }
  const ToolWear& wear() const { return wear_; }

  /// Returns the reason why a stop is required before a visit, or nothing if no stop is required.
  std::optional<StopReason> stop_before(const ToolWear& visit) const;
  /// Returns true if the visit needs a new edge and therefore a new program.
  bool needs_program(const ToolWear& visit) const;
  /// Checks that a new edge and a stop before the visit are sufficient to make the visit within the limits.
  /// \pre the edge has made no visit since its last stop
  /// \throw InputError that names the key, if the visit exceeds the tool life or the maximum run time
  void check(const ToolWear& visit, std::int32_t element) const;

 private:
  bool exceeds_tool_life(const ToolWear& visit) const;

  const Job& job_;
  ToolWear wear_;
};

/// Returns the message for the operator at a stop, in one line.
/// \param number number of the stop in its program, from 1
std::string stop_text(const Job& job, StopReason reason, int number);

}  // namespace retrace::fabrication
