#include "fabrication/verify/chiseling_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Tips of two cuts that are the same.
constexpr double kSameCavityTipMm = 5e-7;

}  // namespace

ChiselingCheck::ChiselingCheck(const Job& job, const std::vector<Groove>& cavities, double tolerance_mm, Report report)
    : job_(job), cavities_(cavities), tolerance_mm_(tolerance_mm), report_(std::move(report)) {
  for (const Groove& cavity : cavities) {
    State state;
    // Where the blank's face cuts the axis, which makes equal angles with the facets.
    state.left_mm.fill((cavity.face_mm - cavity.axis.dot(cavity.root_mm)) / std::numbers::sqrt3);
    states_.push_back(state);
  }
}

void ChiselingCheck::move(const SweptVolume& sweep, const RigidMotion& back, const ToolWedge& wedge,
                          std::size_t element) {
  const bool goes_down = cavities_[element].axis.dot(back.direction(sweep.to_mm - sweep.from_mm)) < 0.0;
  if (goes_down) {
    close();
    open(sweep, back, wedge, element);
  } else if (open_) {
    open_->went_up = true;
  }
}

void ChiselingCheck::open(const SweptVolume& sweep, const RigidMotion& back, const ToolWedge& wedge,
                          std::size_t element) {
  const Groove& cavity = cavities_[element];
  const Vec3 clearance_face = back.direction(wedge.sides[0].outward);
  OpenCut cut;
  cut.element = element;
  cut.place = sweep.place;
  double best = 2.0;
  const Vec3 tip = back.point(sweep.to_mm);
  for (std::size_t f = 0; f < 3; ++f) {
    cut.tip_mm[f] = cavity.facets[f].height_mm(tip);
    // The clearance face looks at the facet that is cut.
    const double towards = cavity.facets[f].normal.dot(clearance_face);
    if (towards >= best) continue;
    best = towards;
    cut.facet = f;
  }
  check_layer(cut, states_[element]);
  open_ = cut;
}

void ChiselingCheck::check_layer(const OpenCut& cut, const State& state) {
  const auto number = static_cast<std::int64_t>(cut.element);
  const double tip_mm = cut.tip_mm[cut.facet];
  const double chip_mm = state.left_mm[cut.facet] - tip_mm;
  const double deepest_um = std::max(job_.process.roughing_depth_um, job_.process.finishing_depth_um);
  const double limit_mm = 1e-3 * deepest_um + tolerance_mm_;
  if (chip_mm > limit_mm)
    report_("chip_too_thick", cut.place, number,
            fmt::format("the cut takes {} um at once, the process {} um: a layer before it is missing",
                        fixed(1e3 * chip_mm, 3), shortest(deepest_um)),
            1e3 * chip_mm, 1e3 * limit_mm);
  if (std::abs(chip_mm) < kSameCavityTipMm)
    report_("cut_twice", cut.place, number, "this cut has been made before", 0, 0);
  for (std::size_t g = 0; g < 3; ++g) {
    if (g == cut.facet) continue;
    const double short_mm = cut.tip_mm[g] - tip_mm;
    if (short_mm > tolerance_mm_)
      report_("chip_not_separated", cut.place, number,
              fmt::format("the tip stops {} um short of its layer's apex: the chip hangs on", fixed(1e3 * short_mm, 3)),
              1e3 * short_mm, 1e3 * tolerance_mm_);
    const double hangs_mm = state.left_mm[g] - state.left_mm[cut.facet];
    if (hangs_mm > tolerance_mm_)
      report_("chip_not_separated", cut.place, number,
              fmt::format("facet {} was not cut as deep as facet {} before the next layer: its chip hangs on", g + 1,
                          cut.facet + 1),
              1e3 * hangs_mm, 1e3 * tolerance_mm_);
  }
}

void ChiselingCheck::dwell(double seconds) {
  // A billionth is rounding of the text.
  if (open_ && !open_->went_up && seconds >= job_.process.dwell_s - 1e-9) open_->has_dwell = true;
}

void ChiselingCheck::close() {
  if (!open_) return;
  const auto number = static_cast<std::int64_t>(open_->element);
  if (!open_->has_dwell && job_.process.dwell_s > 0.0)
    report_("missing_dwell", open_->place, number,
            fmt::format("the cut turns at the apex without its dwell of {} s", shortest(job_.process.dwell_s)), 0,
            job_.process.dwell_s);
  if (!open_->went_up)
    report_("chip_not_separated", open_->place, number, "the cut does not go up its second edge: its chip hangs on", 0,
            0);
  State& state = states_[open_->element];
  state.left_mm[open_->facet] = std::min(state.left_mm[open_->facet], open_->tip_mm[open_->facet]);
  state.last = open_->place;
  open_.reset();
}

void ChiselingCheck::finish() {
  close();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const State& state = states_[i];
    const auto [least, most] = std::minmax_element(state.left_mm.begin(), state.left_mm.end());
    if (state.last.line == 0 || *most - *least <= tolerance_mm_) continue;
    report_("chip_not_separated", state.last, static_cast<std::int64_t>(i),
            "the last layer was not cut on all three facets: its chip hangs on", 1e3 * (*most - *least),
            1e3 * tolerance_mm_);
  }
}

}  // namespace retrace::fabrication
