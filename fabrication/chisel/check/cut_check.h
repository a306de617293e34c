#pragma once

// What the checks of single processes have in common: they follow the cuts of a tool within elements.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/number_format.h"
#include "fabrication/check/control_check.h"
#include "fabrication/chisel/check/facet_cut.h"
#include "fabrication/chisel/check/workpiece.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// A move of the tool within an element, in a pose.
struct CutMove {
  const NcMotion& motion;
  const SweptVolume& sweep;
  const RigidMotion& there;  ///< from the workpiece to the machine
  const RigidMotion& back;
  std::size_t element = 0;
};

/// Judges depths, dwells and chips by the rules of one process.
class CutCheck {
 public:
  /// All arguments must outlive it.
  CutCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, ControlCheck& control, FindingList& findings)
      : workpiece_(workpiece),
        process_(workpiece.job->process),
        wedge_(wedge),
        control_(control),
        findings_(findings) {}
  virtual ~CutCheck() = default;

  /// A move at a feed within the material of an element.
  virtual void move(const CutMove& cut) = 0;
  virtual void dwell(double seconds) = 0;
  /// The tool has left the material, or turned, or the program ends.
  virtual void close() = 0;
  /// After the last program.
  virtual void finish() {}

 protected:
  /// Tips of two cuts that are the same.
  static constexpr double kSameTipMm = 5e-7;

  void find(std::string kind, const NcPlace& place, std::size_t element, std::string message, double value = 0.0,
            double limit = 0.0) {
    findings_.add(std::move(kind), place.line, std::move(message), value, limit, static_cast<std::int64_t>(element));
  }
  /// That a cut runs along a facet, and at no feed above that of its stage, which what it sweeps tells.
  void check_feed(const CutMove& cut) {
    const auto along = facet_cut(workpiece_.grooves[cut.element], wedge_, cut.sweep, cut.back);
    if (!along)
      find("off_facet", cut.motion.place, cut.element,
           "the edge cuts along none of the facets: the axes stand in no pose of this element");
    const bool finishes = along && is_finishing(workpiece_, *along);
    control_.feed(cut.motion, finishes ? process_.finishing_feed_mm_per_min : process_.roughing_feed_mm_per_min);
  }
  /// Whether a dwell is as long as the process asks for; a billionth is rounding of the text.
  bool is_long_enough(double seconds) const { return seconds >= process_.dwell_s - 1e-9; }
  void find_clearance_face(const CutMove& cut) {
    find("clearance_face_leads", cut.motion.place, cut.element,
         "the tool is pushed into the material by its clearance face");
  }

  const Workpiece3d& workpiece_;
  const Process& process_;
  const ToolWedge& wedge_;
  ControlCheck& control_;
  FindingList& findings_;
};

/// Of a cut that is too thin for its edge.
inline std::string rubbing_text(double takes_um, double least_um) {
  return fmt::format("the cut takes {} um at most, all along it, and the edge rubs below {} um", fixed(takes_um, 4),
                     shortest(least_um));
}

/// Share of a cutting move that may lead towards the facet: rounding of its end points.
inline constexpr double kMostSlip = 1e-3;

}  // namespace retrace::fabrication
