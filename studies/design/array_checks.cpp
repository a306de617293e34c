#include "studies/design/array_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

using geometry::Arrangement;
using geometry::Extent;
using geometry::PartSpec;

/// Lengths this close (relative) to a whole number of elements count as whole; also for "equal" sizes.
constexpr double kRelativeTolerance = 1e-9;

/// Bounding box of an element's aperture and the area of the cell it repeats in; mm, mm^2.
struct Footprint {
  double x_mm;
  double y_mm;
  double cell_area_mm2;
};

struct FootprintOf {
  const PartSpec& part;

  Footprint operator()(const geometry::RtpElement& rtp) const {
    return {rtp.base_mm, rtp.width_mm, (rtp.base_mm + part.x_gap_mm) * (rtp.width_mm + part.y_gap_mm)};
  }
  /// Vertices on +-x.
  Footprint operator()(const geometry::HexagonalCube& cube) const {
    const double radius = cube.aperture_mm / 2.0;
    return {2.0 * radius, std::numbers::sqrt3 * radius, 1.5 * std::numbers::sqrt3 * radius * radius};
  }
  /// The apex is at the extent's centre, so the vertex on +x at one radius asks for as much room on the other side.
  Footprint operator()(const geometry::TriangularCube& cube) const {
    const double radius = cube.aperture_mm / 2.0;
    return {2.0 * radius, std::numbers::sqrt3 * radius, 0.75 * std::numbers::sqrt3 * radius * radius};
  }
};

void check_room(const schema::Document& document, std::string_view key, double length_mm, double margin_mm,
                double element_mm) {
  const double free_mm = length_mm - 2.0 * margin_mm;
  if (free_mm >= element_mm * (1.0 - kRelativeTolerance)) return;
  const std::string margins = margin_mm > 0.0 ? fmt::format(" and two margins of {} mm", shortest(margin_mm)) : "";
  document.fail(
      key, fmt::format("must be >= {} to hold one element of {} mm{}, got {}", shortest(element_mm + 2.0 * margin_mm),
                       shortest(element_mm), margins, shortest(length_mm)));
}

void check_count(const PartSpec& part, const schema::Document& document, double cell_area_mm2) {
  const double x_free_mm = part.x_length_mm - 2.0 * part.x_offset_mm + part.x_gap_mm;
  const double y_free_mm = part.y_length_mm - 2.0 * part.y_offset_mm + part.y_gap_mm;
  const double count = x_free_mm * y_free_mm / cell_area_mm2;
  if (!(count <= kMostElements * (1.0 + kRelativeTolerance)))
    document.fail("array.x_length_mm",
                  fmt::format("the array would have {:.6g} elements, at most {:.0f} are allowed; make it "
                              "smaller or its elements larger",
                              count, kMostElements));
}

void check_square(const PartSpec& part, const schema::Document& document) {
  const auto& rtp = std::get<geometry::RtpElement>(part.element);
  if (std::abs(rtp.base_mm - rtp.width_mm) <= kRelativeTolerance * rtp.base_mm) return;
  document.fail("element.width_mm", fmt::format("must equal base_mm ({}) for arrangement = \"checker\", got {}",
                                                shortest(rtp.base_mm), shortest(rtp.width_mm)));
}

}  // namespace

void check_array(const PartSpec& part, const schema::Document& document) {
  if (part.arrangement == Arrangement::checker) check_square(part, document);
  if (part.extent == Extent::infinite || part.arrangement == Arrangement::single) return;
  const Footprint footprint = std::visit(FootprintOf{part}, part.element);
  check_room(document, "array.x_length_mm", part.x_length_mm, part.x_offset_mm, footprint.x_mm);
  check_room(document, "array.y_length_mm", part.y_length_mm, part.y_offset_mm, footprint.y_mm);
  check_count(part, document, footprint.cell_area_mm2);
}

}  // namespace retrace::studies
