#pragma once

// Base class for the checks of cuts. Each derived class checks the cuts of one machining process.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/number_format.h"
#include "fabrication/check/control_check.h"
#include "fabrication/chisel/check/facet_cut.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Move of the tool in an element, in one pose of the rotary axes.
struct CutMove {
  const NcMotion& motion;
  const SweptVolume& sweep;
  const RigidMotion& there;  ///< transformation from the workpiece frame to the machine frame
  const RigidMotion& back;   ///< transformation from the machine frame to the workpiece frame
  std::size_t element = 0;
};

/// Checks the depths of cut, the dwells and the chips according to the rules of one machining process.
class CutCheck {
 public:
  /// \pre all arguments outlive this object
  CutCheck(const VerificationModel& workpiece, const ToolWedge& wedge, ControlCheck& control, FindingList& findings)
      : workpiece_(workpiece),
        process_(workpiece.job->process),
        wedge_(wedge),
        control_(control),
        findings_(findings) {}
  virtual ~CutCheck() = default;

  /// Checks a cutting move in the material of an element.
  virtual void move(const CutMove& cut) = 0;
  virtual void dwell(double seconds) = 0;
  /// Ends the current cut. This function is called when the tool leaves the material, a rotary axis moves, or the
  /// program ends.
  virtual void close() = 0;
  /// Ends the checks after the last program.
  virtual void finish() {}

 protected:
  /// Maximum distance, in mm, between the tip positions of two cuts that are considered equal.
  static constexpr double kSameTipMm = 5e-7;

  void find(std::string kind, const NcLocation& place, std::size_t element, std::string message, double value = 0.0,
            double limit = 0.0) {
    findings_.add(std::move(kind), place.line, std::move(message), value, limit, static_cast<std::int64_t>(element));
  }
  /// Checks that a cut follows a facet, and that its feed is allowed. The swept plane determines whether the feed for
  /// roughing or the feed for finishing applies.
  void check_feed(const CutMove& cut) {
    const auto along = facet_cut(workpiece_.design(cut.element), wedge_, cut.sweep, cut.back);
    if (!along)
      find("off_facet", cut.motion.location, cut.element,
           "the edge does not cut along any facet: the rotary axes are not in a pose of this element");
    const bool finishes = along && is_finishing(workpiece_, *along);
    control_.feed(cut.motion, finishes ? process_.finishing_feed_mm_per_min : process_.roughing_feed_mm_per_min);
  }
  /// Returns true if a dwell is at least as long as the process requires. The tolerance allows for rounded numbers.
  bool is_long_enough(double seconds) const { return seconds >= process_.dwell_s - 1e-9; }
  void find_clearance_face(const CutMove& cut) {
    find("clearance_face_leads", cut.motion.location, cut.element,
         "the tool is pushed into the material by its clearance face");
  }

  const VerificationModel& workpiece_;
  const Process& process_;
  const ToolWedge& wedge_;
  ControlCheck& control_;
  FindingList& findings_;
};

/// Returns the message for a cut that is too thin for the edge.
inline std::string rubbing_text(double takes_um, double min_um) {
  return fmt::format(
      "the cut removes at most {} um along its whole length, but the edge rubs instead of cutting below {} um",
      fixed(takes_um, 4), shortest(min_um));
}

/// Maximum component of a cut's direction along the outward normal of the clearance face. Both are unit vectors. A
/// larger component means that the clearance face is pushed into the material. The limit allows for rounded end points
/// of the move.
inline constexpr double kMaxClearanceCosine = 1e-3;

}  // namespace retrace::fabrication
