#pragma once

// Checks the lathe programs of a flat lens: spindle, feeds, rapid moves, chip thickness of every pass, and the profile
// that the nose produces.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/check/control_check.h"
#include "fabrication/check/known_axes.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/check/stock_profile.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Receives the moves of a lathe's programs and cuts a model of the blank. Positions refer to the lowest point of the
/// nose.
class LatheCheck : public NcSink {
 public:
  LatheCheck(const PlanedPart& part, FindingList& findings, PlaningCheck& result);

  /// Starts the checks of a program.
  void begin(const NcProgram& program);
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcLocation& place, const AxisPositions&) override;
  void state(const NcSettings& settings, const NcLocation& place) override {
    control_->state(settings, place, !run_.empty());
  }
  void stop(NcStop, const NcSettings&, const NcLocation& place) override;
  void end(const NcEnd& end);
  /// Compares the surface after all passes with the design.
  void measure();

 private:
  /// Program and line of a move.
  struct Source {
    std::size_t program = 0;
    std::int32_t line = 0;
  };

  void follow_rapid(const NcMotion& motion);
  std::int32_t add_source(const NcMotion& motion);
  void add(const char* kind, std::int32_t who, const char* message, double value, double limit);
  void end_run();
  std::vector<SectionPoint> last_pass() const;
  void find_gouges(const std::vector<SectionPoint>& path, const SectionLine& reachable, double limit_mm);

  const PlanedPart& part_;
  double spacing_mm_;
  FindingList& findings_;
  PlaningCheck& result_;
  KnownAxes known_;
  std::optional<ControlCheck> control_;
  std::vector<std::string> programs_;
  std::vector<Source> sources_;
  StockProfile stock_;
  std::vector<double> before_run_;               ///< heights of the section before the present run of feed moves
  std::vector<std::vector<SectionPoint>> runs_;  ///< completed runs of feed moves between rapid moves
  std::vector<SectionPoint> run_;
};

}  // namespace retrace::fabrication
