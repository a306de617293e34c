#pragma once

// Requests for files for other programs: solids of a design, and materials that reflect light in the same way as a
// part.

#include <cstdint>
#include <optional>
#include <string>

namespace retrace {

/// Selects a solid of a design: one element on its plate, the whole array, or the mould, which is the block behind the
/// back of the part.
struct SolidRequest {
  std::string what = "array";
  std::optional<double> block_mm = {};
};

/// Settings for a material that reflects light in the same way as a part (docs/theory/appearance.md). Its values are
/// means over the discs of source and receiver.
struct MaterialRequest {
  double entrance_deg = 20.0;
  double window_deg = 1.0;
  double source_arcmin = 10.0;
  double receiver_arcmin = 10.0;
  double error = 0.02;
  std::uint64_t most_directions = 1000;
};

}  // namespace retrace
