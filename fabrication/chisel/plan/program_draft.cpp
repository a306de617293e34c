#include "fabrication/chisel/plan/program_draft.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fabrication/chisel/plan/move_time.h"

namespace retrace::fabrication {

using geometry::Vec3;

ProgramDraft::ProgramDraft(const Job& job, const Machine& machine, const SafeHeights& heights, TimeBreakdown& plan_time)
    : job_(job), machine_(machine), heights_(heights), plan_time_(plan_time), tool_life_(job) {
  program_.tilt_letter = machine.tilt_letter();
  program_.control = machine.control;
  program_.has_mist = program_.needs_mist = job.process.mist;
  raise_to(heights.first_nm);
}

void ProgramDraft::raise() {
  raise_to(at_[kZ] ? std::max(*at_[kZ], heights_.safe_nm) : heights_.safe_nm);
}

void ProgramDraft::raise_to(Nanometres z_nm) {
  if (at_[kZ] != z_nm) {
    Move up;
    up.to[kZ] = z_nm;
    go(up, &TimeBreakdown::fixed_s);
    add(up);
  }
  just_raised_ = true;
}

/// Returns the angle by which a rotary axis rotates when its programmed position changes by `units`. If the axis takes
/// the shortest path, the angle is at most half a turn in either direction.
RotaryUnits ProgramDraft::rotation(char axis, RotaryUnits units) const {
  if (machine_.shortest_axes.find(axis) == std::string::npos) return units;
  return rotary_units(std::remainder(degrees(units), 360.0));
}

void ProgramDraft::rotate_to(RotaryUnits a, RotaryUnits c) {
  // At the start of a program, the rotary positions are not known. They are assumed to be 0, because programs end at 0.
  const RotaryUnits by_a = rotation(machine_.tilt_letter(), a - at_[kTilt].value_or(0));
  const RotaryUnits by_c = rotation('C', c - at_[kC].value_or(0));
  if (at_[kTilt] == a && at_[kC] == c) return;
  raise();
  constexpr double kRotationDeg = 45.0;
  if (std::abs(degrees(by_c)) > kRotationDeg) ++c_rotations_;
  add_time(&TimeBreakdown::fixed_s, rotary_move_s(machine_, degrees(by_a), degrees(by_c)));
  Move turn;
  turn.to[kTilt] = a;
  turn.to[kC] = c;
  add(turn);
  go_to(at_, turn.to);
}

void ProgramDraft::traverse(Axis axis, double to_mm) {
  Move move;
  move.to[axis] = to_step(to_mm * kNanometresPerMm, machine_.increments.linear_nm);
  go(move, &TimeBreakdown::fixed_s);
  add(move);
}

void ProgramDraft::add_cycle_call(const CycleCall& call, const LinearPosition& end, const TimeBreakdown& routine,
                                  Stage& stage) {
  for (const Move& move : approach(at_, call))
    go(move, just_raised_ ? &TimeBreakdown::fixed_s : &TimeBreakdown::rapid_s, &stage);
  just_raised_ = false;
  for (double TimeBreakdown::*const part :
       {&TimeBreakdown::cutting_s, &TimeBreakdown::dwell_s, &TimeBreakdown::retract_s})
    add_time(part, routine.*part, &stage);
  go_to(at_, linear_words(call.start + end));
  add(call);
  used_.insert(call.subroutine);
}

void ProgramDraft::cut(double mm) {
  tool_life_.add_cut(mm);
  cut_mm_ += mm;
}

void ProgramDraft::park() {
  raise_to(std::max(*at_[kZ], heights_.first_nm));
  rotate_to(0, 0);
}

void ProgramDraft::stop(StopReason reason, std::string comment) {
  add(Stop{stop_text(job_, reason, ++stops_)});
  add(Comment{std::move(comment)});
  tool_life_.stop();
  at_ = {};
  raise_to(heights_.first_nm);
}

void ProgramDraft::go(const Move& move, double TimeBreakdown::*part, Stage* stage) {
  Vec3 by = Vec3::Zero();
  for (const Axis axis : {kX, kY, kZ})
    if (move.to[axis] && at_[axis]) by[axis] = millimetres(*move.to[axis] - *at_[axis]);
  add_time(part, linear_move_s(machine_, by, std::nullopt), stage);
  go_to(at_, move.to);
}

void ProgramDraft::add_time(double TimeBreakdown::*part, double seconds, Stage* stage) {
  plan_time_.*part += seconds;
  if (stage != nullptr) stage->time.*part += seconds;
  seconds_ += seconds;
  tool_life_.add_time(seconds);
}

Program ProgramDraft::take(const std::vector<Subroutine>& all, bool only_used) {
  if (!only_used) {
    program_.subroutines = all;
    return std::move(program_);
  }
  std::map<std::uint32_t, std::uint32_t> places;
  for (const std::uint32_t index : used_) {
    places[index] = static_cast<std::uint32_t>(program_.subroutines.size());
    program_.subroutines.push_back(all[index]);
    program_.subroutines.back().number = kFirstSubroutine + static_cast<int>(program_.subroutines.size()) - 1;
  }
  for (Item& item : program_.items)
    if (auto* const visit = std::get_if<CycleCall>(&item)) visit->subroutine = places.at(visit->subroutine);
  return std::move(program_);
}

}  // namespace retrace::fabrication
