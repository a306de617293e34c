#include "fabrication/chisel/check/way_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Share of the process's clearance that rapid moves must keep from the blank's face.
constexpr double kClearanceShare = 0.9;

/// How much of the diamond counts as a body: more than the deepest groove; what holds it, the machine file says.
double diamond_mm(const Workpiece3d& workpiece) {
  constexpr double kDepths = 2.0;
  return workpiece.grooves.empty() ? 1.0 : kDepths * workpiece.grooves.front().depth_mm;
}

}  // namespace

WayCheck::WayCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, FindingList& findings)
    : job_(*workpiece.job),
      machine_(*workpiece.machine),
      tolerance_mm_(workpiece.tolerance_mm),
      wedge_(wedge),
      face_(job_),
      tool_bodies_(tool_bodies(machine_, wedge, diamond_mm(workpiece))),
      findings_(findings) {}

void WayCheck::turn(const NcMotion& motion) {
  if ((motion.moved & kLinearBits) != 0)
    findings_.add("combined_move", motion.place.line, "rotary and linear axes move at once");
  if ((motion.known & 0b00100) == 0) {
    findings_.add("turn_too_low", motion.place.line, "the table turns before Z is known");
    return;
  }
  if (machine_.tilt == Tilt::head) return turn_of_head(motion);
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
    findings_.add("turn_too_low", motion.place.line,
                  fmt::format("the turning blank comes up to Z {} mm while the tool stands at Z {} mm",
                              fixed(highest_mm, 3), fixed(z_mm, 3)),
                  z_mm, highest_mm);
}

/// The blank stays level, and a head that turns swings the tool about B: the tip must stay above the blank's face.
void WayCheck::turn_of_head(const NcMotion& motion) {
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
    findings_.add("turn_too_low", motion.place.line,
                  fmt::format("the tip comes to {} mm over the blank's face while the axes turn", fixed(lowest_mm, 3)),
                  lowest_mm, 0.0);
}

/// Least height of the tip over the blank on the way; over a flat one at an end of it.
double WayCheck::lowest_over_blank_mm(const SweptVolume& sweep, const RigidMotion& back) const {
  const Vec3 from = back.point(sweep.from_mm);
  const Vec3 to = back.point(sweep.to_mm);
  double lowest_mm = std::min(face_.height_mm(from), face_.height_mm(to));
  if (face_.is_flat()) return lowest_mm;
  constexpr double kStepMm = 0.05;
  constexpr double kMostSteps = 4000.0;
  const int steps = static_cast<int>(std::min(kMostSteps, std::ceil((to - from).norm() / kStepMm)));
  for (int i = 1; i < steps; ++i)
    lowest_mm = std::min(lowest_mm, face_.height_mm(from + (to - from) * (static_cast<double>(i) / steps)));
  return lowest_mm;
}

void WayCheck::rapid(const NcMotion& motion, const SweptVolume& sweep, const RigidMotion& back,
                     std::optional<std::size_t> element) {
  const double clearance_mm = kClearanceShare * job_.process.clearance_mm;
  const double lowest_mm = lowest_over_blank_mm(sweep, back);
  const bool goes_down = motion.to.z_mm < motion.from.z_mm;
  if (lowest_mm < -tolerance_mm_)
    findings_.add("rapid_in_material", motion.place.line,
                  fmt::format("a rapid move goes {} um below the blank's face", fixed(-1e3 * lowest_mm, 3)),
                  1e3 * lowest_mm, 0.0, element ? static_cast<std::int64_t>(*element) : -1);
  else if (lowest_mm < clearance_mm && (goes_down || motion.moved != 0b00100))
    findings_.add("clearance", motion.place.line,
                  fmt::format("a rapid move comes to {} um above the blank's face, must keep {}",
                              fixed(1e3 * lowest_mm, 3), fixed(1e3 * clearance_mm, 1)),
                  1e3 * lowest_mm, 1e3 * clearance_mm);
  if (goes_down && (motion.moved & 0b00011) != 0)
    findings_.add("rapid_descent", motion.place.line, "a rapid move goes down in Z together with another axis");
}

/// The tool against table, cradle and fixtures, all of them convex.
void WayCheck::fixtures(const SweptVolume& sweep, std::span<const PlacedBody> standing) {
  for (const BodyContact& contact : contacts(tool_bodies_, standing, sweep.from_mm, sweep.to_mm))
    report_contact(contact, sweep.place);
}

void WayCheck::report_contact(const BodyContact& contact, const NcPlace& place) {
  findings_.add("fixture_collision", place.line, "the " + contact.tool + " runs into the " + contact.other);
}

void WayCheck::holder(const SweptVolume& sweep, const RigidMotion& back) {
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
          findings_.add("holder_collision", sweep.place.line,
                        fmt::format("{} goes {} mm into the blank", body.name, fixed(-height_mm, 3)), height_mm, 0);
      }
  }
}

void WayCheck::outside(const SweptVolume& sweep, std::span<const Vec3> corners) {
  double deepest_mm = 0.0;
  for (const Vec3& corner : corners) deepest_mm = std::min(deepest_mm, face_.height_mm(corner));
  if (deepest_mm < -tolerance_mm_)
    findings_.add("gouge", sweep.place.line,
                  fmt::format("the tool cuts {} nm deep beside the elements", fixed(-deepest_mm * kNmPerMm, 1)),
                  -deepest_mm * kNmPerMm, tolerance_mm_ * kNmPerMm);
}

}  // namespace retrace::fabrication
