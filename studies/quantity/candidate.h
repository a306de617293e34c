#pragma once

// A design at one point of a study, with the settings of its analysis and what several quantities compute only once.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "studies/design/design.h"
#include "studies/design/part_of_design.h"
#include "studies/quantity/machining.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// How quantities of a study are computed where they do not say otherwise.
struct AnalysisSettings {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double rotation_deg = 0.0;  ///< of the part about its normal, counter-clockwise as seen from the light
  Engine engine = Engine::automatic;
  std::optional<double> target_error;  ///< as RreRequest::target_error
  std::optional<std::uint64_t> rays;
  std::optional<double> cutoff;
  std::uint32_t seed = 1;
};

/// A design at one point of a study, with what is to be known to judge it. For one thread at a time.
class Candidate {
 public:
  Candidate(Design design, const AnalysisSettings& analysis, const MachiningProcess& machining)
      : design_(std::move(design)), analysis_(analysis), machining_(machining) {}

  const Design& design() const { return design_; }
  const AnalysisSettings& analysis() const { return analysis_; }
  const MachiningProcess& machining() const { return machining_; }
  /// Sets the object to which long computations report their progress.
  /// \param progress null if no reports are needed
  void report_to(Progress* progress) { progress_ = progress; }
  /// Returns the object to which the quantity being measured reports its progress. May be null.
  Progress* progress() const { return progress_; }
  /// Built when it is first requested. \throw InputError as part_of_design()
  const geometry::Part& part() const {
    if (!part_) part_ = part_of_design(design_, nullptr);
    return *part_;
  }
  /// What several quantities need, made when it is first requested. \param key says what it is, with its type \param
  /// make gives a shared pointer to it
  template <class Value, class Make>
  std::shared_ptr<const Value> shared(const std::string& key, Make make) const {
    std::shared_ptr<const void>& kept = shared_[key];
    if (!kept) kept = std::shared_ptr<const Value>(make());
    return std::static_pointer_cast<const Value>(kept);
  }

 private:
  Design design_;
  AnalysisSettings analysis_;
  MachiningProcess machining_;
  Progress* progress_ = nullptr;
  mutable std::optional<geometry::Part> part_;
  mutable std::map<std::string, std::shared_ptr<const void>> shared_;
};

}  // namespace retrace::studies
