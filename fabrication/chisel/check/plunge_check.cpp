#include "fabrication/chisel/check/plunge_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Minimum downward component of the direction of a plunge, which is a unit vector.
constexpr double kMostlyDown = 0.9;
/// Returns true if a move is a retract. The plunged facet is vertical, and a plough moves along the other facet. A
/// retract moves up, at an angle to the vertical of at most two thirds of the apex angle.
bool retracts(const DesignElement& groove, const Vec3& travel) {
  const double apex_rad = std::acos(-groove.facets[0].normal.dot(groove.facets[1].normal));
  return travel.z() >= travel.norm() * std::cos(apex_rad * 2.0 / 3.0);
}

}  // namespace

void PlungeCheck::move(const CutMove& cut) {
  const Vec3 travel = cut.sweep.to_mm - cut.sweep.from_mm;
  if (retracts(workpiece_.design(cut.element), travel)) return close();
  // Only a retract may move the tool towards the facet that is next to the clearance face.
  if (travel.dot(plunged_normal(*workpiece_.machine)) < -kMaxClearanceCosine * travel.norm()) find_clearance_face(cut);
  if (travel.z() < -kMostlyDown * travel.norm()) return plunge(cut);
  plough(cut);
}

void PlungeCheck::dwell(double seconds) {
  if (open_) open_->dwell_s += seconds;
}

void PlungeCheck::check_dwell() {
  if (!is_long_enough(open_->dwell_s))
    find("missing_dwell", open_->location, open_->element,
         fmt::format("the plunge ends without its dwell of {} s", shortest(process_.dwell_s)), 0, process_.dwell_s);
}

void PlungeCheck::plunge(const CutMove& cut) {
  const auto& [motion, sweep, there, back, element] = cut;
  close();
  check_feed(cut);
  const DesignElement& groove = workpiece_.design(element);
  const Vec3 upright = there.direction(groove.facets[0].normal);
  OpenPlunge plunge;
  plunge.element = element;
  plunge.location = motion.location;
  // The normal of the plunged facet is opposite to the normal of the clearance face, and nearly horizontal.
  plunge.facet = upright.dot(wedge_.sides[0].outward) < 0.0 && std::abs(upright.z()) < 0.5 ? 0 : 1;
  plunge.tip_mm = {1e9, 1e9};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 tip = back.point(sweep.to_mm + side * wedge_.half_width_mm * wedge_.edge);
    for (std::size_t f = 0; f < 2; ++f) plunge.tip_mm[f] = std::min(plunge.tip_mm[f], groove.facets[f].height_mm(tip));
  }
  State& state = states_[element];
  const Vec3 tip = back.point(sweep.to_mm);
  // The chip thickness is limited by the last cut of this facet, or by the blank's face before the first cut.
  plunge.chip_mm = std::min(state.surface_mm[plunge.facet] - plunge.tip_mm[plunge.facet],
                            groove.to_face_mm(tip, groove.facets[plunge.facet].normal));
  for (const auto& known : state.tips)
    if (known[3] == static_cast<double>(plunge.facet) && (Vec3(known[0], known[1], known[2]) - tip).norm() < kSameTipMm)
      find("cut_twice", motion.location, element, "an equal cut was already made");
  state.tips.push_back({tip.x(), tip.y(), tip.z(), static_cast<double>(plunge.facet)});
  open_ = plunge;
}

void PlungeCheck::plough(const CutMove& cut) {
  check_feed(cut);
  if (!open_ || open_->element != cut.element) return;
  check_dwell();
  const double length_mm = (cut.sweep.to_mm - cut.sweep.from_mm).norm();
  const double chip_mm = std::min(open_->chip_mm, 1e-3 * process_.roughing_depth_um);
  if (length_mm < chip_mm - workpiece_.tolerance_mm)
    find("chip_not_separated", cut.motion.location, cut.element,
         fmt::format("the plough is {} um long and does not separate the chip, which is {} um thick",
                     fixed(1e3 * length_mm, 3), fixed(1e3 * chip_mm, 3)),
         1e3 * length_mm, 1e3 * chip_mm);
  State& state = states_[cut.element];
  for (std::size_t f = 0; f < 2; ++f) state.surface_mm[f] = std::min(state.surface_mm[f], open_->tip_mm[f]);
  state.last[open_->facet] = State::Plunge{open_->tip_mm, open_->location.line};
  open_.reset();
}

void PlungeCheck::close() {
  if (!open_) return;
  check_dwell();
  check_chip();
  State& state = states_[open_->element];
  state.surface_mm[open_->facet] = std::min(state.surface_mm[open_->facet], open_->tip_mm[open_->facet]);
  state.last[open_->facet] = State::Plunge{open_->tip_mm, open_->location.line};
  open_.reset();
}

/// Checks that the chip of a plunge separates without a plough. The chip separates if the plunge passes the machined
/// surface of the other facet. It also separates if the last plunge along the other facet has passed the plane of this
/// plunge.
void PlungeCheck::check_chip() {
  const std::size_t f = open_->facet;
  const std::size_t g = 1 - f;
  const State& state = states_[open_->element];
  // A large form tolerance must not hide a chip that does not separate. The tolerance is limited to a tenth of the
  // depth of cut.
  const double depth_mm = 1e-3 * std::min(process_.roughing_depth_um, process_.finishing_depth_um);
  const double tolerance_mm =
      std::min(workpiece_.tolerance_mm, 0.1 * depth_mm) + workpiece_.prediction(open_->element).root_mm;
  const bool passes = open_->tip_mm[g] < state.surface_mm[g] - tolerance_mm;
  if (passes) return;
  const auto& before = state.last[g];
  const bool meets = before && before->tip_mm[f] <= open_->tip_mm[f] + tolerance_mm;
  if (meets) return;
  find("chip_not_separated", open_->location, open_->element,
       "the chip of the plunge does not separate: the plunge does not extend beyond the other facet, and no cut along "
       "the other facet extends beyond the plunged facet",
       1e3 * (open_->tip_mm[g] - std::min(state.surface_mm[g], 1e3)), 0.0);
}

}  // namespace retrace::fabrication
