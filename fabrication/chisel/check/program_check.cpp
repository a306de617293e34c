#include "fabrication/chisel/check/program_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/length_units.h"
#include "core/number_format.h"
#include "fabrication/chisel/check/chiseling_check.h"
#include "fabrication/chisel/check/plunge_check.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

std::uint8_t rotary_bits(const Machine& machine) {
  const auto bit = [](char axis) { return 1U << kNcAxisLetters.find(axis); };
  return static_cast<std::uint8_t>(bit(machine.tilt_letter()) | bit('C'));
}

Vec3 interpolated(const Vec3& a, const Vec3& b, double a_height, double b_height) {
  return a + (b - a) * (a_height / (a_height - b_height));
}

ControlRule control_rule_of(const Job& job, const Machine& machine) {
  ControlRule rule;
  rule.needs_mist = job.process.mist;
  // A tool that dwells too long in the material marks the surface. It also rubs after the mist has dispersed.
  rule.max_dwell_s = 2.0 * job.process.dwell_s + 0.1;
  rule.axes = static_cast<std::uint8_t>(kLinearBits | rotary_bits(machine));
  rule.safe_z_mm = machine.first_z_mm();
  return rule;
}

std::unique_ptr<CutCheck> cut_check_of(const VerificationModel& workpiece, const ToolWedge& wedge,
                                       ControlCheck& control, FindingList& findings) {
  if (cuts_prisms(*workpiece.job)) return std::make_unique<PlungeCheck>(workpiece, wedge, control, findings);
  return std::make_unique<ChiselingCheck>(workpiece, wedge, control, findings);
}

}  // namespace

ProgramCheck::ProgramCheck(const VerificationModel& workpiece, FindingList& findings,
                           std::vector<std::optional<std::size_t>> visits)
    : workpiece_(workpiece),
      machine_(*workpiece.machine),
      findings_(findings),
      map_(workpiece.cavities),
      element_of_run_(std::move(visits)),
      wedge_(wedge_of(*workpiece.job, machine_)),
      control_(findings, control_rule_of(*workpiece.job, machine_), machine_.control),
      collisions_(workpiece, wedge_, findings),
      cuts_(cut_check_of(workpiece, wedge_, control_, findings)),
      stops_(workpiece, wedge_, findings),
      sweeps_(workpiece.cavities.size()) {}

void ProgramCheck::begin(const NcProgram& program) {
  findings_.begin(program.file);
  ++programs_begun_;
  control_.begin(program);
  stops_.begin(time_.total_s());
}

std::vector<RigidMotion> ProgramCheck::poses() const {
  return poses_;
}

std::size_t ProgramCheck::pose_index(const RotaryPose& pose) {
  // Poses whose C angles differ by full turns are equal. Angles are compared in units of 1e-8 degrees, which are much
  // larger than the rounding errors of sums.
  constexpr double kUnitsPerDeg = 1e8;
  constexpr auto kTurn = static_cast<std::int64_t>(360.0 * kUnitsPerDeg);
  const auto units = [](double deg) { return std::llround(deg * kUnitsPerDeg); };
  const auto [known, is_new] =
      known_poses_.try_emplace({units(pose.a_deg), (units(pose.c_deg) % kTurn + kTurn) % kTurn}, rounded_poses_.size());
  if (!is_new) return known->second;
  rounded_poses_.push_back(pose);
  poses_.push_back(machine_from_workpiece(machine_, pose));
  back_.push_back(poses_.back().inverse());
  stationary_.push_back(stationary_bodies(machine_, pose));
  return poses_.size() - 1;
}

void ProgramCheck::dwell(double seconds, const NcLocation& place, const AxisPositions&) {
  time_.dwell_s += seconds;
  if (is_in_blank_) control_.dwell(seconds, place);
  cuts_->dwell(seconds);
}

void ProgramCheck::stop(NcStop kind, const NcSettings& settings, const NcLocation& place) {
  if (is_in_blank_) control_.dwell(std::numeric_limits<double>::infinity(), place);
  if (kind != NcStop::always) return;
  cuts_->close();
  control_.stop(settings, at_, place);
  stops_.stop(time_.total_s());
}

void ProgramCheck::finish() {
  cuts_->finish();
}

void ProgramCheck::end(const NcEnd& end) {
  cuts_->close();
  runs_.end();
  is_in_blank_ = false;
  if (!end.is_complete) findings_.add("truncated", end.line, "the program is incomplete: " + end.reason);
}

void ProgramCheck::motion(const NcMotion& motion, const NcSettings& settings) {
  // After a stop, the axis positions are not known because the operator may have moved the axes.
  NcMotion from_known = motion;
  from_known.known = control_.known_axes();
  time_.add(machine_, from_known);
  control_.move(settings, motion);
  control_.axes(machine_, motion);
  at_ = motion.to;
  const std::optional<std::size_t> run = element_of_run_.empty() ? std::nullopt : runs_.run_of(motion);
  if (motion.moved == 0) return;
  const std::uint8_t rotary = rotary_bits(machine_);
  is_in_blank_ = false;
  if ((motion.moved & rotary) != 0) {
    cuts_->close();
    return collisions_.rotary_move(motion);
  }
  // If a position is not known, ControlCheck ensures that the tool is above the safe height, so no cut is possible.
  const auto all = static_cast<std::uint8_t>(kLinearBits | rotary);
  const auto known_after = static_cast<std::uint8_t>((motion.known | motion.moved) & all);
  if (known_after != all || (motion.known & kLinearBits) != kLinearBits) return;
  SweptVolume sweep;
  sweep.pose = static_cast<std::uint32_t>(pose_index(rotary_pose(machine_, motion.to)));
  sweep.location = motion.location;
  sweep.program = programs_begun_ - 1;
  sweep.is_rapid = motion.move == NcMove::rapid;
  sweep.from_mm = machine_point(machine_, motion.from) + wedge_.tip_mm;
  sweep.to_mm = machine_point(machine_, motion.to) + wedge_.tip_mm;
  const RigidMotion& back = back_[sweep.pose];
  const std::optional<std::size_t> element = run ? element_of_run_[*run] : element_of(sweep);
  is_in_blank_ = collisions_.face().height_mm(back.point(sweep.to_mm)) < 0.0;
  find_corners(sweep, element);
  collisions_.fixtures(motion, stationary_[sweep.pose]);
  if (sweep.is_rapid) collisions_.rapid(motion, back, element);
  if (corners_.empty()) {
    return cuts_->close();
  }
  control_.cut(settings, motion.location);
  collisions_.holder(sweep, back);
  if (!element) {
    cuts_->close();
    return collisions_.outside(sweep, corners_);
  }
  sweeps_[*element].push_back(sweep);
  check_cut(motion, sweep, *element);
}

void ProgramCheck::find_corners(const SweptVolume& sweep, std::optional<std::size_t> element) {
  corners_.clear();
  const RigidMotion& back = back_[sweep.pose];
  const BlankFace& face = collisions_.face();
  // Outside of the elements, the face is approximated by its tangent plane below the tool.
  const Vec3 tip = back.point(sweep.to_mm);
  const Vec3 out = element ? workpiece_.design(*element).axis : face.normal_at(tip);
  const double face_mm = element          ? workpiece_.design(*element).face_mm
                         : face.is_flat() ? 0.0
                                          : out.dot(tip) - face.height_mm(tip);
  const auto height_mm = [&](const Vec3& p) { return out.dot(p) - face_mm; };
  const Vec3 half_edge = wedge_.half_width_mm * wedge_.edge;
  // Corners of the parallelogram that the edge sweeps, in cyclic order.
  const std::array<Vec3, 4> swept = {back.point(sweep.from_mm - half_edge), back.point(sweep.from_mm + half_edge),
                                     back.point(sweep.to_mm + half_edge), back.point(sweep.to_mm - half_edge)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& a = swept[i];
    const Vec3& b = swept[(i + 1) % 4];
    const double a_mm = height_mm(a);
    const double b_mm = height_mm(b);
    if (a_mm < 0.0) {
      corners_.push_back(a);
      // Add the points at which the upward edges of the wedge leave the blank.
      for (const Vec3& ray : wedge_.rays) {
        const Vec3 up = back.direction(ray);
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

void ProgramCheck::check_cut(const NcMotion& motion, const SweptVolume& sweep, std::size_t element) {
  const auto* const prism = std::get_if<PrismGroove>(&workpiece_.cavities[element]);
  const Prediction& prediction = workpiece_.prediction(element);
  const auto find = [&](const char* kind, std::string message, double value_mm, double limit_mm) {
    findings_.add(kind, motion.location.line, std::move(message), value_mm * kNmPerMm, limit_mm * kNmPerMm,
                  static_cast<std::int64_t>(element));
  };
  double gouge_mm = 0.0;
  double wall_mm = 0.0;
  for (const Vec3& corner : corners_) {
    for (const DesignFacet& facet : workpiece_.design(element).facets)
      gouge_mm = std::max(gouge_mm, -facet.height_mm(corner));
    if (prism != nullptr) wall_mm = std::max(wall_mm, std::abs(prism->along_mm(corner)) - prism->half_width_mm);
  }
  deepest_wall_mm_ = std::max(deepest_wall_mm_, wall_mm);
  if (gouge_mm > workpiece_.tolerance_mm)
    find("gouge", fmt::format("the tool cuts {} nm below the design's facet", fixed(gouge_mm * kNmPerMm, 1)), gouge_mm,
         workpiece_.tolerance_mm);
  const double wall_limit_mm = prediction.wall_mm + workpiece_.tolerance_mm;
  if (wall_mm > wall_limit_mm)
    find("wall_overcut",
         fmt::format("the tool cuts {} nm into the wall, but only {} nm are unavoidable", fixed(wall_mm * kNmPerMm, 1),
                     fixed(prediction.wall_mm * kNmPerMm, 1)),
         wall_mm, wall_limit_mm);
  if (sweep.is_rapid) return cuts_->close();
  const CutMove cut{motion, sweep, poses_[sweep.pose], back_[sweep.pose], element};
  cuts_->move(cut);
  stops_.cut(cut, time_.total_s());
}

}  // namespace retrace::fabrication
