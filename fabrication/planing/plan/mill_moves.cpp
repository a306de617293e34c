#include "fabrication/planing/plan/mill_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

std::int64_t steps_up(double length_mm, double grid_mm) {
  return static_cast<std::int64_t>(std::ceil(length_mm / grid_mm - 1e-9));
}

}  // namespace

MillMoves::MillMoves(const PlanedPart& part, std::string set) : part_(part), set_(std::move(set)) {
  const PlaningMill& mill = *part.mill;
  min_steps_ = {steps_up(mill.min_move_x_mm, mill.grid_mm), steps_up(mill.min_move_y_mm, mill.grid_mm),
                steps_up(mill.min_move_z_mm, mill.grid_mm)};
  const std::int64_t run_out = steps_up(mill.overrun_mm, mill.grid_mm);
  home_ = {0, -run_out, steps_up(mill.clearance_mm, mill.grid_mm)};
  stroke_end_ = steps_up(part.length_mm, mill.grid_mm) + run_out;
  begin();
}

void MillMoves::begin() {
  state_ = {};
  state_.at.set = set_;
  state_.position = home_;
  const double nm = kNanometresPerMm * part_.mill->grid_mm;
  state_.at.program.header = {"one half of the lens: turn the part by 180 degrees and run it again",
                              "begins where the axes stand at its first three words"};
  // The first moves only contain the start positions, at which the axes were set to zero. The axes therefore do not
  // move.
  state_.at.program.has_mist = false;
  for (const Axis axis : {kZ, kX, kY}) {
    Move here;
    here.to[axis] = std::llround(static_cast<double>(home_[axis]) * nm);
    state_.at.program.items.emplace_back(here);
  }
}

MillMoves::Snapshot MillMoves::snapshot() const {
  return {state_.at.program.items.size(), state_.at.frames, state_.at.cuts, state_.at.time_s, state_.position};
}

void MillMoves::restore(const Snapshot& mark) {
  state_.at.program.items.resize(mark.items);
  state_.at.frames = mark.frames;
  state_.at.cuts = mark.cuts;
  state_.at.time_s = mark.time_s;
  state_.position = mark.position;
}

void MillMoves::begin_next() {
  return_to_centre();
  done_.push_back(std::move(state_.at));
  begin();
}

double MillMoves::time_of(std::int64_t steps) const {
  return static_cast<double>(std::abs(steps)) * part_.mill->grid_mm / part_.mill->fast_feed_mm_per_min * 60.0 +
         part_.mill->frame_s;
}

bool MillMoves::ends_in_time() const {
  // Include the time of the moves back to the centre: a move of Z, and a move of X with a detour of twice its minimum
  // move.
  const double home_s =
      time_of(state_.position[kZ] - home_[kZ]) + time_of(state_.position[kX]) + time_of(2 * min_steps_[kX]);
  return state_.at.time_s + home_s <= 3600.0 * part_.mill->max_hours;
}

void MillMoves::require_in_time() const {
  if (!ends_in_time())
    throw InputError(
        fmt::format("a single cut, or a single depth of all cuts, takes longer than {} hours, the maximum time of a "
                    "program (mill.max_hours)",
                    shortest(part_.mill->max_hours)));
}

void MillMoves::single(Axis axis, std::int64_t to) {
  Move move;
  move.to[axis] = std::llround(static_cast<double>(to) * part_.mill->grid_mm * kNanometresPerMm);
  state_.at.program.items.emplace_back(move);
  state_.at.time_s += time_of(to - state_.position[axis]);
  ++state_.at.frames;
  state_.position[axis] = to;
}

void MillMoves::move(Axis axis, std::int64_t to) {
  const std::int64_t way = to - state_.position[axis];
  if (way == 0) return;
  if (std::abs(way) < min_steps_[axis]) {
    // The detour of Z is upwards, so that nothing is cut. The detour of X is away from the edge of the lens, so that
    // the travel is not larger than the lens.
    const bool positive_first = axis == kZ || state_.position[axis] < 2 * min_steps_[axis];
    const std::int64_t detour = positive_first ? std::max(state_.position[axis], to) + min_steps_[axis]
                                               : std::min(state_.position[axis], to) - min_steps_[axis];
    single(axis, detour);
  }
  single(axis, to);
}

void MillMoves::lower_to(std::int64_t depth) {
  move(kZ, -depth);
}

void MillMoves::across_to(std::int64_t x) {
  move(kX, x);
}

void MillMoves::stroke() {
  move(kY, stroke_end_);
  move(kY, home_[kY]);
  ++state_.at.cuts;
}

void MillMoves::return_to_centre() {
  move(kZ, home_[kZ]);
  move(kX, home_[kX]);
}

std::vector<PlannedProgram> MillMoves::finish() {
  return_to_centre();
  if (state_.at.cuts > 0) done_.push_back(std::move(state_.at));
  return std::move(done_);
}

}  // namespace retrace::fabrication
