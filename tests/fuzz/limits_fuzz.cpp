// For any limits file, the reader either returns limits that satisfy its postconditions or throws an InputError of one
// line. If limits are returned, a test plan can be selected from them, or the selection throws such an error.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "studies/photometry/io/limits_reader.h"
#include "tests/fuzz/one_line.h"

namespace {

void check_programme(const retrace::studies::LimitTable& table, const retrace::studies::LimitRow& row) {
  using namespace retrace::studies;
  try {
    const std::optional<std::string> part_class =
        row.classes.empty() ? std::nullopt : std::optional(row.classes.front());
    const TestPlan programme = test_plan_of(table, row.standard, part_class, row.colour);
    for (const TestPoint& point : programme.points)
      if (!(point.minimum > 0.0) || !std::isfinite(point.minimum) || !(std::abs(point.v_deg) <= 85.0) ||
          !(std::abs(point.h_deg) <= 85.0) || !(point.observation_deg >= 0.0 && point.observation_deg <= 20.0))
        std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto table = retrace::studies::parse_limits({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (table.rows.empty()) std::abort();
    for (std::size_t k = 0; k < std::min<std::size_t>(table.rows.size(), 20); ++k)
      check_programme(table, table.rows[k]);
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
