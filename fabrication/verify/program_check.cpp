#include "fabrication/verify/program_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

constexpr std::uint8_t kLinearBits = 0b00111;

/// Bits of the rotary axes that a machine has, and of the one that it has not.
std::uint8_t bit_of(char axis) {
  return static_cast<std::uint8_t>(1U << kNcAxisLetters.find(axis));
}
std::uint8_t rotary_bits(const Machine& machine) {
  return static_cast<std::uint8_t>(bit_of(machine.tilt_letter()) | bit_of('C'));
}
char missing_axis(const Machine& machine) {
  return machine.tilt == Tilt::table ? 'B' : 'A';
}

/// Z alone moves a plunge or a retract; this much of a move along Z makes it one.
constexpr double kMostlyAlong = 0.9;
/// Share of the process's clearance that rapid moves must keep from the blank's face.
constexpr double kClearanceShare = 0.9;
/// Share of a cutting move that may lead towards the facet: rounding of its end points.
constexpr double kMostSlip = 1e-3;
/// Tips of two plunges that are the same cut.
constexpr double kSameTipMm = 5e-7;

Vec3 interpolated(const Vec3& a, const Vec3& b, double a_height, double b_height) {
  return a + (b - a) * (a_height / (a_height - b_height));
}

/// How much of the diamond counts as a body: more than the deepest groove; what holds it, the machine file says.
double diamond_mm(const Workpiece3d& workpiece) {
  constexpr double kDepths = 2.0;
  return workpiece.grooves.empty() ? 1.0 : kDepths * workpiece.grooves.front().depth_mm;
}

/// Time of a move that starts and ends at rest.
double trapezoid_s(double distance, double speed_per_s, double acceleration_per_s2) {
  if (!(distance > 0.0)) return 0.0;
  if (distance >= speed_per_s * speed_per_s / acceleration_per_s2)
    return distance / speed_per_s + speed_per_s / acceleration_per_s2;
  return 2.0 * std::sqrt(distance / acceleration_per_s2);
}

}  // namespace

ToolWedge wedge_of(const Job& job, const Machine& machine) {
  if (job.strategy == Strategy::dmc) return v_tool_wedge(job.tool, machine);
  return tool_wedge(job.tool, machine, Angle::from_deg(prism_of(job).apex_angle_deg));
}

ProgramCheck::ProgramCheck(const Workpiece3d& workpiece, FindingList& findings,
                           std::vector<std::optional<std::size_t>> visits)
    : workpiece_(workpiece),
      job_(*workpiece.job),
      machine_(*workpiece.machine),
      findings_(findings),
      map_(workpiece.grooves),
      face_(*workpiece.job),
      visits_(std::move(visits)),
      wedge_(wedge_of(*workpiece.job, machine_)),
      tool_bodies_(tool_bodies(machine_, wedge_, diamond_mm(workpiece))),
      sweeps_(workpiece.grooves.size()),
      states_(workpiece.grooves.size()) {
  if (job_.strategy != Strategy::dmc) return;
  chiseling_.emplace(
      job_, workpiece.grooves, workpiece.tolerance_mm,
      [this](std::string kind, const NcPlace& place, std::int64_t element, std::string message, double value,
             double limit) { report(std::move(kind), place, element, std::move(message), value, limit); });
}

void ProgramCheck::begin(const std::string& program) {
  program_ = program;
  settings_are_checked_ = false;
}

std::vector<RigidMotion> ProgramCheck::poses() const {
  return poses_;
}

void ProgramCheck::report(std::string kind, const NcPlace& place, std::int64_t element, std::string message,
                          double value, double limit) {
  findings_.add({std::move(kind), program_, place.line, element, std::move(message), value, limit, 1});
}

std::size_t ProgramCheck::pose_index(const RotaryPose& pose) {
  const auto [known, is_new] = known_poses_.try_emplace({pose.a_deg, pose.c_deg}, pose_words_.size());
  if (!is_new) return known->second;
  pose_words_.push_back(pose);
  poses_.push_back(machine_from_workpiece(machine_, pose));
  back_.push_back(poses_.back().inverse());
  standing_.push_back(standing_bodies(machine_, pose));
  return poses_.size() - 1;
}

void ProgramCheck::dwell(double seconds, const NcPlace&, const AxisPositions&) {
  time_.dwell_s += seconds;
  // A billionth is rounding of the text.
  if (open_ && seconds >= job_.process.dwell_s - 1e-9) open_->has_dwell = true;
  if (chiseling_) chiseling_->dwell(seconds);
}

void ProgramCheck::finish() {
  if (chiseling_) chiseling_->finish();
}

void ProgramCheck::end(const NcEnd& end) {
  close_plunge();
  runs_.end();
  if (end.is_complete) return;
  report("truncated", {end.line, 0}, -1, "the program stops in the middle: " + end.reason, 0.0, 0.0);
}

void ProgramCheck::motion(const NcMotion& motion, const NcSettings& settings) {
  check_axes(motion);
  check_limits(motion);
  count_time(motion);
  const std::optional<std::size_t> run = visits_.empty() ? std::nullopt : runs_.of(motion);
  if (motion.moved == 0) return;
  const std::uint8_t rotary = rotary_bits(machine_);
  if ((motion.moved & rotary) != 0) {
    close_plunge();
    return check_turn(motion);
  }
  // Before X, Y and Z are known nothing can be said; the settings are looked at when the first cut comes.
  const auto all = static_cast<std::uint8_t>(kLinearBits | rotary);
  const auto known_after = static_cast<std::uint8_t>((motion.known | motion.moved) & all);
  if (known_after != all || (motion.known & kLinearBits) != kLinearBits) return;
  SweptVolume sweep;
  sweep.pose = static_cast<std::uint32_t>(pose_index(rotary_pose(machine_, motion.to)));
  sweep.place = motion.place;
  sweep.is_rapid = motion.move == NcMove::rapid;
  sweep.from_mm = machine_point(machine_, motion.from) + wedge_.tip_mm;
  sweep.to_mm = machine_point(machine_, motion.to) + wedge_.tip_mm;
  const std::optional<std::size_t> element = run ? visits_[*run] : element_of(sweep);
  find_corners(sweep, element);
  check_fixtures(sweep);
  if (sweep.is_rapid) check_rapid(motion, sweep);
  if (corners_.empty()) {
    close_plunge();
    if (!sweep.is_rapid && motion.feed_mm_per_min <= 0.0) check_feed(motion, 0.0);
    return;
  }
  check_settings(settings, motion.place);
  check_holder(sweep);
  if (!element) {
    close_plunge();
    return check_outside(sweep);
  }
  sweeps_[*element].push_back(sweep);
  check_cut(motion, sweep, *element);
}

void ProgramCheck::check_settings(const NcSettings& settings, const NcPlace& place) {
  if (settings_are_checked_) return;
  settings_are_checked_ = true;
  const auto require = [&](bool holds, const char* what) {
    if (!holds) report("setup", place, -1, std::string("before the first cut the program does not say ") + what, 0, 0);
  };
  require(settings.absolute.has_value(), "whether positions are absolute or incremental");
  require(settings.feed_time_s.has_value(), "that feeds are per minute");
  require(settings.exact_stop.value_or(false), "that moves stop exactly: corners would be rounded");
  require(settings.compensation_off.value_or(false), "that compensations of the tool are off");
  require(settings.spindle == NcSpindle::stopped, "that the spindle stands still");
}

void ProgramCheck::check_limits(const NcMotion& motion) {
  for (const LimitExcess& excess : limit_excesses(machine_, motion.to)) {
    const bool is_known = ((motion.known | motion.moved) >> kNcAxisLetters.find(excess.axis) & 1U) != 0;
    if (!is_known) continue;
    const double limit = excess.position > excess.limits.high ? excess.limits.high : excess.limits.low;
    report("axis_limit", motion.place, -1,
           fmt::format("{} goes to {}, beyond its limits {} to {}", excess.axis, shortest(excess.position),
                       shortest(excess.limits.low), shortest(excess.limits.high)),
           excess.position, limit);
  }
}

void ProgramCheck::check_axes(const NcMotion& motion) {
  const char axis = missing_axis(machine_);
  if ((motion.moved & bit_of(axis)) != 0)
    report("axis_unknown", motion.place, -1, fmt::format("machine {} has no axis {}", machine_.name, axis), 0, 0);
}

void ProgramCheck::check_turn(const NcMotion& motion) {
  if ((motion.moved & kLinearBits) != 0)
    report("combined_move", motion.place, -1, "rotary and linear axes move at once", 0, 0);
  if ((motion.known & 0b00100) == 0) {
    report("turn_too_low", motion.place, -1, "the table turns before Z is known", 0, 0);
    return;
  }
  if (machine_.tilt == Tilt::head) return check_turn_of_head(motion);
  const geometry::Vec2 half = 0.5 * blank_extent_mm(job_);
  const Vec3 tip = machine_point(machine_, motion.from) + wedge_.tip_mm;
  double highest_mm = -std::numeric_limits<double>::infinity();
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const RotaryPose pose = {motion.from.a_deg + t * (motion.to.a_deg - motion.from.a_deg),
                             motion.from.c_deg + t * (motion.to.c_deg - motion.from.c_deg)};
    const RigidMotion turn = machine_from_workpiece(machine_, pose);
    for (const double x : {-half.x(), half.x()})
      for (const double y : {-half.y(), half.y()}) highest_mm = std::max(highest_mm, turn.point(Vec3(x, y, 0)).z());
    if ((motion.known & kLinearBits) != kLinearBits) continue;
    for (const BodyContact& contact : contacts(tool_bodies_, standing_bodies(machine_, pose), tip, tip))
      report_contact(contact, motion.place);
  }
  const double z_mm = tip.z();
  if (z_mm < highest_mm)
    report("turn_too_low", motion.place, -1,
           fmt::format("the turning blank comes up to Z {} mm while the tool stands at Z {} mm", fixed(highest_mm, 3),
                       fixed(z_mm, 3)),
           z_mm, highest_mm);
}

/// The blank stays level, and a head that turns swings the tool about B: the tip must stay above the blank's face.
void ProgramCheck::check_turn_of_head(const NcMotion& motion) {
  double lowest_mm = std::numeric_limits<double>::infinity();
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    AxisPositions axes = motion.from;
    axes.b_deg += t * (motion.to.b_deg - motion.from.b_deg);
    axes.c_deg += t * (motion.to.c_deg - motion.from.c_deg);
    const RotaryPose pose = rotary_pose(machine_, axes);
    const Vec3 tip = machine_point(machine_, axes) + wedge_.tip_mm;
    lowest_mm = std::min(lowest_mm, machine_from_workpiece(machine_, pose).inverse().point(tip).z());
    if ((motion.known & kLinearBits) != kLinearBits) continue;
    for (const BodyContact& contact : contacts(tool_bodies_, standing_bodies(machine_, pose), tip, tip))
      report_contact(contact, motion.place);
  }
  if (lowest_mm < 0.0)
    report("turn_too_low", motion.place, -1,
           fmt::format("the tip comes to {} mm over the blank's face while the axes turn", fixed(lowest_mm, 3)),
           lowest_mm, 0.0);
}

void ProgramCheck::find_corners(const SweptVolume& sweep, std::optional<std::size_t> element) {
  corners_.clear();
  const RigidMotion& back = back_[sweep.pose];
  // Beside the elements the blank ends in the plane that touches its face under the tool.
  const Vec3 tip = back.point(sweep.to_mm);
  const Vec3 out = element ? workpiece_.grooves[*element].axis : face_.normal_at(tip);
  const double face_mm = element           ? workpiece_.grooves[*element].face_mm
                         : face_.is_flat() ? 0.0
                                           : out.dot(tip) - face_.height_mm(tip);
  const auto height_mm = [&](const Vec3& p) { return out.dot(p) - face_mm; };
  const Vec3 half_edge = wedge_.half_width_mm * wedge_.edge;
  // The four corners of the parallelogram that the edge sweeps, in order.
  const std::array<Vec3, 4> swept = {back.point(sweep.from_mm - half_edge), back.point(sweep.from_mm + half_edge),
                                     back.point(sweep.to_mm + half_edge), back.point(sweep.to_mm - half_edge)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& a = swept[i];
    const Vec3& b = swept[(i + 1) % 4];
    const double a_mm = height_mm(a);
    const double b_mm = height_mm(b);
    if (a_mm < 0.0) {
      corners_.push_back(a);
      // Up the faces of the wedge to where they leave the blank.
      for (const Vec3& face : wedge_.rays) {
        const Vec3 up = back.direction(face);
        const double rise = out.dot(up);
        if (rise > 1e-3) corners_.push_back(a - up * (a_mm / rise));
      }
    }
    if ((a_mm < 0.0) != (b_mm < 0.0)) corners_.push_back(interpolated(a, b, a_mm, b_mm));
  }
}

std::optional<std::size_t> ProgramCheck::element_of(const SweptVolume& sweep) const {
  const Vec3 from = back_[sweep.pose].point(sweep.from_mm);
  const Vec3 to = back_[sweep.pose].point(sweep.to_mm);
  return map_.at(from.z() < to.z() ? from : to);
}

/// Least height of the tip over the blank on the way; over a flat one at an end of it.
double ProgramCheck::lowest_over_blank_mm(const SweptVolume& sweep) const {
  const Vec3 from = back_[sweep.pose].point(sweep.from_mm);
  const Vec3 to = back_[sweep.pose].point(sweep.to_mm);
  double lowest_mm = std::min(face_.height_mm(from), face_.height_mm(to));
  if (face_.is_flat()) return lowest_mm;
  constexpr double kStepMm = 0.05;
  constexpr double kMostSteps = 4000.0;
  const int steps = static_cast<int>(std::min(kMostSteps, std::ceil((to - from).norm() / kStepMm)));
  for (int i = 1; i < steps; ++i)
    lowest_mm = std::min(lowest_mm, face_.height_mm(from + (to - from) * (static_cast<double>(i) / steps)));
  return lowest_mm;
}

void ProgramCheck::check_rapid(const NcMotion& motion, const SweptVolume& sweep) {
  const double clearance_mm = kClearanceShare * job_.process.clearance_mm;
  const double lowest_mm = lowest_over_blank_mm(sweep);
  const bool goes_down = motion.to.z_mm < motion.from.z_mm;
  const std::optional<std::size_t> element = element_of(sweep);
  if (lowest_mm < -workpiece_.tolerance_mm)
    report("rapid_in_material", motion.place, element ? static_cast<std::int64_t>(*element) : -1,
           fmt::format("a rapid move goes {} um below the blank's face", fixed(-1e3 * lowest_mm, 3)), 1e3 * lowest_mm,
           0);
  else if (lowest_mm < clearance_mm && (goes_down || motion.moved != 0b00100))
    report("clearance", motion.place, -1,
           fmt::format("a rapid move comes to {} um above the blank's face, must keep {}", fixed(1e3 * lowest_mm, 3),
                       fixed(1e3 * clearance_mm, 1)),
           1e3 * lowest_mm, 1e3 * clearance_mm);
  if (goes_down && (motion.moved & 0b00011) != 0)
    report("rapid_descent", motion.place, -1, "a rapid move goes down in Z together with another axis", 0, 0);
}

void ProgramCheck::check_feed(const NcMotion& motion, double allowed) {
  if (motion.feed_mm_per_min <= 0.0)
    report("zero_feed", motion.place, -1, "a cutting move has a feed of 0", 0, 0);
  else if (motion.feed_mm_per_min > allowed * (1.0 + 1e-9))
    report("feed_too_high", motion.place, -1,
           fmt::format("a cut has a feed of {} mm/min, the process allows {}", shortest(motion.feed_mm_per_min),
                       shortest(allowed)),
           motion.feed_mm_per_min, allowed);
}

/// The tool against table, cradle and fixtures, all of them convex.
void ProgramCheck::check_fixtures(const SweptVolume& sweep) {
  for (const BodyContact& contact : contacts(tool_bodies_, standing_[sweep.pose], sweep.from_mm, sweep.to_mm))
    report_contact(contact, sweep.place);
}

void ProgramCheck::report_contact(const BodyContact& contact, const NcPlace& place) {
  report("fixture_collision", place, -1, "the " + contact.tool + " runs into the " + contact.other, 0, 0);
}

void ProgramCheck::check_holder(const SweptVolume& sweep) {
  const RigidMotion& back = back_[sweep.pose];
  for (const MachineBody& body : machine_.bodies) {
    if (body.carrier != Carrier::tool) continue;
    for (const Vec3& corner : body.points_mm.value)
      for (const Vec3& tip : {sweep.from_mm, sweep.to_mm}) {
        const Vec3 at = back.point(tip + corner);
        const double height_mm = face_.height_mm(at);
        const double rise = face_.normal_at(at).dot(back.direction(Vec3::UnitZ()));
        // How long the tool would have to be for this corner to clear the face.
        if (rise > 1e-3) least_free_tool_mm_ = std::max(least_free_tool_mm_, corner.z() - height_mm / rise);
        if (height_mm < 0.0)
          report("holder_collision", sweep.place, -1,
                 fmt::format("{} goes {} mm into the blank", body.name, fixed(-height_mm, 3)), height_mm, 0);
      }
  }
}

void ProgramCheck::check_outside(const SweptVolume& sweep) {
  double deepest_mm = 0.0;
  for (const Vec3& corner : corners_) deepest_mm = std::min(deepest_mm, face_.height_mm(corner));
  if (deepest_mm < -workpiece_.tolerance_mm)
    report("gouge", sweep.place, -1,
           fmt::format("the tool cuts {} nm deep beside the elements", fixed(-deepest_mm * kNmPerMm, 1)),
           -deepest_mm * kNmPerMm, workpiece_.tolerance_mm * kNmPerMm);
}

void ProgramCheck::check_cut(const NcMotion& motion, const SweptVolume& sweep, std::size_t element) {
  const Groove& groove = workpiece_.grooves[element];
  const Prediction& prediction = workpiece_.prediction(element);
  const auto number = static_cast<std::int64_t>(element);
  double gouge_mm = 0.0;
  double wall_mm = 0.0;
  for (const Vec3& corner : corners_) {
    for (const DesignFacet& facet : groove.facets) gouge_mm = std::max(gouge_mm, -facet.height_mm(corner));
    if (!groove.is_cube()) wall_mm = std::max(wall_mm, std::abs(groove.along_mm(corner)) - groove.half_width_mm);
  }
  deepest_wall_mm_ = std::max(deepest_wall_mm_, wall_mm);
  if (gouge_mm > workpiece_.tolerance_mm)
    report("gouge", motion.place, number,
           fmt::format("the tool goes {} nm below the design's facet", fixed(gouge_mm * kNmPerMm, 1)),
           gouge_mm * kNmPerMm, workpiece_.tolerance_mm * kNmPerMm);
  const double wall_limit_mm = prediction.wall_mm + workpiece_.tolerance_mm;
  if (wall_mm > wall_limit_mm)
    report("wall_overcut", motion.place, number,
           fmt::format("the tool goes {} nm into the wall, {} are unavoidable", fixed(wall_mm * kNmPerMm, 1),
                       fixed(prediction.wall_mm * kNmPerMm, 1)),
           wall_mm * kNmPerMm, wall_limit_mm * kNmPerMm);
  if (sweep.is_rapid) return close_plunge();
  if (chiseling_) return check_chiseling(motion, sweep, element);
  const Vec3 travel = sweep.to_mm - sweep.from_mm;
  const double z_share = travel.z() / travel.norm();
  // Only a retract may move the tool towards the facet that its clearance face looks at.
  if (z_share < 0.5 && travel.y() > kMostSlip * travel.norm())
    report("clearance_face_leads", motion.place, number, "the tool is pushed into the material by its clearance face",
           0, 0);
  if (z_share < -kMostlyAlong) return check_plunge(motion, sweep, element);
  if (z_share < 0.5) return check_plough(motion, sweep, element);
  if (motion.feed_mm_per_min <= 0.0) check_feed(motion, 0.0);
  close_plunge();
}

void ProgramCheck::check_chiseling(const NcMotion& motion, const SweptVolume& sweep, std::size_t element) {
  check_feed(motion, std::max(job_.process.roughing_feed_mm_per_min, job_.process.finishing_feed_mm_per_min));
  const Vec3 travel = sweep.to_mm - sweep.from_mm;
  if (travel.dot(wedge_.sides[0].outward) > kMostSlip * travel.norm())
    report("clearance_face_leads", motion.place, static_cast<std::int64_t>(element),
           "the tool is pushed into the material by its clearance face", 0, 0);
  chiseling_->move(sweep, back_[sweep.pose], wedge_, element);
}

void ProgramCheck::check_plunge(const NcMotion& motion, const SweptVolume& sweep, std::size_t element) {
  close_plunge();
  check_feed(motion, std::max(job_.process.roughing_feed_mm_per_min, job_.process.finishing_feed_mm_per_min));
  const Groove& groove = workpiece_.grooves[element];
  const Vec3 upright = poses_[sweep.pose].direction(groove.facets[0].normal);
  OpenPlunge plunge;
  plunge.element = element;
  plunge.place = motion.place;
  // The plunged facet faces away from the clearance face.
  plunge.facet = upright.dot(wedge_.sides[0].outward) < 0.0 && std::abs(upright.z()) < 0.5 ? 0 : 1;
  plunge.tip_mm = {1e9, 1e9};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 tip = back_[sweep.pose].point(sweep.to_mm + side * wedge_.half_width_mm * wedge_.edge);
    for (std::size_t f = 0; f < 2; ++f) plunge.tip_mm[f] = std::min(plunge.tip_mm[f], groove.facets[f].height_mm(tip));
  }
  CutState& state = states_[element];
  const Vec3 tip = back_[sweep.pose].point(sweep.to_mm);
  // Where nothing was cut before, the blank's face ends the chip.
  plunge.chip_mm = std::min(state.surface_mm[plunge.facet] - plunge.tip_mm[plunge.facet],
                            groove.to_face_mm(tip, groove.facets[plunge.facet].normal));
  check_chip_thickness(plunge);
  for (const auto& known : state.tips)
    if (known[3] == static_cast<double>(plunge.facet) && (Vec3(known[0], known[1], known[2]) - tip).norm() < kSameTipMm)
      report("cut_twice", motion.place, static_cast<std::int64_t>(element), "this cut has been made before", 0, 0);
  state.tips.push_back({tip.x(), tip.y(), tip.z(), static_cast<double>(plunge.facet)});
  open_ = plunge;
}

void ProgramCheck::check_chip_thickness(const OpenPlunge& plunge) {
  const double deepest_mm =
      1e-3 * std::max(job_.process.roughing_depth_um,
                      job_.strategy == Strategy::two_step ? job_.process.finishing_depth_um : 0.0);
  // The first of nested V shells is a whole V, which both of its plunges take from the blank's face: two depths wide.
  const bool is_first_shell =
      job_.strategy == Strategy::bidirectional && states_[plunge.element].surface_mm[plunge.facet] > 1e8;
  const double limit_mm = (is_first_shell ? 2.0 : 1.0) * deepest_mm + workpiece_.tolerance_mm +
                          workpiece_.prediction(plunge.element).root_mm;
  if (plunge.chip_mm > limit_mm)
    report("chip_too_thick", plunge.place, static_cast<std::int64_t>(plunge.element),
           fmt::format("the plunge takes {} um at once, the process {} um: a cut before it is missing",
                       fixed(1e3 * plunge.chip_mm, 3), shortest(1e3 * deepest_mm)),
           1e3 * plunge.chip_mm, 1e3 * limit_mm);
}

void ProgramCheck::check_plough(const NcMotion& motion, const SweptVolume& sweep, std::size_t element) {
  check_feed(motion, std::max(job_.process.roughing_feed_mm_per_min, job_.process.finishing_feed_mm_per_min));
  if (!open_ || open_->element != element) return;
  if (!open_->has_dwell && job_.process.dwell_s > 0.0)
    report("missing_dwell", open_->place, static_cast<std::int64_t>(element),
           fmt::format("the plunge ends without its dwell of {} s", shortest(job_.process.dwell_s)), 0,
           job_.process.dwell_s);
  const double length_mm = (sweep.to_mm - sweep.from_mm).norm();
  const double chip_mm = std::min(open_->chip_mm, 1e-3 * job_.process.roughing_depth_um);
  if (length_mm < chip_mm - workpiece_.tolerance_mm)
    report("chip_not_separated", motion.place, static_cast<std::int64_t>(element),
           fmt::format("the plough is {} um long, the chip {} um thick", fixed(1e3 * length_mm, 3),
                       fixed(1e3 * chip_mm, 3)),
           1e3 * length_mm, 1e3 * chip_mm);
  CutState& state = states_[element];
  for (std::size_t f = 0; f < 2; ++f) state.surface_mm[f] = std::min(state.surface_mm[f], open_->tip_mm[f]);
  state.last[open_->facet] = CutState::Plunge{open_->tip_mm, open_->place.line};
  open_.reset();
}

void ProgramCheck::close_plunge() {
  if (chiseling_) chiseling_->close();
  if (!open_) return;
  if (!open_->has_dwell && job_.process.dwell_s > 0.0)
    report("missing_dwell", open_->place, static_cast<std::int64_t>(open_->element),
           fmt::format("the plunge ends without its dwell of {} s", shortest(job_.process.dwell_s)), 0,
           job_.process.dwell_s);
  check_chip();
  CutState& state = states_[open_->element];
  state.surface_mm[open_->facet] = std::min(state.surface_mm[open_->facet], open_->tip_mm[open_->facet]);
  state.last[open_->facet] = CutState::Plunge{open_->tip_mm, open_->place.line};
  open_.reset();
}

/// A chip that no plough frees needs two plunges: the first passes the other facet's surface by its own depth, the
/// second ends on what the first has left.
void ProgramCheck::check_chip() {
  const std::size_t f = open_->facet;
  const std::size_t g = 1 - f;
  const CutState& state = states_[open_->element];
  const double tolerance_mm = workpiece_.tolerance_mm + workpiece_.prediction(open_->element).root_mm;
  const bool passes = open_->tip_mm[g] < state.surface_mm[g] - tolerance_mm;
  if (passes) return;
  const auto& before = state.last[g];
  const bool meets = before && before->tip_mm[f] <= open_->tip_mm[f] + tolerance_mm;
  if (meets) return;
  report("chip_not_separated", open_->place, static_cast<std::int64_t>(open_->element),
         "the plunge neither passes the other facet nor meets a cut along it that does: its chip hangs on",
         1e3 * (open_->tip_mm[g] - std::min(state.surface_mm[g], 1e3)), 0.0);
}

void ProgramCheck::count_time(const NcMotion& motion) {
  const auto known = [&](unsigned bit) { return (motion.known >> bit & 1U) != 0; };
  const std::array<double, 3> travel = {known(0) ? motion.to.x_mm - motion.from.x_mm : 0.0,
                                        known(1) ? motion.to.y_mm - motion.from.y_mm : 0.0,
                                        known(2) ? motion.to.z_mm - motion.from.z_mm : 0.0};
  const std::array<const LinearAxis*, 3> axes = {&machine_.x, &machine_.y, &machine_.z};
  const double distance = std::hypot(travel[0], travel[1], travel[2]);
  if (motion.move == NcMove::linear && distance > 0.0 && motion.feed_mm_per_min > 0.0) {
    double acceleration = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
      if (travel[i] != 0.0)
        acceleration = std::min(acceleration, axes[i]->acceleration_mm_per_s2.value * distance / std::abs(travel[i]));
    time_.feed_s += trapezoid_s(distance, motion.feed_mm_per_min / 60.0, acceleration);
  }
  if (motion.move == NcMove::rapid && distance > 0.0) {
    double slowest_s = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      slowest_s = std::max(slowest_s, trapezoid_s(std::abs(travel[i]), axes[i]->rapid_mm_per_min.value / 60.0,
                                                  axes[i]->acceleration_mm_per_s2.value));
    time_.rapid_s += slowest_s;
  }
  // The tool is touched off at A = C = 0, from where the first turn starts.
  const RotaryPose from = rotary_pose(machine_, motion.from);
  const RotaryPose to = rotary_pose(machine_, motion.to);
  const double a_s = trapezoid_s(std::abs(to.a_deg - from.a_deg), machine_.a.speed_deg_per_s.value,
                                 machine_.a.acceleration_deg_per_s2.value);
  const double c_s = trapezoid_s(std::abs(to.c_deg - from.c_deg), machine_.c.speed_deg_per_s.value,
                                 machine_.c.acceleration_deg_per_s2.value);
  time_.rotary_s += std::max(a_s, c_s);
}

}  // namespace retrace::fabrication
