#include "fabrication/chisel/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/chisel/plan/clear_way.h"
#include "fabrication/chisel/plan/move_time.h"
#include "fabrication/chisel/plan/order.h"
#include "fabrication/chisel/plan/process_facts.h"
#include "fabrication/chisel/plan/routines.h"
#include "fabrication/chisel/plan/stages.h"
#include "fabrication/job/substrate_cells.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

constexpr double kSecondsPerHour = 3600.0;

/// Replaces every character that at least one dialect does not allow in comments by an underscore.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool fits = c >= 0x20 && c < 0x7f && std::string_view("()[]{}\"';%").find(c) == std::string_view::npos;
    result += fits ? c : '_';
  }
  return result;
}

/// Returns true if `name` is the name of a stage, or the name of its group ("roughing" or "finishing").
bool is_named(const Stage& stage, std::string_view name) {
  return stage.name == name || (name == "roughing" && stage.roughs) ||
         (name == "finishing" && stage.name.starts_with(name));
}

[[noreturn]] void refuse_phase(const Plan& plan, Field field, const std::string& name) {
  std::vector<std::string> names;
  for (const Stage& stage : plan.stages) names.push_back(stage.name);
  constexpr std::size_t kMostNamed = 12;
  if (names.size() > kMostNamed) {
    names.resize(kMostNamed);
    names.emplace_back("...");
  }
  const bool is_phase = field.name == "phase";
  throw InputError(field,
                   fmt::format("must be {}roughing, finishing or one of {}{}, got {}", is_phase ? "all, " : "",
                               fmt::join(names, ", "), is_phase ? " (with + for all after it too)" : "", plain(name)));
}

/// Removes all stages from `plan` except the requested ones.
/// \return the stages of the job before the requested ones
/// \throw InputError for a phase that the job does not have
std::vector<Stage> choose_stages(Plan& plan, const PlanOptions& options) {
  if (!options.before.empty()) {
    const auto first = std::find_if(plan.stages.begin(), plan.stages.end(),
                                    [&](const Stage& stage) { return is_named(stage, options.before); });
    if (first == plan.stages.end()) refuse_phase(plan, Field{"standing"}, options.before);
    if (first == plan.stages.begin())
      throw InputError(Field{"standing"}, "must be a stage before which something is cut, got the first");
    plan.stages.erase(first, plan.stages.end());
  }
  if (options.phase == "all") return {};
  const bool and_after = options.phase.ends_with('+');
  const std::string name = options.phase.substr(0, options.phase.size() - (and_after ? 1 : 0));
  std::vector<Stage> chosen;
  std::vector<Stage> before;
  for (const Stage& stage : plan.stages) {
    if ((and_after && !chosen.empty()) || is_named(stage, name)) chosen.push_back(stage);
    if (chosen.empty()) before.push_back(stage);
  }
  if (chosen.empty()) refuse_phase(plan, Field{"phase"}, options.phase);
  plan.stages = std::move(chosen);
  return before;
}

/// Returns the machining time of a subroutine, divided by kind of motion.
TimeShares routine_time(const Machine& machine, const Subroutine& subroutine) {
  TimeShares time;
  for (const Step& step : subroutine.steps) {
    if (const auto* dwell = std::get_if<Dwell>(&step)) {
      time.dwell_s += 1e-3 * dwell->ms;
      continue;
    }
    const auto& move = std::get<Move>(step);
    const Place by(move.to[kX].value_or(0), move.to[kY].value_or(0), move.to[kZ].value_or(0));
    const double seconds = linear_move_s(machine, millimetres(by), move.feed_mm_per_min);
    const bool cuts = move.motion == Motion::plunge || move.motion == Motion::plough;
    (cuts ? time.cutting_s : time.retract_s) += seconds;
  }
  return time;
}

/// Distributes visits to programs and adds up the run time. Starts a new program when the present one is too long.
class ProgramMaker {
 public:
  ProgramMaker(const Job& job, const Machine& machine, const PlanOptions& options, const ProcessFacts& facts,
               const std::vector<RoutineStart>& starts, const std::vector<Stage>& stages_before, Plan& plan)
      : job_(job),
        machine_(machine),
        options_(options),
        facts_(facts),
        starts_(starts),
        stages_before_(stages_before),
        plan_(plan),
        has_kinds_(job.substrate || !job.zones.empty()),
        way_(job, machine),
        account_(job) {
    for (const Subroutine& subroutine : plan.subroutines) routine_times_.push_back(routine_time(machine, subroutine));
    const Nanometres step = machine.increments.linear_nm;
    safe_z_nm_ = to_step(plan.safe_z_mm * kNanometresPerMm, step);
    first_z_nm_ = std::max(safe_z_nm_, to_step(machine.first_z_mm() * kNanometresPerMm, step));
  }

  void run() {
    plan_.passes = static_cast<int>(facts_.passes_mm.size());
    const std::map<ElementGroup, std::vector<std::int32_t>> orders = cutting_orders(plan_.elements);
    const auto order_of = [&](const Stage& stage) -> const std::vector<std::int32_t>& {
      const CuttingPose& pose = plan_.poses[stage.pose];
      return orders.at({pose.facet.rotated, pose.orientation});
    };
    for (const Stage& stage : plan_.stages)
      if (stage.roughs) roughing_total_ += static_cast<std::int64_t>(order_of(stage).size());
    for (const Stage& stage : stages_before_) skip(static_cast<std::ptrdiff_t>(order_of(stage).size()));
    bool waiting = options_.from_element.has_value();
    begin();
    for (Stage& stage : plan_.stages) {
      std::vector<std::int32_t> order = order_of(stage);
      if (waiting) {
        const auto first = std::find(order.begin(), order.end(), static_cast<std::int32_t>(*options_.from_element));
        waiting = first == order.end();
        if (stage.roughs) roughing_done_ += first - order.begin();
        skip(first - order.begin());
        order.erase(order.begin(), first);
        if (waiting) continue;
      }
      if (job_.process.stop_before_finishing && has_roughed_ && !stage.roughs)
        stop(StopReason::finishing, stage, order.front());
      enter(stage);
      for (const std::int32_t element : order) visit(stage, element);
    }
    end();
    plan_.programs.size() == 1 ? void(plan_.programs.front().name = base_name()) : number_programs();
  }

 private:
  /// Returns the common name of all programs, without their numbers. A program that restarts at an element has a
  /// separate name.
  std::string base_name() const {
    std::string name = options_.phase == "all" ? "program" : options_.phase;
    if (name.ends_with('+')) name.replace(name.size() - 1, 1, "_and_after");
    if (options_.from_element) name += fmt::format("_from_element_{}", *options_.from_element);
    return options_.from_pass ? fmt::format("{}_pass_{}", name, *options_.from_pass) : name;
  }

  void number_programs() {
    for (std::size_t k = 0; k < plan_.programs.size(); ++k) {
      plan_.programs[k].name = fmt::format("{}_{:03}", base_name(), k + 1);
      plan_.programs[k].header.insert(plan_.programs[k].header.begin(),
                                      fmt::format("Part {} of {}{}", k + 1, plan_.programs.size(),
                                                  k == 0 ? "" : ", to run when those before it have run"));
    }
  }

  void begin() {
    program_ = {};
    program_seconds_ = 0.0;
    if (!has_kinds_) program_.subroutines = plan_.subroutines;
    program_.tilt_letter = machine_.tilt_letter();
    program_.control = machine_.control;
    program_.has_mist = program_.needs_mist = job_.process.mist;
    has_visits_ = false;
    stops_ = 0;
    plan_.program_cuts_mm.push_back(0.0);
    account_.begin_program();
    begin_to_move();
  }

  /// Starts to move after a standstill. The axis positions are not known, so Z moves up first.
  void begin_to_move() {
    at_ = {};
    is_cold_ = is_fresh_ = true;
    has_roughed_ = false;
    raise_to(first_z_nm_);
  }

  /// Adds a stop for the operator. The tool moves up to the height of the first move, and the rotary axes move to 0.
  void stop(StopReason reason, const Stage& stage, std::int32_t element) {
    raise_to(std::max(*at_[kZ], first_z_nm_));
    turn(0, 0);
    plan_.stops.push_back({plan_.programs.size(), reason, static_cast<std::size_t>(&stage - plan_.stages.data()),
                           element, program_seconds_, account_.used()});
    program_.items.emplace_back(Stop{stop_text(job_, reason, ++stops_)});
    program_.items.emplace_back(Comment{plain(fmt::format("Goes on with element {} of {}", element, stage.name))});
    account_.stop();
    begin_to_move();
  }

  void raise() { raise_to(at_[kZ] ? std::max(*at_[kZ], safe_z_nm_) : safe_z_nm_); }

  void raise_to(Nanometres z_nm) {
    if (at_[kZ] != z_nm) {
      const double up_mm = at_[kZ] ? millimetres(z_nm - *at_[kZ]) : 0.0;
      spend(nullptr, &TimeShares::fixed_s, linear_move_s(machine_, Vec3(0.0, 0.0, up_mm), std::nullopt));
      Move up;
      up.to[kZ] = z_nm;
      program_.items.emplace_back(up);
    }
    at_[kZ] = z_nm;
    just_turned_ = true;
  }

  /// Returns the angle by which a rotary axis rotates when its programmed position changes by `units`. If the axis
  /// takes the shortest path, the angle is at most half a turn in either direction.
  RotaryUnits rotation(char axis, RotaryUnits units) const {
    if (machine_.shortest_axes.find(axis) == std::string::npos) return units;
    return rotary_units(std::remainder(degrees(units), 360.0));
  }

  void turn(RotaryUnits a, RotaryUnits c) {
    // At the start of a program, the rotary positions are not known. They are assumed to be 0, because programs end at
    // 0.
    const RotaryUnits by_a = rotation(machine_.tilt_letter(), a - at_[kTilt].value_or(0));
    const RotaryUnits by_c = rotation('C', c - at_[kC].value_or(0));
    if (at_[kTilt] == a && at_[kC] == c) return;
    raise();
    constexpr double kRotationDeg = 45.0;
    if (std::abs(degrees(by_c)) > kRotationDeg) ++plan_.c_rotations;
    spend(nullptr, &TimeShares::fixed_s, rotary_move_s(machine_, degrees(by_a), degrees(by_c)));
    Move turn;
    turn.to[kTilt] = a;
    turn.to[kC] = c;
    program_.items.emplace_back(turn);
    go_to(at_, turn.to);
  }

  /// Starts a stage: warms up the machine if necessary, moves the rotary axes, and adds a comment or message for the
  /// operator.
  void enter(const Stage& stage) {
    const CuttingPose& pose = plan_.poses[stage.pose];
    if (std::exchange(is_cold_, false)) warm_up();
    turn(pose.a, pose.c);
    if (stage.roughs) {
      program_.items.emplace_back(Comment{plain("Stage " + stage.name)});
      return;
    }
    const auto c_deg = static_cast<long>(std::lround(pose.rounded.c_deg));
    const std::string what = stage.name.starts_with("layer") ? "Layer" : "Finishing cut";
    program_.items.emplace_back(Message{fmt::format("{} {} of {} C-axis at {}", what, stage.cut, stage.cuts, c_deg)});
  }

  /// Warms up the machine: X and Y move back and forth, one after the other, over most of their travel. Then moves to
  /// the center of the array.
  void warm_up() {
    if (machine_.warm_up_s.value <= 0.0) return;
    constexpr double kOfTravel = 0.9;
    constexpr std::size_t kMostStrokes = 100'000;
    const Interval limits[] = {machine_.x.limits_mm.value, machine_.y.limits_mm.value};
    for (std::size_t k = 0; k < kMostStrokes && account_.used().seconds < machine_.warm_up_s.value; ++k) {
      const auto& [low, high] = limits[k % 2];
      const double side = k % 4 < 2 ? -0.5 : 0.5;
      stroke(k % 2 == 0 ? kX : kY, 0.5 * (low + high) + kOfTravel * side * (high - low));
    }
    stroke(kX, 0.0);
    stroke(kY, 0.0);
  }

  void stroke(Axis axis, double to_mm) {
    Move move;
    move.to[axis] = to_step(to_mm * kNanometresPerMm, machine_.increments.linear_nm);
    Vec3 by = Vec3::Zero();
    if (at_[axis]) by[axis] = millimetres(*move.to[axis] - *at_[axis]);
    spend(nullptr, &TimeShares::fixed_s, linear_move_s(machine_, by, std::nullopt));
    program_.items.emplace_back(move);
    go_to(at_, move.to);
  }

  /// Skips some visits of elements. The order of the parallel passes alternates from visit to visit, so an odd number
  /// of skipped visits reverses this order.
  void skip(std::ptrdiff_t visits) { forth_ = forth_ != (visits % 2 != 0); }

  /// Returns the parallel passes of an element. Their order alternates from visit to visit.
  std::vector<Visit> passes_of(const Stage& stage, std::int32_t element) {
    const CuttingPose& pose = plan_.poses[stage.pose];
    const Vec3 root =
        plan_.elements[static_cast<std::size_t>(element)].foot_mm - pose.section.depth_mm * pose.turn.col(2);
    forth_ = !forth_;
    std::vector<Visit> passes;
    for (std::size_t k = 0; k < facts_.passes_mm.size(); ++k) {
      const double offset_mm = facts_.passes_mm[forth_ ? k : facts_.passes_mm.size() - 1 - k];
      const AxisPositions at = inverse(machine_, root + offset_mm * pose.root, pose.rounded);
      const auto& [start, reach] = starts_[stage.subroutine];
      passes.push_back({element, stage.subroutine,
                        rounded_words({at.x_mm, at.y_mm, at.z_mm}, pose.rounded_along, pose.section.step_nm) + start,
                        static_cast<int>(k) + 1, plan_.passes});
      check_limits(passes.back(), reach);
    }
    return passes;
  }

  /// Returns the length of cut and the run time of all passes of a visit. The run time is an upper limit, which assumes
  /// a move to the safe height before each pass.
  EdgeUse use_of(const Stage& stage, const std::vector<Visit>& passes) const {
    EdgeUse use;
    if (!job_.tool.edge_life_mm && !job_.process.stop_every_min) return use;
    Words at = at_;
    const Subroutine& routine = plan_.subroutines[stage.subroutine];
    const auto rapid_s = [&](const Vec3& by) { return linear_move_s(machine_, by, std::nullopt); };
    for (const Visit& pass : passes) {
      if (job_.tool.edge_life_mm)
        use.cut_mm += length_of_cut_mm(job_, machine_, plan_.elements[static_cast<std::size_t>(pass.element)],
                                       plan_.poses[stage.pose], pass, routine, plan_.stock_mm);
      const Nanometres high = std::max(*at[kZ], safe_z_nm_);
      Vec3 across = Vec3::Zero();
      for (const Axis axis : {kX, kY})
        if (at[axis]) across[axis] = millimetres(pass.start[axis] - *at[axis]);
      use.seconds += rapid_s(Vec3(0.0, 0.0, millimetres(high - *at[kZ]))) + rapid_s(across) +
                     rapid_s(Vec3(0.0, 0.0, millimetres(high - pass.start.z()))) +
                     routine_times_[stage.subroutine].total_s();
      go_to(at, linear_words(pass.start + starts_[stage.subroutine].reach.end));
    }
    return use;
  }

  /// Starts a new program before a visit if one is required. Otherwise, adds a stop if a stop is required.
  void make_way(const Stage& stage, std::int32_t element, const std::vector<Visit>& passes) {
    const EdgeUse use = use_of(stage, passes);
    const std::optional<StopReason> reason = account_.stop_before(use);
    if (has_visits_ && (is_full(stage) || account_.needs_program(use))) {
      finish_program();
      begin();
      enter(stage);
    } else if (reason && !is_fresh_) {
      stop(*reason, stage, element);
      enter(stage);
    }
    const EdgeUse anew = use_of(stage, passes);
    if (is_fresh_) account_.check(anew, account_.used().seconds, element);
    account_.cut(anew.cut_mm);
    plan_.program_cuts_mm.back() += anew.cut_mm;
    is_fresh_ = false;
  }

  void visit(Stage& stage, std::int32_t element) {
    std::vector<Visit> passes = passes_of(stage, element);
    if (visits_ == 0 && options_.from_pass) passes.erase(passes.begin(), passes.begin() + (*options_.from_pass - 1));
    make_way(stage, element, passes);
    for (const Visit& pass : passes) {
      clear_way(pass, plan_.poses[stage.pose]);
      add(stage, pass, starts_[stage.subroutine].reach);
    }
    has_visits_ = true;
    has_roughed_ = stage.roughs;
    ++stage.visits;
    ++visits_;
    if (options_.stop_every && visits_ % *options_.stop_every == 0) program_.items.emplace_back(OptionalStop{});
    if (stage.roughs) tell_progress();
  }

  /// Moves to the safe height if the direct path to a visit would come too close to the blank.
  void clear_way(const Visit& visit, const CuttingPose& pose) {
    if (way_.is_clear(at_, visit, pose)) return;
    raise();
    if (way_.is_clear(at_, visit, pose)) return;
    throw InputError(job_.where("machine"),
                     fmt::format("element {}: the tool cannot come down to it at {}{} C{} without coming nearer to the "
                                 "blank than process.clearance_mm, {}",
                                 visit.element, machine_.tilt_letter(), fixed(pose.rounded.a_deg, 4),
                                 fixed(pose.rounded.c_deg, 4), shortest(job_.process.clearance_mm)));
  }

  void tell_progress() {
    ++roughing_done_;
    for (const int percent : {25, 50, 75, 100}) {
      // The message is added after the first visit that completes this percentage of the roughing.
      const std::int64_t due = (roughing_total_ * percent + 99) / 100;
      if (roughing_done_ == due) program_.items.emplace_back(Message{fmt::format("Roughing {} percent", percent)});
    }
  }

  void add(Stage& stage, const Visit& visit, const Reach& reach) {
    for (const Move& move : approach(at_, visit)) {
      Vec3 by = Vec3::Zero();
      for (const Axis axis : {kX, kY, kZ})
        if (move.to[axis] && at_[axis]) by[axis] = millimetres(*move.to[axis] - *at_[axis]);
      go_to(at_, move.to);
      spend(&stage, just_turned_ ? &TimeShares::fixed_s : &TimeShares::rapid_s,
            linear_move_s(machine_, by, std::nullopt));
    }
    just_turned_ = false;
    const TimeShares& routine = routine_times_[stage.subroutine];
    spend(&stage, &TimeShares::cutting_s, routine.cutting_s);
    spend(&stage, &TimeShares::dwell_s, routine.dwell_s);
    spend(&stage, &TimeShares::retract_s, routine.retract_s);
    go_to(at_, linear_words(visit.start + reach.end));
    program_.items.emplace_back(visit);
    if (has_kinds_) used_.insert(visit.subroutine);
  }

  void spend(Stage* stage, double TimeShares::*on, double seconds) {
    plan_.time.*on += seconds;
    if (stage != nullptr) stage->time.*on += seconds;
    program_seconds_ += seconds;
    account_.spend(seconds);
  }

  bool is_full(const Stage& stage) const {
    if (has_kinds_ && is_out_of_numbers(stage)) return true;
    if (!options_.split_hours) return false;
    constexpr double kToLeaveS = 30.0;  // time reserved for the moves at the end of the program
    return program_seconds_ + routine_times_[stage.subroutine].total_s() + kToLeaveS >
           *options_.split_hours * kSecondsPerHour;
  }

  /// Returns true if one more subroutine in the program would need a number with more than four digits.
  bool is_out_of_numbers(const Stage& stage) const {
    constexpr std::size_t kMostSubroutines = 9000;
    return used_.size() >= kMostSubroutines && !used_.contains(stage.subroutine);
  }

  /// Adds the subroutines that the program calls, and omits all others. Each zone, and each tilt of elements on a
  /// substrate, has separate subroutines.
  void add_used_subroutines() {
    std::vector<Subroutine> left;
    std::map<std::uint32_t, std::uint32_t> places;
    for (const std::uint32_t index : used_) {
      places[index] = static_cast<std::uint32_t>(left.size());
      left.push_back(plan_.subroutines[index]);
      left.back().number = kFirstSubroutine + static_cast<int>(left.size()) - 1;
    }
    program_.subroutines = std::move(left);
    for (Item& item : program_.items)
      if (auto* const visit = std::get_if<Visit>(&item)) visit->subroutine = places.at(visit->subroutine);
  }

  void check_axis(char axis, Nanometres low_nm, Nanometres high_nm, const Interval& limits,
                  std::int32_t element) const {
    const double low_mm = millimetres(low_nm);
    const double high_mm = millimetres(high_nm);
    if (limits.contains(low_mm) && limits.contains(high_mm)) return;
    const std::string who = element < 0 ? "the safe height" : fmt::format("element {}", element);
    throw InputError(job_.where("machine"),
                     fmt::format("{}: axis {} of machine {} would go to {} mm, beyond its limits of {} to {}", who,
                                 axis, machine_.name, fixed(limits.contains(low_mm) ? high_mm : low_mm, 3),
                                 shortest(limits.low), shortest(limits.high)));
  }

  void check_limits(const Visit& visit, const Reach& reach) const {
    const std::array<const LinearAxis*, 3> axes = {&machine_.x, &machine_.y, &machine_.z};
    for (const Axis axis : {kX, kY, kZ})
      check_axis("XYZ"[axis], visit.start[axis] + reach.low[axis], visit.start[axis] + reach.high[axis],
                 axes[axis]->limits_mm.value, visit.element);
  }

  void finish_program() {
    raise();
    turn(0, 0);
    program_.header = header();
    if (has_kinds_) add_used_subroutines();
    used_.clear();
    plan_.program_times_s.push_back(program_seconds_);
    plan_.programs.push_back(std::move(program_));
  }

  void end() {
    check_axis('Z', safe_z_nm_, first_z_nm_, machine_.z.limits_mm.value, -1);
    finish_program();
  }

  std::vector<std::string> header() const {
    const geometry::Vec2 extent = blank_extent_mm(job_);
    const Process& p = job_.process;
    const char tilt = machine_.tilt_letter();
    std::vector<std::string> lines = {
        job_.title.empty() ? facts_.array_title : plain(job_.title),
        plain("Job " + std::filesystem::path(job_.source).filename().string() + ", machine " + machine_.name),
        fmt::format("Blank: {}, array of {} x {} mm along X and Y at {}0 C0",
                    kWorkpieceWords[static_cast<std::size_t>(job_.workpiece.kind)], fixed(extent.x(), 3),
                    fixed(extent.y(), 3), tilt)};
    if (job_.substrate) lines.push_back(plain(substrate_description(job_)));
    for (const std::string& line : facts_.description) lines.push_back(line);
    lines.push_back(plain(fmt::format("Process {}: roughing {} um, finishing {} x {} um, clearance {} mm", p.name,
                                      shortest(p.roughing_depth_um), has_finishing_cuts(job_) ? p.finishing_cuts : 0,
                                      shortest(p.finishing_depth_um), shortest(p.clearance_mm))));
    constexpr std::size_t kMostPoses = 24;
    for (const CuttingPose& pose : std::span(plan_.poses).first(std::min(kMostPoses, plan_.poses.size())))
      lines.push_back(fmt::format("Pose: facet {}{}{} {}{:.7f} C{:.7f}", pose.facet.facet,
                                  pose.facet.rotated ? " of turned elements" : "",
                                  job_.zones.empty() ? "" : fmt::format(" of zone {}", pose.facet.zone + 1), tilt,
                                  pose.rounded.a_deg, pose.rounded.c_deg));
    if (plan_.poses.size() > kMostPoses)
      lines.push_back(fmt::format("And {} poses more, each where it begins", plan_.poses.size() - kMostPoses));
    const auto point = [](const RotaryAxis& axis) {
      const Vec3& at = axis.point_mm.value;
      return fmt::format("X{} Y{} Z{}", shortest(at.x()), shortest(at.y()), shortest(at.z()));
    };
    lines.push_back(
        fmt::format("{} is taken to turn about a line through {} from {}, C about one through {} from the work zero",
                    tilt, point(machine_.a),
                    machine_.tilt == Tilt::table ? "the work zero" : "the tool reference point", point(machine_.c)));
    if (job_.tool.edge_life_mm)
      lines.push_back(fmt::format("Begins with an edge that cuts {} mm, and has cut nothing yet",
                                  shortest(*job_.tool.edge_life_mm)));
    if (options_.phase != "all" || options_.from_element) lines.push_back(restart_text());
    const auto minutes = static_cast<std::int64_t>(std::ceil(program_seconds_ / 60.0));
    lines.push_back(fmt::format("Expected time: {} h {} min", minutes / 60, minutes % 60));
    return lines;
  }

  /// Returns a header line that states which stages must have been cut before this program.
  std::string restart_text() const {
    const Stage& first = plan_.stages.front();
    std::string from = options_.from_element ? fmt::format(" from element {}", *options_.from_element) : "";
    if (options_.from_pass) from += fmt::format(", pass {}", *options_.from_pass);
    return plain(fmt::format("A part of the job: begins with stage {}{}. All that comes before it must have been cut",
                             first.name, from));
  }

  const Job& job_;
  const Machine& machine_;
  const PlanOptions& options_;
  const ProcessFacts& facts_;
  const std::vector<RoutineStart>& starts_;
  const std::vector<Stage>& stages_before_;  ///< stages of the job before the stages of the plan
  Plan& plan_;
  std::vector<TimeShares> routine_times_;
  Program program_;
  double program_seconds_ = 0.0;
  Words at_{};
  Nanometres safe_z_nm_ = 0;
  Nanometres first_z_nm_ = 0;  ///< Z position of the first move
  bool just_turned_ = true;
  bool is_cold_ = true;      ///< true if the machine has not moved since the start of the program or the last stop
  bool is_fresh_ = true;     ///< true if nothing was cut since the start of the program or the last stop
  bool has_visits_ = false;  ///< true if the present program contains visits
  /// True if a roughing visit was the last visit since the start of the program or the last stop.
  bool has_roughed_ = false;
  int stops_ = 0;           ///< number of stops in the present program
  bool has_kinds_ = false;  ///< true if elements are on a substrate or in zones, and therefore need separate poses
  ClearWay way_;
  EdgeAccount account_;
  std::set<std::uint32_t> used_;  ///< subroutines that the program calls
  bool forth_ = false;
  std::int64_t visits_ = 0;
  std::int64_t roughing_total_ = 0;
  std::int64_t roughing_done_ = 0;
};

/// Checks the options whose allowed values depend on the job.
/// \param elements number of elements of the job
/// \param passes number of passes of the job
/// \throw InputError that names the option, if its value is out of range
void check_options(const PlanOptions& options, std::size_t elements, std::size_t passes) {
  const auto most = static_cast<std::int64_t>(elements) - 1;
  if (options.from_element && (*options.from_element < 0 || *options.from_element > most))
    throw InputError(Field{"from_element"}, fmt::format("must be 0 to {}, got {}", most, *options.from_element));
  const auto most_passes = static_cast<std::int64_t>(passes);
  if (options.from_pass && (*options.from_pass < 1 || *options.from_pass > most_passes))
    throw InputError(Field{"from_pass"}, fmt::format("must be 1 to {}, got {}", most_passes, *options.from_pass));
}

ProcessFacts facts_of(const Job& job, const Plan& plan) {
  const auto facts = cuts_prisms(job) ? plunging_facts : chiseling_facts;
  return facts(job, plan.stock_mm, plan.elements.size());
}

}  // namespace

Plan make_plan(const Job& job, const Machine& machine, const PlanOptions& options) {
  check_on_machine(job, machine);
  Plan plan;
  plan.elements = cut_elements(job);
  if (job.substrate) plan.stock_mm = stock_mm(job, plan.elements);
  const ProcessFacts facts = facts_of(job, plan);
  check_options(options, plan.elements.size(), facts.passes_mm.size());
  plan.cuts_per_facet = facts.cuts_per_facet;
  const std::vector<RoutineStart> starts = add_stages(job, machine, plan);
  plan.safe_z_mm = safe_height_mm(job, machine, plan.poses);
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    plan.aperture_area_mm2 +=
        geometry::area(geometry::aperture_outline(blank_element(job, zone))) *
        static_cast<double>(job.zones.empty() ? plan.elements.size() : job.zones[zone].apexes_mm.size());
  const std::vector<Stage> stages_before = choose_stages(plan, options);
  ProgramMaker(job, machine, options, facts, starts, stages_before, plan).run();
  return plan;
}

}  // namespace retrace::fabrication
