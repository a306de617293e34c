#pragma once

// How far edges cut, and when a program must stop.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fabrication/chisel/plan/section.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// The length of cut of a visit: the way of the tip below the plane where the element's blank begins, along plunges and
/// ploughs; of a V down and up dihedral edges. \param stock_mm by which the blank stands over the rims
double length_of_cut_mm(const Job& job, const Machine& machine, const CutElement& element, const CuttingPose& pose,
                        const Visit& visit, const Subroutine& routine, double stock_mm);

/// Why a program stops.
enum class StopReason : std::uint8_t { edge, time, finishing };
/// Words of documents, in the order of the enumerators.
inline constexpr std::string_view kStopReasonWords[] = {"edge", "time", "finishing"};

/// What is run from one stop to the next, or cut by one edge.
struct EdgeUse {
  double cut_mm = 0.0;
  double seconds = 0.0;
};

/// Adds up what is run, and tells what must come before more is.
class EdgeAccount {
 public:
  explicit EdgeAccount(const Job& job) : job_(job) {}

  void begin_program() { used_ = {}; }
  void stop();
  void spend(double seconds) { used_.seconds += seconds; }
  void cut(double mm) { used_.cut_mm += mm; }
  const EdgeUse& used() const { return used_; }

  /// Why the program must stop before a visit.
  std::optional<StopReason> stop_before(const EdgeUse& visit) const;
  /// Whether the visit is for the edge of a new program.
  bool needs_program(const EdgeUse& visit) const;
  /// That a visit can be made behind a stop. \param fresh_s that has run there
  /// \throw InputError naming the key for one that cuts or takes more than is allowed
  void check(const EdgeUse& visit, double fresh_s, std::int32_t element) const;

 private:
  bool wears_out(const EdgeUse& visit) const;

  const Job& job_;
  EdgeUse used_;
};

/// For the operator, in one line. \param number of the stop in its program, from 1
std::string stop_text(const Job& job, StopReason reason, int number);

}  // namespace retrace::fabrication
