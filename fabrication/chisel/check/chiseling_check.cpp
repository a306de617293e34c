#include "fabrication/chisel/check/chiseling_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "fabrication/job/fins.h"

namespace retrace::fabrication {

using geometry::Vec3;

ChiselingCheck::ChiselingCheck(const VerificationModel& workpiece, const ToolWedge& wedge, ControlCheck& control,
                               FindingList& findings)
    : CutCheck(workpiece, wedge, control, findings) {
  for (const Cavity& groove : workpiece.cavities) {
    const auto& cavity = std::get<CubeCavity>(groove);
    State state;
    // Before the first cut, the whole cavity is filled with material. This is equivalent to a layer with its apex in
    // the face of the blank.
    state.remaining_mm.fill((cavity.face_mm - cavity.axis.dot(cavity.root_mm)) / cavity.layer_rise);
    states_.push_back(state);
  }
}

void ChiselingCheck::move(const CutMove& cut) {
  check_feed(cut);
  const Vec3 travel = cut.sweep.to_mm - cut.sweep.from_mm;
  if (travel.dot(wedge_.sides[0].outward) > kMaxClearanceCosine * travel.norm()) find_clearance_face(cut);
  const bool goes_down = workpiece_.design(cut.element).axis.dot(cut.back.direction(travel)) < 0.0;
  if (goes_down) {
    close();
    open(cut);
  } else if (open_) {
    open_->went_up = true;
  }
}

void ChiselingCheck::open(const CutMove& move) {
  const DesignElement& cavity = workpiece_.design(move.element);
  const Vec3 clearance_face = move.back.direction(wedge_.sides[0].outward);
  OpenCut cut;
  cut.element = move.element;
  cut.location = move.sweep.location;
  double best = 2.0;
  const Vec3 tip = move.back.point(move.sweep.to_mm);
  for (std::size_t f = 0; f < 3; ++f) {
    cut.tip_mm[f] = cavity.facets[f].height_mm(tip);
    // Use the facet whose normal is most nearly opposite to the normal of the clearance face. This is the facet that is
    // cut.
    const double towards = cavity.facets[f].normal.dot(clearance_face);
    if (towards >= best) continue;
    best = towards;
    cut.facet = f;
  }
  check_layer(cut, states_[move.element]);
  open_ = cut;
}

double ChiselingCheck::short_limit_mm(const OpenCut& cut, std::size_t other) const {
  const DesignElement& cavity = workpiece_.design(cut.element);
  const Vec3& normal = cavity.facets[cut.facet].normal;
  const double cosine = normal.dot(cavity.facets[other].normal);
  const double sine = normal.cross(cavity.facets[other].normal).norm();
  const double step_mm = workpiece_.prediction(cut.element).step_mm;
  const double rounded_mm = (1.0 - cosine) * rounded_across_mm(step_mm) + sine * rounded_along_mm(step_mm);
  return std::max(workpiece_.tolerance_mm, rounded_mm);
}

double ChiselingCheck::layer_limit_mm(std::size_t element) const {
  return std::max(workpiece_.tolerance_mm, 2.0 * rounded_across_mm(workpiece_.prediction(element).step_mm));
}

void ChiselingCheck::check_layer(const OpenCut& cut, const State& state) {
  const double tip_mm = cut.tip_mm[cut.facet];
  const double chip_mm = state.remaining_mm[cut.facet] - tip_mm;
  const double least_mm = 1e-3 * process_.min_chip_um.value_or(0.0);
  if (std::abs(chip_mm) < kSameTipMm)
    find("cut_twice", cut.location, cut.element, "an equal cut was already made");
  else if (chip_mm > 0.0 && chip_mm < least_mm - kSameTipMm)
    find("rubs", cut.location, cut.element, rubbing_text(1e3 * chip_mm, 1e3 * least_mm), 1e3 * chip_mm, 1e3 * least_mm);
  for (std::size_t g = 0; g < 3; ++g) {
    const double short_mm = cut.tip_mm[g] - tip_mm;
    const double limit_mm = short_limit_mm(cut, g);
    if (short_mm > limit_mm)
      find("chip_not_separated", cut.location, cut.element,
           fmt::format("the tip stops {} um above the apex of its layer: the chip does not separate",
                       fixed(1e3 * short_mm, 3)),
           1e3 * short_mm, 1e3 * limit_mm);
  }
  const double limit_mm = layer_limit_mm(cut.element);
  const auto [least, most] = std::minmax_element(state.remaining_mm.begin(), state.remaining_mm.end());
  const double hangs_mm = *most - *least;
  const bool begins_layer = tip_mm < *least - limit_mm;
  if (begins_layer && hangs_mm > limit_mm)
    find("chip_not_separated", cut.location, cut.element,
         fmt::format(
             "facet {} was not cut as deep as the other facets before the next layer: its chip does not separate",
             most - state.remaining_mm.begin() + 1),
         1e3 * hangs_mm, 1e3 * limit_mm);
}

void ChiselingCheck::dwell(double seconds) {
  if (open_ && !open_->went_up) open_->dwell_s += seconds;
}

void ChiselingCheck::close() {
  if (!open_) return;
  if (!is_long_enough(open_->dwell_s))
    find("missing_dwell", open_->location, open_->element,
         fmt::format("the cut changes its direction at the apex without the dwell of {} s", shortest(process_.dwell_s)),
         0, process_.dwell_s);
  if (!open_->went_up)
    find("chip_not_separated", open_->location, open_->element,
         "the cut does not move up its second dihedral edge: its chip does not separate");
  State& state = states_[open_->element];
  state.remaining_mm[open_->facet] = std::min(state.remaining_mm[open_->facet], open_->tip_mm[open_->facet]);
  state.last = open_->location;
  open_.reset();
}

void ChiselingCheck::finish() {
  close();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const State& state = states_[i];
    const auto [least, most] = std::minmax_element(state.remaining_mm.begin(), state.remaining_mm.end());
    const double limit_mm = layer_limit_mm(i);
    if (state.last.line == 0 || *most - *least <= limit_mm) continue;
    find("layer_unfinished", state.last, i,
         "the last layer was not cut on all three facets: its chip does not separate", 1e3 * (*most - *least),
         1e3 * limit_mm);
  }
}

}  // namespace retrace::fabrication
