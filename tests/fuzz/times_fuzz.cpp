// For any table of times, the reader either returns rows that can be used for calibration or throws an InputError of
// one line.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "studies/calibration/io/time_files.h"
#include "studies/calibration/time_programs.h"
#include "tests/fuzz/one_line.h"

namespace {

using namespace retrace;

/// Returns the text of one program with the file name "a".
FileTexts programs(const fabrication::Machine& machine) {
  constexpr std::string_view kDialect = "rs274ngc";
  return {{"a", fabrication::nc_text(studies::time_programs(machine, kDialect).back(), kDialect)}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fabrication::Machine machine = fabrication::load_machine("paper", {});
  static const FileTexts texts = programs(machine);
  try {
    const studies::TimeCalibration found = studies::calibrate_times(
        studies::parse_times({reinterpret_cast<const char*>(data), size}, "fuzz.csv", machine, texts), machine);
    for (const studies::CalibratedTime& time : found.quantities)
      if (!std::isfinite(time.value) || !std::isfinite(time.uncertainty) || time.value < 0.0) std::abort();
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
