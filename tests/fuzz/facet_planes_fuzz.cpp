// For any table of planes, the reader either returns planes close to the planes of the design or throws an InputError
// of one line. Planes that the reader returns can be written and read back.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "geometry/io/facet_planes_reader.h"
#include "tests/fuzz/one_line.h"

namespace {

retrace::geometry::PartSpec checker() {
  retrace::geometry::PartSpec spec;
  spec.element = retrace::geometry::RtpElement{0.5, 0.5, 90.0};
  spec.array.arrangement = retrace::geometry::Arrangement::checker;
  spec.array.x_length_mm = spec.array.y_length_mm = 1.0;
  spec.thickness_mm = 1.0;
  return spec;
}

void check(const retrace::geometry::FacetPlanes& planes) {
  for (const auto& element : planes.elements())
    for (const auto& plane : element.planes)
      if (!(std::abs(plane.height_mm + 0.25) <= 0.026) || !(plane.slope.norm() < 1.3)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace::geometry;
  try {
    const auto planes = parse_facet_planes({reinterpret_cast<const char*>(data), size}, "fuzz.csv", checker());
    if (planes.size() == 0) std::abort();
    check(planes);
    const std::string text = facet_planes_text(planes);
    if (facet_planes_text(parse_facet_planes(text, "again.csv", checker())) != text) std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
