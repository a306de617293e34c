#include "fabrication/program/program.h"

#include <algorithm>

namespace retrace::fabrication {
namespace {

class Walker {
 public:
  Walker(const Program& program, const std::function<void(const PlannedMove&)>& sink)
      : program_(program), sink_(sink) {}

  void operator()(const Comment&) {}
  void operator()(const Message&) {}
  void operator()(const OptionalStop&) {}
  void operator()(const Raise& raise) {
    at_.z_nm = raise.z_nm;
    PlannedMove move;
    move.to = at_;
    sink_(move);
  }
  void operator()(const Turn& turn) {
    at_.a = turn.a;
    at_.c = turn.c;
    PlannedMove move;
    move.rotary = true;
    move.to = at_;
    sink_(move);
  }
  void operator()(const Trace& trace) {
    const TracePoint& first = trace.points.front();
    at_.x_nm = first.x_nm;
    at_.y_nm = first.y_nm;
    at_.c = first.c;
    PlannedMove move;
    move.rotary = true;
    move.to = at_;
    sink_(move);
    move.rapid = false;
    move.rotary = false;
    move.feed_mm_per_min = trace.approach_feed_mm_per_min;
    move.to.z_nm = first.z_nm;
    sink_(move);
    move.motion = Motion::plough;
    move.feed_mm_per_min = 0.0;
    for (std::size_t i = 1; i < trace.points.size(); ++i) {
      const TracePoint& p = trace.points[i];
      move.to = {p.x_nm, p.y_nm, p.z_nm, at_.a, p.c};
      move.trace_s = p.seconds;
      sink_(move);
    }
    at_ = move.to;
  }
  void operator()(const Visit& visit) {
    for (const Rapid& rapid : approach(at_, visit)) {
      if (rapid.x_nm) at_.x_nm = rapid.x_nm;
      if (rapid.y_nm) at_.y_nm = rapid.y_nm;
      if (rapid.z_nm) at_.z_nm = rapid.z_nm;
      PlannedMove move;
      move.to = at_;
      move.element = visit.element;
      sink_(move);
    }
    cut(program_.subroutines[visit.subroutine], visit.element);
  }

 private:
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
      const auto& increment = std::get<Increment>(step);
      if (at_.x_nm) at_.x_nm = *at_.x_nm + increment.x_nm;
      at_.y_nm = *at_.y_nm + increment.y_nm;
      at_.z_nm = *at_.z_nm + increment.z_nm;
      PlannedMove move;
      move.rapid = false;
      move.motion = increment.motion;
      move.to = at_;
      move.feed_mm_per_min = increment.feed_mm_per_min;
      move.element = element;
      pending = move;
    }
    flush();
  }

  const Program& program_;
  const std::function<void(const PlannedMove&)>& sink_;
  Position at_;
};

}  // namespace

Reach reach_of(const Subroutine& subroutine) {
  Reach reach;
  for (const Step& step : subroutine.steps) {
    const auto* increment = std::get_if<Increment>(&step);
    if (increment == nullptr) continue;
    reach.x_end_nm += increment->x_nm;
    reach.y_end_nm += increment->y_nm;
    reach.z_end_nm += increment->z_nm;
    reach.x_low_nm = std::min(reach.x_low_nm, reach.x_end_nm);
    reach.x_high_nm = std::max(reach.x_high_nm, reach.x_end_nm);
    reach.y_low_nm = std::min(reach.y_low_nm, reach.y_end_nm);
    reach.y_high_nm = std::max(reach.y_high_nm, reach.y_end_nm);
    reach.z_low_nm = std::min(reach.z_low_nm, reach.z_end_nm);
    reach.z_high_nm = std::max(reach.z_high_nm, reach.z_end_nm);
  }
  return reach;
}

std::vector<Rapid> approach(const Position& from, const Visit& visit) {
  const auto changed = [](const std::optional<Nanometres>& now, Nanometres then) {
    return now == then ? std::nullopt : std::optional(then);
  };
  const Rapid across{changed(from.x_nm, visit.x_nm), changed(from.y_nm, visit.y_nm), std::nullopt};
  const Rapid along{std::nullopt, std::nullopt, changed(from.z_nm, visit.z_nm)};
  const bool rises = from.z_nm && *from.z_nm < visit.z_nm;
  std::vector<Rapid> moves;
  if (rises) moves.push_back(along);
  if (across.x_nm || across.y_nm) moves.push_back(across);
  if (!rises && along.z_nm) moves.push_back(along);
  return moves;
}

void for_each_move(const Program& program, const std::function<void(const PlannedMove&)>& sink) {
  Walker walker(program, sink);
  for (const Item& item : program.items) std::visit(walker, item);
}

}  // namespace retrace::fabrication
