#pragma once

// The tool on its way between cuts, and what stands around it: rapid moves, turns of the axes, holder and fixtures.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/chisel/check/bodies.h"
#include "fabrication/chisel/check/workpiece.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// X, Y and Z in NcMotion::moved and known.
inline constexpr std::uint8_t kLinearBits = 0b00111;

/// Adds what it finds to a list. Workpiece and wedge must outlive it. `back` leads from the frame of the machine to the
/// workpiece's.
class WayCheck {
 public:
  WayCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, FindingList& findings);

  /// A move of rotary axes: alone, and with the tool above all that turns.
  void turn(const NcMotion& motion);
  /// A rapid move: above the blank's face by the process's clearance, and down along Z alone.
  /// All of the box of its axes counts, unless the machine's rapid moves are straight.
  /// \param element where it goes; nothing: beside all
  void rapid(const NcMotion& motion, const RigidMotion& back, std::optional<std::size_t> element);
  /// The tool against table, cradle and fixtures, all of them convex.
  void fixtures(const NcMotion& motion, std::span<const PlacedBody> standing);
  /// What holds the tool against the blank.
  void holder(const SweptVolume& sweep, const RigidMotion& back);
  /// A cut beside all elements. \param corners of the tool within the blank
  void outside(const SweptVolume& sweep, std::span<const geometry::Vec3> corners);

  const BlankFace& face() const { return face_; }
  double least_free_tool_mm() const { return least_free_tool_mm_; }

 private:
  void turn_from_anywhere(const NcMotion& motion);
  std::vector<AxisPositions> places_of_turn(const NcMotion& motion) const;
  /// Of the turned blank.
  double highest_corner_mm(const RigidMotion& there) const;
  bool is_box_move(const NcMotion& motion) const;
  std::vector<geometry::Vec3> edges_of_way(const NcMotion& motion) const;
  /// Of the tip: the ends of a straight move, or the corners of a box.
  std::vector<geometry::Vec3> places_of_way(const NcMotion& motion) const;
  double lowest_over_blank_mm(const NcMotion& motion, const RigidMotion& back) const;
  void report_contact(const BodyContact& contact, const NcPlace& place);

  const Job& job_;
  const Machine& machine_;
  double tolerance_mm_;
  const ToolWedge& wedge_;
  BlankFace face_;
  std::vector<PlacedBody> tool_bodies_;
  FindingList& findings_;
  double least_free_tool_mm_ = 0.0;
};

}  // namespace retrace::fabrication
