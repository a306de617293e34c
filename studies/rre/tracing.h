#pragma once

// Internal to studies/rre: tracing the directions of a request, each by the engine that was requested or that is
// faster.

#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// One direction of one design, and what was found there.
struct Direction {
  RrePoint at;
  std::vector<std::vector<RrePoint>> spectral;  ///< by wavelength and cone; those not traced yet are empty
  std::vector<std::uint64_t> rays;              ///< by wavelength
  std::vector<char> missed_target;              ///< by wavelength: not bool, as threads write beside each other
  std::vector<RrePoint> points;                 ///< one a cone; empty until all wavelengths are traced
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

/// Whether beams may be followed: not where rays or plain sampling are requested ...
bool may_follow_beams(const RreRequest& request);
/// ... nor where they are bent or scattered without a specular share, backs differ, the front is curved, or the part is
/// of balls.
bool may_follow_beams(const Design& design, const OpticalModel& model, const RreRequest& request);
/// What only the exact engine can tell must not depend on how much work that is.
bool must_be_exact(const RreRequest& request);

class DesignTracing;

/// Traces directions of a request, in one go or several. What a design needs is made when it is first traced, and kept
/// if more directions may follow.
class DirectionTracing {
 public:
  DirectionTracing(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                   const RreRequest& request, const Cancellation* cancel);
  ~DirectionTracing();

  /// Traces these at all wavelengths; those that a cancellation cut off stay empty.
  /// \pre directions of one design stand together \throw BudgetError if power was lost, or too many beams are needed
  void trace(std::vector<Direction>& directions, Progress* progress);

 private:
  const std::vector<Design>& designs_;
  const std::vector<OpticalModel>& models_;
  const RreRequest& request_;
  const Cancellation* cancel_;
  std::vector<std::unique_ptr<DesignTracing>> tracings_;  ///< by design
};

}  // namespace retrace::studies
