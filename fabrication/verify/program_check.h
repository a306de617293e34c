#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/verify/bodies.h"
#include "fabrication/verify/chiseling_check.h"
#include "fabrication/verify/findings.h"
#include "fabrication/verify/groove.h"
#include "fabrication/verify/prediction.h"
#include "fabrication/verify/swept_volume.h"
#include "fabrication/verify/visits.h"

namespace retrace::fabrication {

/// Seconds that a program takes, from the moves that were read.
struct ProgramTime {
  double feed_s = 0.0;
  double rapid_s = 0.0;
  double rotary_s = 0.0;
  double dwell_s = 0.0;
  double total_s() const { return feed_s + rapid_s + rotary_s + dwell_s; }
};

/// What must be known to judge a program.
struct Workpiece3d {
  const Job* job = nullptr;
  const Machine* machine = nullptr;
  std::vector<Groove> grooves;
  std::vector<Prediction> predictions;     ///< for elements that stand alike: Groove::group
  std::vector<geometry::Vec2> centres_mm;  ///< of the elements, as CutElement has them
  double tolerance_mm = 1e-5;

  const Prediction& prediction(std::size_t element) const { return predictions[grooves[element].group]; }
};

/// The cutting wedge of a job's tool.
ToolWedge wedge_of(const Job& job, const Machine& machine);

/// Follows the moves of programs, one after the other: process findings by line, and the sweeps of every element.
class ProgramCheck : public NcSink {
 public:
  /// \param visits what VisitFinder found in the same programs, of jobs with a base
  ProgramCheck(const Workpiece3d& workpiece, FindingList& findings,
               std::vector<std::optional<std::size_t>> visits = {});

  /// What follows comes from that program.
  void begin(const std::string& program);
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace& place, const AxisPositions& position) override;
  void end(const NcEnd& end);
  /// After the last program.
  void finish();

  const std::vector<std::vector<SweptVolume>>& sweeps() const { return sweeps_; }  ///< by element
  const std::vector<RotaryPose>& pose_words() const { return pose_words_; }
  std::vector<RigidMotion> poses() const;
  const ProgramTime& time() const { return time_; }
  double least_free_tool_mm() const { return least_free_tool_mm_; }
  double deepest_wall_mm() const { return deepest_wall_mm_; }  ///< by which tool ends went into walls at most
  const ToolWedge& wedge() const { return wedge_; }

 private:
  /// Cuts of one element so far, as heights over its two facets.
  struct CutState {
    struct Plunge {
      std::array<double, 2> tip_mm{};  ///< heights of the tip over the facets
      std::int32_t line = 0;
    };
    std::array<std::optional<Plunge>, 2> last;   ///< on each facet
    std::array<double, 2> surface_mm{1e9, 1e9};  ///< of each facet above the design
    std::vector<std::array<double, 4>> tips;     ///< ends of plunges and their facet, to find repeated ones
  };
  /// A plunge whose chip has not been looked after yet.
  struct OpenPlunge {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 2> tip_mm{};
    double chip_mm = 0.0;
    NcPlace place;
    bool has_dwell = false;
  };

  void report(std::string kind, const NcPlace& place, std::int64_t element, std::string message, double value,
              double limit);
  std::size_t pose_index(const RotaryPose& pose);
  void check_settings(const NcSettings& settings, const NcPlace& place);
  void check_limits(const NcMotion& motion);
  void check_turn(const NcMotion& motion);
  void check_axes(const NcMotion& motion);
  void check_turn_of_head(const NcMotion& motion);
  void check_chiseling(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  void check_rapid(const NcMotion& motion, const SweptVolume& sweep);
  double lowest_over_blank_mm(const SweptVolume& sweep) const;
  void check_feed(const NcMotion& motion, double allowed);
  void check_holder(const SweptVolume& sweep);
  void check_fixtures(const SweptVolume& sweep);
  void report_contact(const BodyContact& contact, const NcPlace& place);
  void check_cut(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  void check_outside(const SweptVolume& sweep);
  void check_plunge(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  void check_plough(const NcMotion& motion, const SweptVolume& sweep, std::size_t element);
  void check_chip_thickness(const OpenPlunge& plunge);
  void close_plunge();
  void check_chip();
  void count_time(const NcMotion& motion);
  /// Corners of the tool within the blank during a move, in the workpiece frame.
  void find_corners(const SweptVolume& sweep, std::optional<std::size_t> element);
  std::optional<std::size_t> element_of(const SweptVolume& sweep) const;

  const Workpiece3d& workpiece_;
  const Job& job_;
  const Machine& machine_;
  FindingList& findings_;
  GrooveMap map_;
  BlankFace face_;
  std::vector<std::optional<std::size_t>> visits_;  ///< of jobs with a base
  CutRuns runs_;
  ToolWedge wedge_;
  std::vector<PlacedBody> tool_bodies_;
  std::string program_;
  std::vector<RotaryPose> pose_words_;
  std::map<std::pair<double, double>, std::size_t> known_poses_;
  std::vector<RigidMotion> poses_;
  std::vector<RigidMotion> back_;
  std::vector<std::vector<PlacedBody>> standing_;  ///< table, cradle and fixtures in each pose
  std::vector<std::vector<SweptVolume>> sweeps_;
  std::vector<CutState> states_;
  std::optional<OpenPlunge> open_;
  std::optional<ChiselingCheck> chiseling_;  ///< of cube corners
  std::vector<geometry::Vec3> corners_;
  ProgramTime time_;
  double least_free_tool_mm_ = 0.0;
  double deepest_wall_mm_ = 0.0;
  bool settings_are_checked_ = false;
};

}  // namespace retrace::fabrication
