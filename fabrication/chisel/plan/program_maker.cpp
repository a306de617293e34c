#include "fabrication/chisel/plan/program_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/chisel/plan/approach_clearance.h"
#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/chisel/plan/move_time.h"
#include "fabrication/chisel/plan/order.h"
#include "fabrication/chisel/plan/program_draft.h"
#include "fabrication/chisel/plan/program_text.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

constexpr double kSecondsPerHour = 3600.0;

/// Returns the machining time of a subroutine, separately for each kind of motion.
TimeBreakdown routine_time(const Machine& machine, const Subroutine& subroutine) {
  TimeBreakdown time;
  for (const Step& step : subroutine.steps) {
    if (const auto* dwell = std::get_if<Dwell>(&step)) {
      time.dwell_s += 1e-3 * dwell->ms;
      continue;
    }
    const auto& move = std::get<Move>(step);
    const LinearPosition by(move.to[kX].value_or(0), move.to[kY].value_or(0), move.to[kZ].value_or(0));
    const double seconds = linear_move_s(machine, millimetres(by), move.feed_mm_per_min);
    const bool cuts = move.motion == Motion::plunge || move.motion == Motion::plough;
    (cuts ? time.cutting_s : time.retract_s) += seconds;
  }
  return time;
}

/// Checks that an axis stays within its limits.
/// \param element index of the element at which the axis moves; -1 for moves at the safe height
void check_axis(const Job& job, const Machine& machine, char axis, Nanometres low_nm, Nanometres high_nm,
                const Interval& limits, std::int32_t element) {
  const double low_mm = millimetres(low_nm);
  const double high_mm = millimetres(high_nm);
  if (limits.contains(low_mm) && limits.contains(high_mm)) return;
  const std::string who = element < 0 ? "move to the safe height" : fmt::format("element {}", element);
  throw InputError(job.where("machine"),
                   fmt::format("{}: axis {} of machine {} would have to move to {} mm, but its limits are {} to {} mm",
                               who, axis, machine.name, fixed(limits.contains(low_mm) ? high_mm : low_mm, 3),
                               shortest(limits.low), shortest(limits.high)));
}

/// Warms up the machine: X and Y move back and forth, one after the other, over most of their travel. Then moves to the
/// centre of the array.
void warm_up(const Machine& machine, ProgramDraft& program) {
  if (machine.warm_up_s.value <= 0.0) return;
  constexpr double kOfTravel = 0.9;
  constexpr std::size_t kMaxStrokes = 100'000;
  const Interval limits[] = {machine.x.limits_mm.value, machine.y.limits_mm.value};
  for (std::size_t k = 0; k < kMaxStrokes && program.tool_life().wear().seconds < machine.warm_up_s.value; ++k) {
    const auto& [low, high] = limits[k % 2];
    const double side = k % 4 < 2 ? -0.5 : 0.5;
    program.traverse(k % 2 == 0 ? kX : kY, 0.5 * (low + high) + kOfTravel * side * (high - low));
  }
  program.traverse(kX, 0.0);
  program.traverse(kY, 0.0);
}

/// Computes the parallel passes of the tool at each visited element. Their order is reversed from one visit to the
/// next.
class VisitPasses {
 public:
  VisitPasses(const Job& job, const Machine& machine, const std::vector<double>& offsets_mm)
      : job_(job), machine_(machine), offsets_mm_(offsets_mm) {}

  /// Skips visits. An odd number of skipped visits reverses the order of the passes.
  void skip(std::ptrdiff_t visits) { forth_ = forth_ != (visits % 2 != 0); }

  /// Returns the passes of the next visit.
  /// \throw InputError if an axis would leave its limits
  std::vector<CycleCall> next(const CutElement& element, std::int32_t number, const CuttingPose& pose,
                              std::uint32_t subroutine, const RoutineStart& start) {
    const Vec3 root = element.origin_mm - pose.section.depth_mm * pose.workpiece_from_element.col(2);
    forth_ = !forth_;
    std::vector<CycleCall> passes;
    for (std::size_t k = 0; k < offsets_mm_.size(); ++k) {
      const double offset_mm = offsets_mm_[forth_ ? k : offsets_mm_.size() - 1 - k];
      const AxisPositions at = inverse(machine_, root + offset_mm * pose.root, pose.rounded);
      const LinearPosition words = rounded_words({at.x_mm, at.y_mm, at.z_mm}, pose.rounded_along, pose.section.step_nm);
      passes.push_back(
          {number, subroutine, words + start.start, static_cast<int>(k) + 1, static_cast<int>(offsets_mm_.size())});
      check_limits(passes.back(), start.extent);
    }
    return passes;
  }

 private:
  void check_limits(const CycleCall& call, const MoveExtent& reach) const {
    const std::array<const LinearAxis*, 3> axes = {&machine_.x, &machine_.y, &machine_.z};
    for (const Axis axis : {kX, kY, kZ})
      check_axis(job_, machine_, "XYZ"[axis], call.start[axis] + reach.low[axis], call.start[axis] + reach.high[axis],
                 axes[axis]->limits_mm.value, call.element);
  }

  const Job& job_;
  const Machine& machine_;
  const std::vector<double>& offsets_mm_;
  bool forth_ = false;
};

/// Counts the roughing visits, and adds messages about the progress of roughing to the program.
class RoughingProgress {
 public:
  explicit RoughingProgress(std::int64_t total) : total_(total) {}

  void skip(std::ptrdiff_t visits) { done_ += visits; }
  void add_visit(ProgramDraft& program) {
    ++done_;
    for (const int percent : {25, 50, 75, 100}) {
      // The message is added after the first visit that completes this percentage of the roughing.
      const std::int64_t due = (total_ * percent + 99) / 100;
      if (done_ == due) program.add(Message{fmt::format("Roughing {} percent", percent)});
    }
  }

 private:
  std::int64_t total_;
  std::int64_t done_ = 0;
};

/// Elements in the order of cutting, for each stage.
class StageOrders {
 public:
  explicit StageOrders(const Plan& plan) : poses_(plan.poses), orders_(cutting_orders(plan.elements)) {}

  const std::vector<std::int32_t>& of(const Stage& stage) const {
    const CuttingPose& pose = poses_[stage.pose];
    return orders_.at({pose.facet.rotated, pose.orientation});
  }
  /// Returns the number of visits of all roughing stages.
  std::int64_t roughing_visits(const std::vector<Stage>& stages) const {
    std::int64_t visits = 0;
    for (const Stage& stage : stages)
      if (stage.roughs) visits += static_cast<std::int64_t>(of(stage).size());
    return visits;
  }

 private:
  const std::vector<CuttingPose>& poses_;
  std::map<ElementGroup, std::vector<std::int32_t>> orders_;
};

/// Distributes the visits of all stages among programs. Starts a new program when the current program is too long.
class ProgramMaker {
 public:
  ProgramMaker(const Job& job, const Machine& machine, const PlanOptions& options, const ProcessFacts& facts,
               const std::vector<RoutineStart>& starts, Plan& plan)
      : job_(job),
        machine_(machine),
        options_(options),
        facts_(facts),
        starts_(starts),
        plan_(plan),
        has_kinds_(job.substrate || !job.zones.empty()),
        way_(job, machine),
        orders_(plan),
        passes_(job, machine, facts.passes_mm),
        roughing_(orders_.roughing_visits(plan.stages)) {
    for (const Subroutine& subroutine : plan.subroutines) routine_times_.push_back(routine_time(machine, subroutine));
    const Nanometres step = machine.increments.linear_nm;
    heights_.safe_nm = to_step(plan.safe_z_mm * kNanometresPerMm, step);
    heights_.first_nm = std::max(heights_.safe_nm, to_step(machine.first_z_mm() * kNanometresPerMm, step));
  }

  void run(const std::vector<Stage>& stages_before) {
    for (const Stage& stage : stages_before) passes_.skip(std::ssize(orders_.of(stage)));
    bool waiting = options_.from_element.has_value();
    begin_program();
    for (Stage& stage : plan_.stages) {
      std::vector<std::int32_t> order = orders_.of(stage);
      if (waiting) {
        const auto first = std::find(order.begin(), order.end(), static_cast<std::int32_t>(*options_.from_element));
        waiting = first == order.end();
        if (stage.roughs) roughing_.skip(first - order.begin());
        passes_.skip(first - order.begin());
        order.erase(order.begin(), first);
        if (waiting) continue;
      }
      if (job_.process.stop_before_finishing && since_stop_.has_roughed && !stage.roughs)
        stop(StopReason::finishing, stage, order.front());
      enter(stage);
      for (const std::int32_t element : order) visit(stage, element);
    }
    check_axis(job_, machine_, 'Z', heights_.safe_nm, heights_.first_nm, machine_.z.limits_mm.value, -1);
    finish_program();
    name_programs(options_, plan_.programs);
  }

 private:
  /// State since the start of the program or the last stop.
  struct SinceStop {
    bool is_cold = true;       ///< true if the machine has not been warmed up
    bool is_fresh = true;      ///< true if nothing has been cut
    bool has_roughed = false;  ///< true if the last visit was a roughing visit
  };

  void begin_program() {
    program_.emplace(job_, machine_, heights_, plan_.time);
    since_stop_ = {};
  }

  void finish_program() {
    program_->raise();
    program_->rotate_to(0, 0);
    plan_.c_rotations += program_->c_rotations();
    plan_.program_cuts_mm.push_back(program_->cut_mm());
    plan_.program_times_s.push_back(program_->seconds());
    Program program = program_->take(plan_.subroutines, has_kinds_);
    program.header = program_header(job_, machine_, options_, facts_, plan_, program_->seconds());
    plan_.programs.push_back(std::move(program));
  }

  /// Adds a stop for the operator.
  void stop(StopReason reason, const Stage& stage, std::int32_t element) {
    program_->park();
    plan_.stops.push_back({plan_.programs.size(), reason, static_cast<std::size_t>(&stage - plan_.stages.data()),
                           element, program_->seconds(), program_->tool_life().wear()});
    program_->stop(reason, plain(fmt::format("Goes on with element {} of {}", element, stage.name)));
    since_stop_ = {};
  }

  /// Starts a stage: warms up the machine if necessary, moves the rotary axes, and adds a comment or message for the
  /// operator.
  void enter(const Stage& stage) {
    const CuttingPose& pose = plan_.poses[stage.pose];
    if (std::exchange(since_stop_.is_cold, false)) warm_up(machine_, *program_);
    program_->rotate_to(pose.a, pose.c);
    program_->add(stage_text(stage, pose));
  }

  /// Returns the length of cut and the run time of all passes of a visit. The run time is an upper limit, which assumes
  /// a move to the safe height before each pass.
  ToolWear use_of(const Stage& stage, const std::vector<CycleCall>& passes) const {
    ToolWear use;
    if (!job_.tool.edge_life_mm && !job_.process.stop_every_min) return use;
    AxisWords at = program_->at();
    const Subroutine& routine = plan_.subroutines[stage.subroutine];
    const auto rapid_s = [&](const Vec3& by) { return linear_move_s(machine_, by, std::nullopt); };
    for (const CycleCall& pass : passes) {
      if (job_.tool.edge_life_mm)
        use.cut_mm += length_of_cut_mm(job_, machine_, plan_.elements[static_cast<std::size_t>(pass.element)],
                                       plan_.poses[stage.pose], pass, routine, plan_.stock_mm);
      const Nanometres high = std::max(*at[kZ], heights_.safe_nm);
      Vec3 across = Vec3::Zero();
      for (const Axis axis : {kX, kY})
        if (at[axis]) across[axis] = millimetres(pass.start[axis] - *at[axis]);
      use.seconds += rapid_s(Vec3(0.0, 0.0, millimetres(high - *at[kZ]))) + rapid_s(across) +
                     rapid_s(Vec3(0.0, 0.0, millimetres(high - pass.start.z()))) +
                     routine_times_[stage.subroutine].total_s();
      go_to(at, linear_words(pass.start + starts_[stage.subroutine].extent.end));
    }
    return use;
  }

  /// Returns true if another visit would exceed the maximum number of subroutines or the maximum run time of a program.
  bool is_full(const Stage& stage) const {
    // Numbers of subroutines have at most four digits.
    constexpr std::size_t kMaxSubroutines = 9000;
    const auto& used = program_->used();
    if (has_kinds_ && used.size() >= kMaxSubroutines && !used.contains(stage.subroutine)) return true;
    if (!options_.split_hours) return false;
    constexpr double kToLeaveS = 30.0;  // time reserved for the moves at the end of the program
    return program_->seconds() + routine_times_[stage.subroutine].total_s() + kToLeaveS >
           *options_.split_hours * kSecondsPerHour;
  }

  /// Starts a new program before a visit if one is required. Otherwise, adds a stop if a stop is required.
  void make_way(const Stage& stage, std::int32_t element, const std::vector<CycleCall>& passes) {
    const ToolWear use = use_of(stage, passes);
    const std::optional<StopReason> reason = program_->tool_life().stop_before(use);
    if (program_->has_cycle_calls() && (is_full(stage) || program_->tool_life().needs_program(use))) {
      finish_program();
      begin_program();
      enter(stage);
    } else if (reason && !since_stop_.is_fresh) {
      stop(*reason, stage, element);
      enter(stage);
    }
    const ToolWear anew = use_of(stage, passes);
    if (since_stop_.is_fresh) program_->tool_life().check(anew, element);
    program_->cut(anew.cut_mm);
    since_stop_.is_fresh = false;
  }

  void visit(Stage& stage, std::int32_t element) {
    const CuttingPose& pose = plan_.poses[stage.pose];
    const RoutineStart& start = starts_[stage.subroutine];
    std::vector<CycleCall> passes =
        passes_.next(plan_.elements[static_cast<std::size_t>(element)], element, pose, stage.subroutine, start);
    if (visits_ == 0 && options_.from_pass) passes.erase(passes.begin(), passes.begin() + (*options_.from_pass - 1));
    make_way(stage, element, passes);
    for (const CycleCall& pass : passes) {
      clear_way(pass, pose);
      program_->add_cycle_call(pass, start.extent.end, routine_times_[stage.subroutine], stage);
    }
    since_stop_.has_roughed = stage.roughs;
    ++stage.visits;
    ++visits_;
    if (options_.stop_every && visits_ % *options_.stop_every == 0) program_->add(OptionalStop{});
    if (stage.roughs) roughing_.add_visit(*program_);
  }

  /// Moves to the safe height if the direct path to a call would come too close to the blank.
  void clear_way(const CycleCall& call, const CuttingPose& pose) {
    if (way_.is_clear(program_->at(), call, pose)) return;
    program_->raise();
    if (way_.is_clear(program_->at(), call, pose)) return;
    throw InputError(job_.where("machine"),
                     fmt::format("element {}: at {}{} C{}, the tool cannot approach this element with a distance of at "
                                 "least process.clearance_mm ({} mm) from the blank",
                                 call.element, machine_.tilt_letter(), fixed(pose.rounded.a_deg, 4),
                                 fixed(pose.rounded.c_deg, 4), shortest(job_.process.clearance_mm)));
  }

  const Job& job_;
  const Machine& machine_;
  const PlanOptions& options_;
  const ProcessFacts& facts_;
  const std::vector<RoutineStart>& starts_;
  Plan& plan_;
  /// True if elements are on a substrate or in zones. Each zone, and each tilt of elements on a substrate, then has
  /// separate poses and subroutines. There can be many subroutines, so each program contains only the subroutines that
  /// it calls.
  bool has_kinds_;
  ApproachClearance way_;
  StageOrders orders_;
  VisitPasses passes_;
  RoughingProgress roughing_;
  std::vector<TimeBreakdown> routine_times_;
  SafeHeights heights_;
  std::optional<ProgramDraft> program_;  ///< current program
  SinceStop since_stop_;
  std::int64_t visits_ = 0;
};

}  // namespace

void make_programs(const Job& job, const Machine& machine, const PlanOptions& options, const ProcessFacts& facts,
                   const std::vector<RoutineStart>& starts, const std::vector<Stage>& stages_before, Plan& plan) {
  plan.passes = static_cast<int>(facts.passes_mm.size());
  ProgramMaker(job, machine, options, facts, starts, plan).run(stages_before);
}

}  // namespace retrace::fabrication
