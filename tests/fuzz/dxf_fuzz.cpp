// For any DXF file, the reader either returns closed loops or throws an InputError of one line.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "geometry/io/dxf_outline.h"
#include "geometry/outline/plan_region.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace;
  try {
    std::vector<geometry::OutlineLoop> loops =
        geometry::parse_dxf_outline(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.dxf", {});
    double corners = 0.0;
    for (const geometry::OutlineLoop& loop : loops) corners += geometry::estimated_corner_count(loop, 0.01);
    if (corners > 200.0) return 0;
    std::optional<geometry::OutlineFault> fault;
    geometry::plan_region(geometry::oriented(std::move(loops)), 0.1, 0.01, fault);
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
