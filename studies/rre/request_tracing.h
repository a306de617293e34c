#pragma once

// Traces all directions of a request, including automatically chosen incidences. Internal to studies/rre.

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/rre/tracing.h"

namespace retrace::studies {

struct TracedRequest {
  std::vector<Direction> directions;  ///< in the order of the result
  std::size_t traced_directions = 0;  ///< number of directions that were traced; symmetric directions share one
  bool complete = true;
  /// Texts about designs whose automatically chosen incidences do not reach the requested accuracy.
  std::vector<std::string> warnings;
};

/// Traces a request.
/// \param only index of one of the designs; none: all designs
/// \pre all designs are traced if incidences are chosen automatically
/// \throw BudgetError in the same cases as DirectionTracing::trace()
TracedRequest trace_request(const std::vector<design::Design>& designs, const std::vector<design::OpticalModel>& models,
                            const RreSettings& request, std::optional<std::size_t> only, Progress* progress,
                            const Cancellation* cancel);

}  // namespace retrace::studies
