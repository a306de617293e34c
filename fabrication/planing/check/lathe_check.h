#pragma once

// Judges the lathe programs of a flat lens: spindle, feeds and rapid moves, what every pass takes, and the profile that
// the nose leaves.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/check/control_check.h"
#include "fabrication/check/known_axes.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/check/standing_section.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Follows the programs of a lathe and cuts the blank. Words are those of the nose's lowest point.
class LatheCheck : public NcSink {
 public:
  LatheCheck(const PlanedPart& part, FindingList& findings, PlaningCheck& result);

  /// A program begins.
  void begin(const NcProgram& program);
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace& place, const AxisPositions&) override;
  void state(const NcSettings& settings, const NcPlace& place) override {
    control_->state(settings, place, !run_.empty());
  }
  void stop(NcStop, const NcSettings&, const NcPlace& place) override;
  void end(const NcEnd& end);
  /// What all passes left.
  void measure();

 private:
  /// Where a move stands.
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
  StandingSection standing_;
  std::vector<double> before_run_;               ///< heights
  std::vector<std::vector<SectionPoint>> runs_;  ///< feed moves without a rapid one between
  std::vector<SectionPoint> run_;
};

}  // namespace retrace::fabrication
