#pragma once

// Simulates the programs of a job. Adds findings for their lines, and collects the swept volumes of every element.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fabrication/check/control_check.h"
#include "fabrication/check/findings.h"
#include "fabrication/check/program_time.h"
#include "fabrication/chisel/check/collision_check.h"
#include "fabrication/chisel/check/cut_assignment.h"
#include "fabrication/chisel/check/cut_check.h"
#include "fabrication/chisel/check/stop_check.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Receives the moves of programs, one after the other. Checks each move and stores the swept volumes of every element.
class ProgramCheck : public NcSink {
 public:
  /// \param visits element to which each run of cutting moves belongs, as found by CutAssignment in the same programs;
  ///        empty for a job without a substrate
  ProgramCheck(const VerificationModel& workpiece, FindingList& findings,
               std::vector<std::optional<std::size_t>> visits = {});

  /// Starts a program. All following moves belong to this program.
  void begin(const NcProgram& program);
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcLocation& place, const AxisPositions& position) override;
  void state(const NcSettings& settings, const NcLocation& place) override {
    control_.state(settings, place, is_in_blank_);
  }
  void stop(NcStop kind, const NcSettings& settings, const NcLocation& place) override;
  void end(const NcEnd& end);
  /// Ends the checks after the last program.
  void finish();

  /// Returns the swept volumes of each element.
  const std::vector<std::vector<SweptVolume>>& sweeps() const { return sweeps_; }
  const std::vector<RotaryPose>& rounded_poses() const { return rounded_poses_; }
  std::vector<RigidMotion> poses() const;
  const ProgramTime& time() const { return time_; }
  double required_free_tool_mm() const { return collisions_.required_free_tool_mm(); }
  /// Returns the maximum depth by which the tool cuts into the walls at the ends of the elements.
  double deepest_wall_mm() const { return deepest_wall_mm_; }
  const ToolWedge& wedge() const { return wedge_; }

 private:
  std::size_t pose_index(const RotaryPose& pose);
  void check_cut(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  /// Finds the corners of the part of the tool that is inside the blank during a move, in the workpiece frame.
  void find_corners(const SweptVolume& sweep, std::optional<std::size_t> element);
  std::optional<std::size_t> element_of(const SweptVolume& sweep) const;

  const VerificationModel& workpiece_;
  const Machine& machine_;
  FindingList& findings_;
  CavityMap map_;
  /// Element of each run of cutting moves (see CutRunCounter); only for jobs with a substrate.
  std::vector<std::optional<std::size_t>> element_of_run_;
  CutRunCounter runs_;
  ToolWedge wedge_;
  ControlCheck control_;
  CollisionCheck collisions_;
  std::unique_ptr<CutCheck> cuts_;
  StopCheck stops_;
  std::vector<RotaryPose> rounded_poses_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> known_poses_;
  std::vector<RigidMotion> poses_;
  std::vector<RigidMotion> back_;
  std::vector<std::vector<PlacedBody>> stationary_;  ///< table, cradle and fixtures in each pose
  std::vector<std::vector<SweptVolume>> sweeps_;
  std::vector<geometry::Vec3> corners_;
  AxisPositions at_;  ///< axis positions after the last move
  ProgramTime time_;
  double deepest_wall_mm_ = 0.0;
  bool is_in_blank_ = false;  ///< true if the last move ended inside the blank
  std::uint32_t programs_begun_ = 0;
};

}  // namespace retrace::fabrication
