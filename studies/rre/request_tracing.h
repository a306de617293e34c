#pragma once

// Internal to studies/rre: all directions of a request, those that it leaves to be chosen as well.

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/rre/tracing.h"

namespace retrace::studies {

struct TracedRequest {
  std::vector<Direction> directions;  ///< in the order of the result
  bool complete = true;
  std::string warning;  ///< if chosen directions do not do what was asked
};

/// \param only one of the designs; none: all \pre all, where incidences are to be chosen
/// \throw BudgetError as DirectionTracing::trace()
TracedRequest trace_request(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                            const RreRequest& request, std::optional<std::size_t> only, Progress* progress,
                            const Cancellation* cancel);

}  // namespace retrace::studies
