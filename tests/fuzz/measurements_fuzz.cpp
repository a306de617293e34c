// For any table of measurements, the reader either returns measurements that satisfy its postconditions or throws an
// InputError of one line. If measurements are returned, a calibration with them succeeds or throws such an error.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "studies/calibration/io/measurement_reader.h"
#include "tests/fuzz/one_line.h"
#include "tests/support/prism_jobs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace::studies;
  static const retrace::FileTexts texts = {{"a.toml", retrace::test::prism_job()}};
  try {
    MeasuredParts parts = parse_measurements({reinterpret_cast<const char*>(data), size}, "fuzz.csv", texts);
    for (const Measurement& m : parts.measurements)
      if (!std::isfinite(m.value) || !(m.uncertainty > 0.0) || m.part >= parts.plans.size()) std::abort();
    const Calibration found = calibrate(std::move(parts));
    for (const CalibratedQuantity& q : found.quantities)
      if (!std::isfinite(q.value) || !std::isfinite(q.uncertainty)) std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
