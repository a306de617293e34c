// Replaces Monte Carlo photometry by a function that reports an error, because the live page has no Monte Carlo engine.
#include "live/engine/stand_ins/absent.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

bool Photometer::measure_by_rays(const std::vector<PhotometerSetting>&, Progress*, const Cancellation*,
                                 std::vector<std::vector<WavelengthReading>>&) const {
  live::fail_as_absent("no Monte Carlo");
}

}  // namespace retrace::studies
