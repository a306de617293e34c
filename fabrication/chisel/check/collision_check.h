#pragma once

// Checks of the moves between cuts and of collisions: rapid moves, rotary moves, holder and fixtures.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/chisel/check/bodies.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Bits of X, Y and Z in NcMotion::moved and NcMotion::known.
inline constexpr std::uint8_t kLinearBits = 0b00111;

/// Checks moves for collisions and adds findings to a list. In all functions, `back` is the transformation from the
/// machine frame to the workpiece frame.
/// \pre workpiece and wedge outlive this object
class CollisionCheck {
 public:
  CollisionCheck(const VerificationModel& workpiece, const ToolWedge& wedge, FindingList& findings);

  /// Checks a move of rotary axes. No linear axis may move with them, and the tool must be above all rotating parts.
  void rotary_move(const NcMotion& motion);
  /// Checks a rapid move. It must keep the clearance of the process above the blank's face, and may go down only along
  /// Z. The whole box between its ends is checked, unless the rapid moves of the machine are straight.
  /// \param element element at the end of the move; empty: outside of all elements
  void rapid(const NcMotion& motion, const RigidMotion& back, std::optional<std::size_t> element);
  /// Checks the tool for collisions with table, cradle and fixtures. All bodies are convex.
  void fixtures(const NcMotion& motion, std::span<const PlacedBody> stationary);
  /// Checks the holder of the tool for collisions with the blank.
  void holder(const SweptVolume& sweep, const RigidMotion& back);
  /// Checks a cut outside of all elements.
  /// \param corners corners of the part of the tool that is inside the blank
  void outside(const SweptVolume& sweep, std::span<const geometry::Vec3> corners);

  const BlankFace& face() const { return face_; }
  double required_free_tool_mm() const { return min_free_tool_mm_; }

 private:
  void rotary_move_from_unknown(const NcMotion& motion);
  std::vector<AxisPositions> positions_of_rotary_move(const NcMotion& motion) const;
  /// Returns the maximum height of the corners of the rotated blank.
  double highest_corner_mm(const RigidMotion& there) const;
  bool is_box_move(const NcMotion& motion) const;
  std::vector<geometry::Vec3> edge_vectors_of_move(const NcMotion& motion) const;
  /// Returns the extreme positions of the tip: both ends of a straight move, or all corners of a box.
  std::vector<geometry::Vec3> tip_positions_of_move(const NcMotion& motion) const;
  double lowest_over_blank_mm(const NcMotion& motion, const RigidMotion& back) const;
  void report_contact(const BodyContact& contact, const NcLocation& place);

  const Job& job_;
  const Machine& machine_;
  double tolerance_mm_;
  const ToolWedge& wedge_;
  BlankFace face_;
  std::vector<PlacedBody> tool_bodies_;
  FindingList& findings_;
  double min_free_tool_mm_ = 0.0;
};

}  // namespace retrace::fabrication
