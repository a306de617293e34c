// Whatever a table of measurements holds, the reader either returns measurements that keep its promises or throws an
// InputError of one line; and so does what is calibrated from them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "studies/calibration/io/measurement_reader.h"

namespace {

constexpr const char* kJob = R"(schema = "retrace.job/1"
machine = "ideal"
[element]
kind = "rtp"
base_mm = 0.5
width_mm = 0.5
[array]
arrangement = "checker"
x_length_mm = 1
y_length_mm = 1
[tool]
width_mm = 0.5
[process]
name = "test"
source = "a test"
clearance_mm = 0.2
roughing_depth_um = 50
finishing_depth_um = 5
plough_length_mm = 0.1
roughing_feed_mm_per_min = 50
finishing_feed_mm_per_min = 20
retract_feed_mm_per_min = 200
)";

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace::studies;
  static const retrace::FileTexts texts = {{"a.toml", kJob}};
  try {
    MeasuredParts parts = parse_measurements({reinterpret_cast<const char*>(data), size}, "fuzz.csv", texts);
    for (const Measurement& m : parts.measurements)
      if (!std::isfinite(m.value) || !(m.uncertainty > 0.0) || m.part >= parts.plans.size()) std::abort();
    const Calibration found = calibrate(std::move(parts));
    for (const CalibratedQuantity& q : found.quantities)
      if (!std::isfinite(q.value) || !std::isfinite(q.uncertainty)) std::abort();
  } catch (const retrace::InputError& error) {
    const std::string message = error.what();
    if (message.empty() || std::any_of(message.begin(), message.end(), is_control)) std::abort();
  }
  return 0;
}
