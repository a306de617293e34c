#pragma once

// Traces the directions of a request. Each direction is traced with the requested engine, or with the engine that is
// expected to be fastest. Internal to studies/rre.

#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Direction of one design, with its results.
struct Direction {
  RrePoint at;
  std::vector<std::vector<RrePoint>> spectral;  ///< points, indexed by wavelength and cone; empty if not traced yet
  std::vector<std::uint64_t> rays;              ///< number of traced rays, indexed by wavelength
  std::vector<char> missed_target;  ///< indexed by wavelength; char instead of bool, because threads write concurrently
  std::vector<RrePoint> points;     ///< one for each cone; empty until all wavelengths are traced
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
  /// True: the results are those of an equivalent direction, which was traced. Its rays must not be counted again.
  bool is_shared = false;
};

/// Returns true if the request allows beam tracing. A number of rays or plain sampling excludes it.
bool may_use_beams(const RreSettings& request);
/// Returns true if the request must be traced with the exact engine, however long this takes. This is the case if the
/// engine is requested by name, or if results are requested that only this engine computes.
bool must_be_exact(const RreSettings& request);
/// Returns the facts about a design and a request on which the choice of the engine depends.
/// \param model null: facts that depend on it are not set
raytrace::EngineFacts engine_facts(const design::Design& design, const design::OpticalModel* model,
                                   const RreSettings& request);

class DesignTracing;

/// Traces directions of a request, in one or several calls. The data of a design are prepared when the design is traced
/// for the first time. They are kept if further directions may follow.
class DirectionTracing {
 public:
  DirectionTracing(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                   const RreSettings& request, const Cancellation* cancel);
  ~DirectionTracing();

  /// Traces directions at all wavelengths. Directions that are not finished because of a cancellation remain empty.
  /// \pre all directions of a design are contiguous
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if too many beams are
  /// needed
  void trace(std::vector<Direction>& directions, Progress* progress);

 private:
  const std::vector<design::Design>& designs_;
  const std::vector<design::OpticalModel>& models_;
  const RreSettings& request_;
  const Cancellation* cancel_;
  std::vector<std::unique_ptr<DesignTracing>> tracings_;  ///< indexed by design
};

}  // namespace retrace::studies
