#include "fabrication/chisel/check/stop_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Factor on limits that allows for rounded positions and times.
constexpr double kSlack = 1.0 + 1e-4;

}  // namespace

StopCheck::StopCheck(const VerificationModel& workpiece, const ToolWedge& wedge, FindingList& findings)
    : workpiece_(workpiece), wedge_(wedge), findings_(findings), roughed_after_(workpiece.cavities.size(), -1) {}

void StopCheck::begin(double now_s) {
  stop(now_s);
  cut_mm_ = 0.0;
  is_worn_ = false;
}

void StopCheck::stop(double now_s) {
  ++stops_;
  began_s_ = now_s;
  has_cut_ = is_late_ = false;
  if (workpiece_.job->tool.next_edge != NextEdge::stop) return;
  cut_mm_ = 0.0;
  is_worn_ = false;
}

void StopCheck::cut(const CutMove& cut, double now_s) {
  check_time(cut.motion.location, static_cast<std::int64_t>(cut.element), now_s);
  const auto along = facet_cut(workpiece_.design(cut.element), wedge_, cut.sweep, cut.back);
  if (!along) return;
  check_length(cut, *along);
  check_inspection(cut, *along);
}

void StopCheck::check_length(const CutMove& cut, const FacetCut& along) {
  const auto& life_mm = workpiece_.job->tool.edge_life_mm;
  const Vec3 travel = cut.sweep.to_mm - cut.sweep.from_mm;
  const DesignElement& design = workpiece_.design(cut.element);
  // A chisel that moves up along the plunged facet does not cut, so this move does not wear the edge.
  const bool is_chisel = std::holds_alternative<PrismGroove>(workpiece_.cavities[cut.element]);
  if (!life_mm || (is_chisel && along.is_by_clearance && travel.z() > 0.0)) return;
  const double from_mm = design.height_over_face_mm(cut.back.point(cut.sweep.from_mm));
  const double to_mm = design.height_over_face_mm(cut.back.point(cut.sweep.to_mm));
  const double below_mm = std::max(0.0, -from_mm) + std::max(0.0, -to_mm);
  const bool crosses = (from_mm > 0.0) != (to_mm > 0.0);
  if (below_mm > 0.0) cut_mm_ += travel.norm() * (crosses ? below_mm / std::abs(from_mm - to_mm) : 1.0);
  if (is_worn_ || cut_mm_ <= *life_mm * kSlack) return;
  is_worn_ = true;
  findings_.add("edge_worn", cut.motion.location.line,
                fmt::format("the edge has cut {} mm, which exceeds its tool life of {} mm",
                            fixed_apart(cut_mm_, *life_mm, 3), shortest(*life_mm)),
                cut_mm_, *life_mm, static_cast<std::int64_t>(cut.element));
}

void StopCheck::check_time(const NcLocation& place, std::int64_t element, double now_s) {
  const double ran_s = now_s - began_s_;
  const double warm_s = workpiece_.machine->warm_up_s.value;
  if (!has_cut_ && ran_s * kSlack < warm_s)
    findings_.add("cold", place.line,
                  fmt::format("the first cut begins {} s after the machine began to move, but the warm-up takes {} s",
                              fixed_apart(ran_s, warm_s, 1), shortest(warm_s)),
                  ran_s, warm_s, element);
  has_cut_ = true;
  const auto& most_min = workpiece_.job->process.stop_every_min;
  if (!most_min || is_late_ || ran_s <= 60.0 * *most_min * kSlack) return;
  is_late_ = true;
  findings_.add("stop_overdue", place.line,
                fmt::format("the program cuts {} min after its start or last stop, but at most {} min are allowed",
                            fixed(ran_s / 60.0, 3), shortest(*most_min)),
                ran_s / 60.0, *most_min, element);
}

void StopCheck::check_inspection(const CutMove& cut, const FacetCut& along) {
  std::int64_t& roughed = roughed_after_[cut.element];
  if (!is_finishing(workpiece_, along)) {
    roughed = stops_;
    return;
  }
  if (!workpiece_.job->process.stop_before_finishing || roughed != stops_) return;
  roughed = -1;
  findings_.add(
      "not_inspected", cut.motion.location.line,
      fmt::format("element {} is finished without a stop for inspection between roughing and finishing", cut.element),
      0.0, 0.0, static_cast<std::int64_t>(cut.element));
}

}  // namespace retrace::fabrication
