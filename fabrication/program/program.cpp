#include "fabrication/program/program.h"

#include <cmath>

namespace retrace::fabrication {
namespace {

LinearPosition increments_of(const Move& move) {
  return {move.to[kX].value_or(0), move.to[kY].value_or(0), move.to[kZ].value_or(0)};
}

class Walker {
 public:
  Walker(const Program& program, const std::function<void(const PlannedMove&)>& sink)
      : program_(program), sink_(sink) {}

  void operator()(const Comment&) {}
  void operator()(const Message&) {}
  void operator()(const OptionalStop&) {}
  void operator()(const Stop&) { at_ = kBeginning; }
  void operator()(const Move& move) { tell(move, -1); }
  void operator()(const Path& path) {
    for (const Move& move : path.moves) tell(move, -1);
  }
  void operator()(const CycleCall& visit) {
    for (const Move& move : approach(at_, visit)) tell(move, visit.element);
    cut(program_.subroutines[visit.subroutine], visit.element);
  }

 private:
  void tell(const Move& move, std::int32_t element) {
    go_to(at_, move.to);
    sink_({move, at_, 0.0, element});
  }

  void cut(const Subroutine& subroutine, std::int32_t element) {
    std::optional<PlannedMove> pending;
    const auto flush = [&] {
      if (pending) sink_(*pending);
      pending.reset();
    };
    for (const Step& step : subroutine.steps) {
      if (const auto* dwell = std::get_if<Dwell>(&step)) {
        if (pending) pending->dwell_s += 1e-3 * dwell->ms;
        continue;
      }
      flush();
      Move move = std::get<Move>(step);
      move.to = linear_words(LinearPosition(*at_[kX], *at_[kY], *at_[kZ]) + increments_of(move));
      go_to(at_, move.to);
      pending = PlannedMove{move, at_, 0.0, element};
    }
    flush();
  }

  const Program& program_;
  const std::function<void(const PlannedMove&)>& sink_;
  static constexpr AxisWords kBeginning = {std::nullopt, std::nullopt, std::nullopt, 0, 0};
  AxisWords at_ = kBeginning;
};

}  // namespace

Nanometres nanometres(double mm) {
  return std::llround(mm * kNanometresPerMm);
}

RotaryUnits rotary_units(double deg) {
  return std::llround(deg * kRotaryUnitsPerDeg);
}

AxisWords linear_words(const LinearPosition& place) {
  return {place.x(), place.y(), place.z(), std::nullopt, std::nullopt};
}

Move increment(Motion motion, const LinearPosition& by, double feed_mm_per_min) {
  Move move{motion, {}, feed_mm_per_min, 0.0};
  for (const Axis axis : {kX, kY, kZ})
    if (by[axis] != 0) move.to[axis] = by[axis];
  return move;
}

void go_to(AxisWords& at, const AxisWords& to) {
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    if (to[axis]) at[axis] = to[axis];
}

MoveExtent extent_of(const Subroutine& subroutine) {
  MoveExtent reach;
  for (const Step& step : subroutine.steps) {
    const auto* const move = std::get_if<Move>(&step);
    if (move == nullptr) continue;
    reach.end += increments_of(*move);
    reach.low = reach.low.cwiseMin(reach.end).eval();
    reach.high = reach.high.cwiseMax(reach.end).eval();
  }
  return reach;
}

std::vector<Move> approach(const AxisWords& from, const CycleCall& visit) {
  Move across;
  Move along;
  for (const Axis axis : {kX, kY, kZ}) {
    const Nanometres to = visit.start[axis];
    if (from[axis] != to) (axis == kZ ? along : across).to[axis] = to;
  }
  const bool rises = from[kZ] && *from[kZ] < visit.start.z();
  std::vector<Move> moves;
  if (rises) moves.push_back(along);
  if (across.to[kX] || across.to[kY]) moves.push_back(across);
  if (!rises && along.to[kZ]) moves.push_back(along);
  return moves;
}

void for_each_move(const Program& program, const std::function<void(const PlannedMove&)>& sink) {
  Walker walker(program, sink);
  for (const Item& item : program.items) std::visit(walker, item);
}

}  // namespace retrace::fabrication
