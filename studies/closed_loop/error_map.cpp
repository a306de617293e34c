#include "studies/closed_loop/error_map.h"

#include <algorithm>

namespace retrace::studies {

ErrorMap error_map(const VerificationRun& run) {
  constexpr std::size_t kPixels = 900;
  constexpr double kTolerances = 5.0;
  constexpr double kMargin = 1.2;
  ErrorMap map;
  map.field = fabrication::error_field(run.job, run.machine, run.programs, kPixels);
  // What is unavoidable is seen whole; faults are seen where they are, not how large.
  map.shown_nm = std::max(kTolerances * run.result.tolerance_nm, kMargin * run.result.root_residual_nm_predicted);
  return map;
}

}  // namespace retrace::studies
