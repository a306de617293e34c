#pragma once

// Follows the programs of a job: what they do against the rules, by line, and what they sweep of every element.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fabrication/check/control_check.h"
#include "fabrication/check/findings.h"
#include "fabrication/check/program_time.h"
#include "fabrication/chisel/check/cut_check.h"
#include "fabrication/chisel/check/stop_check.h"
#include "fabrication/chisel/check/visits.h"
#include "fabrication/chisel/check/way_check.h"
#include "fabrication/chisel/check/workpiece.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Follows the moves of programs, one after the other: process findings by line, and the sweeps of every element.
class ProgramCheck : public NcSink {
 public:
  /// \param visits what VisitFinder found in the same programs, of jobs with a base
  ProgramCheck(const Workpiece3d& workpiece, FindingList& findings,
               std::vector<std::optional<std::size_t>> visits = {});

  /// What follows comes from that program.
  void begin(const NcProgram& program);
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace& place, const AxisPositions& position) override;
  void state(const NcSettings& settings, const NcPlace& place) override {
    control_.state(settings, place, is_in_blank_);
  }
  void stop(NcStop kind, const NcSettings& settings, const NcPlace& place) override;
  void end(const NcEnd& end);
  /// After the last program.
  void finish();

  const std::vector<std::vector<SweptVolume>>& sweeps() const { return sweeps_; }  ///< by element
  const std::vector<RotaryPose>& pose_words() const { return pose_words_; }
  std::vector<RigidMotion> poses() const;
  const ProgramTime& time() const { return time_; }
  double least_free_tool_mm() const { return way_.least_free_tool_mm(); }
  double deepest_wall_mm() const { return deepest_wall_mm_; }  ///< by which tool ends went into walls at most
  const ToolWedge& wedge() const { return wedge_; }

 private:
  std::size_t pose_index(const RotaryPose& pose);
  void check_cut(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  /// Corners of the tool within the blank during a move, in the workpiece frame.
  void find_corners(const SweptVolume& sweep, std::optional<std::size_t> element);
  std::optional<std::size_t> element_of(const SweptVolume& sweep) const;

  const Workpiece3d& workpiece_;
  const Machine& machine_;
  FindingList& findings_;
  GrooveMap map_;
  std::vector<std::optional<std::size_t>> visits_;  ///< of jobs with a base
  CutRuns runs_;
  ToolWedge wedge_;
  ControlCheck control_;
  WayCheck way_;
  std::unique_ptr<CutCheck> cuts_;
  StopCheck stops_;
  std::vector<RotaryPose> pose_words_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> known_poses_;
  std::vector<RigidMotion> poses_;
  std::vector<RigidMotion> back_;
  std::vector<std::vector<PlacedBody>> standing_;  ///< table, cradle and fixtures in each pose
  std::vector<std::vector<SweptVolume>> sweeps_;
  std::vector<geometry::Vec3> corners_;
  AxisPositions at_;  ///< after the last move
  ProgramTime time_;
  double deepest_wall_mm_ = 0.0;
  bool is_in_blank_ = false;  ///< where the last move ended
  std::uint32_t programs_begun_ = 0;
};

}  // namespace retrace::fabrication
