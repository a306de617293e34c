#include "fabrication/chisel/check/collision_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/length_units.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Fraction of the process's clearances that rapid moves and rotary moves must keep.
constexpr double kClearanceFraction = 0.9;

/// Returns the height of the diamond in collision checks, in mm. It is greater than the depth of the grooves. The
/// machine file describes the holder above it.
double diamond_mm(const VerificationModel& workpiece) {
  constexpr double kDepths = 2.0;
  return workpiece.cavities.empty() ? 1.0 : kDepths * workpiece.design(0).depth_mm;
}

}  // namespace

CollisionCheck::CollisionCheck(const VerificationModel& workpiece, const ToolWedge& wedge, FindingList& findings)
    : job_(*workpiece.job),
      machine_(*workpiece.machine),
      tolerance_mm_(workpiece.tolerance_mm),
      wedge_(wedge),
      face_(job_),
      tool_bodies_(tool_bodies(machine_, wedge, diamond_mm(workpiece))),
      findings_(findings) {}

void CollisionCheck::rotary_move(const NcMotion& motion) {
  if ((motion.moved & kLinearBits) != 0)
    findings_.add("combined_move", motion.location.line, "rotary and linear axes move at the same time");
  if ((motion.known & 0b00100) == 0) {
    findings_.add("rotation_too_low", motion.location.line, "the table rotates before the position of Z is known");
    return;
  }
  const auto rotary = static_cast<std::uint8_t>(motion.moved & ~kLinearBits);
  if ((motion.known & rotary) != rotary) return rotary_move_from_unknown(motion);
  const Vec3 tip = machine_point(machine_, motion.from) + wedge_.tip_mm;
  const bool knows_where = (motion.known & kLinearBits) == kLinearBits;
  double highest_mm = -std::numeric_limits<double>::infinity();
  double lowest_tip_mm = std::numeric_limits<double>::infinity();
  for (const AxisPositions& axes : positions_of_rotary_move(motion)) {
    const RotaryPose pose = rotary_pose(machine_, axes);
    const RigidMotion there = machine_from_workpiece(machine_, pose);
    const Vec3 at = machine_point(machine_, axes) + wedge_.tip_mm;
    if (machine_.tilt == Tilt::head)
      lowest_tip_mm = std::min(lowest_tip_mm, there.inverse().point(at).z());
    else
      highest_mm = std::max(highest_mm, highest_corner_mm(there));
    if (!knows_where) continue;
    const Vec3& stands = machine_.tilt == Tilt::head ? at : tip;
    for (const BodyContact& contact :
         contacts(tool_bodies_, stationary_bodies(machine_, pose), std::span<const Vec3>(&stands, 1)))
      report_contact(contact, motion.location);
  }
  const double clearance_mm = kClearanceFraction * job_.process.rotary_clearance_mm;
  if (machine_.tilt == Tilt::table && tip.z() < highest_mm + clearance_mm)
    findings_.add(
        "rotation_too_low", motion.location.line,
        fmt::format(
            "the rotating blank reaches Z {} mm while the tool is at Z {} mm, but the clearance must be at least {} mm",
            fixed(highest_mm, 3), fixed(tip.z(), 3), fixed(clearance_mm, 3)),
        tip.z(), highest_mm + clearance_mm);
  // The blank remains horizontal. A tilting head rotates the tool about B, so the tip must stay above the blank's face.
  if (machine_.tilt == Tilt::head && lowest_tip_mm < clearance_mm)
    findings_.add(
        "rotation_too_low", motion.location.line,
        fmt::format("the tip is {} mm above the blank's face while the axes rotate, but at least {} mm are required",
                    fixed(lowest_tip_mm, 3), fixed(clearance_mm, 3)),
        lowest_tip_mm, clearance_mm);
}

/// Checks a rotary move whose start position is not known. Only the safe Z position of the machine is clear of all
/// possible rotations.
void CollisionCheck::rotary_move_from_unknown(const NcMotion& motion) {
  const double safe_mm = machine_.first_z_mm();
  if (motion.from.z_mm < safe_mm - rounding_slack(motion, 'Z'))
    findings_.add(
        "rotation_too_low", motion.location.line,
        fmt::format("rotary axes with unknown positions move while Z is at {} mm, but Z must be at least at {} mm",
                    fixed_apart(motion.from.z_mm, safe_mm, 3), shortest(safe_mm)),
        motion.from.z_mm, safe_mm);
}

/// Returns sampled positions of a rotary move. If two axes move, each can move at its own speed. All combinations of
/// their angles are then sampled, unless the rapid moves of the machine are straight.
std::vector<AxisPositions> CollisionCheck::positions_of_rotary_move(const NcMotion& motion) const {
  const AxisPositions& from = motion.from;
  const AxisPositions& to = motion.to;
  const auto between = [&](double tilt, double c) {
    AxisPositions axes = from;
    axes.a_deg += tilt * (to.a_deg - from.a_deg);
    axes.b_deg += tilt * (to.b_deg - from.b_deg);
    axes.c_deg += c * (to.c_deg - from.c_deg);
    return axes;
  };
  std::vector<AxisPositions> places;
  const bool is_box =
      is_box_move(motion) && from.c_deg != to.c_deg && (from.a_deg != to.a_deg || from.b_deg != to.b_deg);
  const int steps = is_box ? 8 : 24;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    if (!is_box) places.push_back(between(t, t));
    for (int k = 0; is_box && k <= steps; ++k) places.push_back(between(t, static_cast<double>(k) / steps));
  }
  return places;
}

double CollisionCheck::highest_corner_mm(const RigidMotion& there) const {
  const geometry::Vec2 half = 0.5 * blank_extent_mm(job_);
  double highest_mm = -std::numeric_limits<double>::infinity();
  for (const double x : {-half.x(), half.x()})
    for (const double y : {-half.y(), half.y()}) highest_mm = std::max(highest_mm, there.point(Vec3(x, y, 0)).z());
  return highest_mm;
}

bool CollisionCheck::is_box_move(const NcMotion& motion) const {
  return motion.move == NcMove::rapid && !machine_.control.rapids_are_straight;
}

/// Returns the edge vectors of the region that a move can pass through. The region of a straight move is a line.
/// Otherwise, the region is a box with one edge per axis.
std::vector<Vec3> CollisionCheck::edge_vectors_of_move(const NcMotion& motion) const {
  const Vec3 from = machine_point(machine_, motion.from);
  if (!is_box_move(motion)) return {machine_point(machine_, motion.to) - from};
  std::vector<Vec3> edges;
  for (double AxisPositions::*axis : {&AxisPositions::x_mm, &AxisPositions::y_mm, &AxisPositions::z_mm}) {
    AxisPositions along = motion.from;
    along.*axis = motion.to.*axis;
    if (along.*axis != motion.from.*axis) edges.push_back(machine_point(machine_, along) - from);
  }
  return edges;
}

std::vector<Vec3> CollisionCheck::tip_positions_of_move(const NcMotion& motion) const {
  std::vector<Vec3> corners = {machine_point(machine_, motion.from) + wedge_.tip_mm};
  for (const Vec3& edge : edge_vectors_of_move(motion)) {
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) corners.push_back(corners[i] + edge);
  }
  return corners;
}

/// Returns the minimum height of the tip above the blank during a move. Over a flat blank, it occurs at a corner of the
/// region that the move can pass through.
double CollisionCheck::lowest_over_blank_mm(const NcMotion& motion, const RigidMotion& back) const {
  double lowest_mm = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : tip_positions_of_move(motion))
    lowest_mm = std::min(lowest_mm, face_.height_mm(back.point(corner)));
  if (face_.is_flat()) return lowest_mm;
  constexpr double kStepMm = 0.05;
  constexpr double kMaxSteps = 4000.0;
  const std::vector<Vec3> edges = edge_vectors_of_move(motion);
  const double most = std::floor(std::pow(kMaxSteps, 1.0 / std::max<double>(1.0, static_cast<double>(edges.size()))));
  std::vector<Vec3> places = {machine_point(machine_, motion.from) + wedge_.tip_mm};
  for (const Vec3& edge : edges) {
    const int steps = static_cast<int>(std::min(most, std::ceil(edge.norm() / kStepMm)));
    const std::size_t count = places.size();
    for (int k = 1; k <= steps; ++k)
      for (std::size_t i = 0; i < count; ++i) places.push_back(places[i] + edge * (static_cast<double>(k) / steps));
  }
  for (const Vec3& place : places) lowest_mm = std::min(lowest_mm, face_.height_mm(back.point(place)));
  return lowest_mm;
}

void CollisionCheck::rapid(const NcMotion& motion, const RigidMotion& back, std::optional<std::size_t> element) {
  const double clearance_mm = kClearanceFraction * job_.process.clearance_mm;
  const double lowest_mm = lowest_over_blank_mm(motion, back);
  const bool goes_down = motion.to.z_mm < motion.from.z_mm;
  if (lowest_mm < -tolerance_mm_)
    findings_.add("rapid_in_material", motion.location.line,
                  fmt::format("a rapid move goes {} um below the blank's face", fixed(-1e3 * lowest_mm, 3)),
                  1e3 * lowest_mm, 0.0, element ? static_cast<std::int64_t>(*element) : -1);
  else if (lowest_mm < clearance_mm && (goes_down || motion.moved != 0b00100))
    findings_.add("clearance", motion.location.line,
                  fmt::format("a rapid move is only {} um above the blank's face, but at least {} um are required",
                              fixed(1e3 * lowest_mm, 3), fixed(1e3 * clearance_mm, 1)),
                  1e3 * lowest_mm, 1e3 * clearance_mm);
  if (goes_down && (motion.moved & 0b00011) != 0)
    findings_.add("rapid_descent", motion.location.line, "a rapid move goes down in Z together with another axis");
}

void CollisionCheck::fixtures(const NcMotion& motion, std::span<const PlacedBody> stationary) {
  const std::vector<Vec3> places = tip_positions_of_move(motion);
  for (const BodyContact& contact : contacts(tool_bodies_, stationary, places))
    report_contact(contact, motion.location);
}

void CollisionCheck::report_contact(const BodyContact& contact, const NcLocation& place) {
  findings_.add("fixture_collision", place.line, "the " + contact.tool + " collides with the " + contact.other);
}

void CollisionCheck::holder(const SweptVolume& sweep, const RigidMotion& back) {
  for (const MachineBody& body : machine_.bodies) {
    if (body.link != KinematicLink::tool) continue;
    for (const Vec3& corner : body.points_mm.value)
      for (const Vec3& tip : {sweep.from_mm, sweep.to_mm}) {
        const Vec3 at = back.point(tip + corner);
        const double height_mm = face_.height_mm(at);
        const double rise = face_.normal_at(at).dot(back.direction(Vec3::UnitZ()));
        // Compute the tool length at which this corner of the holder would be above the blank's face.
        if (rise > 1e-3) min_free_tool_mm_ = std::max(min_free_tool_mm_, corner.z() - height_mm / rise);
        if (height_mm < 0.0)
          findings_.add("holder_collision", sweep.location.line,
                        fmt::format("{} goes {} mm into the blank", body.name, fixed(-height_mm, 3)), height_mm, 0);
      }
  }
}

void CollisionCheck::outside(const SweptVolume& sweep, std::span<const Vec3> corners) {
  double deepest_mm = 0.0;
  for (const Vec3& corner : corners) deepest_mm = std::min(deepest_mm, face_.height_mm(corner));
  if (deepest_mm < -tolerance_mm_)
    findings_.add("gouge", sweep.location.line,
                  fmt::format("the tool cuts {} nm deep outside the elements", fixed(-deepest_mm * kNmPerMm, 1)),
                  -deepest_mm * kNmPerMm, tolerance_mm_ * kNmPerMm);
}

}  // namespace retrace::fabrication
