// Reads any bytes as an NC program of each dialect. The result is a list of motions or an error of one line, in bounded
// time.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/read/nc_program.h"
#include "tests/fuzz/one_line.h"

namespace {

using namespace retrace::fabrication;

struct CheckingSink : NcSink {
  void motion(const NcMotion& motion, const NcSettings&) override {
    if (!std::isfinite(motion.to.x_mm) || motion.location.line < 1 || motion.feed_mm_per_min < 0) std::abort();
    if (++motions > 100000) throw retrace::InputError("enough");
  }
  void dwell(double seconds, const NcLocation&, const AxisPositions&) override {
    if (!(seconds >= 0)) std::abort();
  }
  int motions = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const NcDialect dialect : {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                                  NcDialect::a3200, NcDialect::automation1}) {
    try {
      CheckingSink sink;
      run_nc(parse_nc(text, "fuzz", dialect), sink);
    } catch (const retrace::InputError& error) {
      retrace::fuzz::require_one_line(error);
    }
  }
  try {
    recognise_dialect(text, "fuzz");
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
