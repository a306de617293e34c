#pragma once

// Design at one point of a study, with the settings of its analysis and with intermediate results that several
// quantities share.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "design/design.h"
#include "design/part_of_design.h"
#include "geometry/part/part.h"
#include "studies/quantity/machining.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Settings of the analysis for quantities that do not have their own.
struct AnalysisSettings {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double rotation_deg = 0.0;  ///< rotation of the part about its normal, counter-clockwise as seen from the source
  raytrace::Engine engine = raytrace::Engine::automatic;
  std::optional<double> target_error;  ///< see RreSettings::target_error
  std::optional<std::uint64_t> rays;
  std::optional<double> cutoff;
  std::uint32_t seed = 1;
};

/// Design at one point of a study, with everything that quantities need. Only one thread at a time may use it.
class Candidate {
 public:
  Candidate(design::Design design, const AnalysisSettings& analysis, const MachiningProcess& machining)
      : design_(std::move(design)), analysis_(analysis), machining_(machining) {}

  const design::Design& design() const { return design_; }
  const AnalysisSettings& analysis() const { return analysis_; }
  const MachiningProcess& machining() const { return machining_; }
  /// Sets the object to which long computations report their progress.
  /// \param progress null if no reports are needed
  void report_to(Progress* progress) { progress_ = progress; }
  /// Returns the object to which the quantity being measured reports its progress. May be null.
  Progress* progress() const { return progress_; }
  /// Returns the part, which is built at the first call.
  /// \throw InputError in the same cases as part_of_design()
  const geometry::Part& part() const {
    if (!part_) part_ = design::part_of_design(design_, nullptr);
    return *part_;
  }
  /// Returns an intermediate result that several quantities need. It is made at the first call.
  /// \param key identifier of the result, which includes its type
  /// \param make function that returns a shared pointer to the result
  template <class Value, class Make>
  std::shared_ptr<const Value> shared(const std::string& key, Make make) const {
    std::shared_ptr<const void>& kept = shared_[key];
    if (!kept) kept = std::shared_ptr<const Value>(make());
    return std::static_pointer_cast<const Value>(kept);
  }

 private:
  design::Design design_;
  AnalysisSettings analysis_;
  MachiningProcess machining_;
  Progress* progress_ = nullptr;
  mutable std::optional<geometry::Part> part_;
  mutable std::map<std::string, std::shared_ptr<const void>> shared_;
};

}  // namespace retrace::studies
