#include "geometry/elements/lattice.h"

#include <numbers>

#include "geometry/elements/edges.h"
#include "geometry/elements/ruled_pattern.h"
#include "geometry/elements/scratches.h"

namespace retrace::geometry {
namespace {

void add_element(Lattice& lattice, Cell cell) {
  lattice.cells.push_back(std::move(cell));
  ++lattice.elements_per_period;
}

/// Adds one prism and the land between it and the next prisms in x and y. In a checker arrangement, the next prisms are
/// rotated.
void add_prism_with_gaps(Lattice& lattice, const PartSpec& spec, const Vec2& corner, bool rotated) {
  const auto& element = std::get<RtpElement>(spec.element);
  const Vec2 gap(spec.array.x_gap_mm, spec.array.y_gap_mm);
  const Vec2 size(element.base_mm, element.width_mm);
  const bool next_rotated = rotated != (spec.array.arrangement == Arrangement::checker);
  const Vec2 end = corner + size;
  add_element(lattice, rtp_cell(element, spec.angle_errors, corner, rotated));
  if (gap.x() > 0.0)
    lattice.cells.push_back(
        land_cell({{end.x(), corner.y()}, {end.x() + gap.x(), end.y()}}, spec, 0, !rotated, !next_rotated));
  if (gap.y() <= 0.0) return;
  const bool rims_face_it = spec.array.arrangement == Arrangement::checker && spec.edges.rounds_rims();
  const double beside = rims_face_it ? end.x() : end.x() + gap.x();
  lattice.cells.push_back(
      land_cell({{corner.x(), end.y()}, {beside, end.y() + gap.y()}}, spec, 1, rotated, next_rotated));
  if (rims_face_it && gap.x() > 0.0) lattice.cells.push_back(land_cell({end, end + gap}, spec));
}

Lattice rtp_lattice(const PartSpec& spec, bool rows_are_shifted) {
  const auto& element = std::get<RtpElement>(spec.element);
  const Vec2 pitch(element.base_mm + spec.array.x_gap_mm, element.width_mm + spec.array.y_gap_mm);
  Lattice lattice;
  lattice.period_mm = pitch;
  if (spec.array.arrangement == Arrangement::checker) {
    lattice.period_mm = 2.0 * pitch;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        add_prism_with_gaps(lattice, spec, Vec2(i * pitch.x(), j * pitch.y()), (i + j) % 2 == 1);
    return lattice;
  }
  if (spec.array.arrangement == Arrangement::offset && rows_are_shifted) {
    lattice.period_mm.y() *= 2.0;
    const double shift = 0.01 * spec.array.overlap_percent * element.base_mm;
    for (int row = 1; row <= 2; ++row) {
      const bool shifted = (row % 2 == 1) == (spec.array.shifted_rows == RowParity::odd);
      add_prism_with_gaps(lattice, spec, Vec2(shifted ? shift : 0.0, (row - 1) * pitch.y()), false);
    }
    return lattice;
  }
  add_prism_with_gaps(lattice, spec, Vec2::Zero(), false);
  return lattice;
}

// Returns the lattice of a honeycomb with the radius R of a hexagon's circumscribed circle. Hexagons have corners in
// the directions +x and -x. The spacing along y is sqrt(3) R. Neighbouring columns are 1.5 R apart and shifted by half
// a hexagon along y.
Lattice honeycomb_lattice(const HexagonalCube& element, const AngleErrors& errors) {
  const double radius = 0.5 * element.aperture_mm;
  Lattice lattice;
  lattice.period_mm = radius * Vec2(3.0, std::numbers::sqrt3);
  add_element(lattice, hexagonal_cube_cell(element, errors, Vec2::Zero()));
  add_element(lattice, hexagonal_cube_cell(element, errors, 0.5 * lattice.period_mm));
  return lattice;
}

// Returns the lattice of triangles with the radius R of a triangle's circumscribed circle. Each triangle shares its
// sides with three rotated triangles. The centres of neighbouring triangles are R apart.
Lattice triangular_lattice(const TriangularCube& element, const AngleErrors& errors) {
  const double radius = 0.5 * element.aperture_mm;
  Lattice lattice;
  lattice.period_mm = radius * Vec2(3.0, std::numbers::sqrt3);
  const Vec2 half = 0.5 * lattice.period_mm;
  add_element(lattice, triangular_cube_cell(element, errors, Vec2::Zero()));
  add_element(lattice, triangular_cube_cell(element, errors, half));
  add_element(lattice, triangular_cube_cell(element, errors, Vec2(-radius, 0.0), true));
  add_element(lattice, triangular_cube_cell(element, errors, half - Vec2(radius, 0.0), true));
  return lattice;
}

Lattice sharp_lattice(const PartSpec& spec, bool rows_are_shifted) {
  if (const auto* hexagonal = std::get_if<HexagonalCube>(&spec.element))
    return honeycomb_lattice(*hexagonal, spec.angle_errors);
  if (const auto* triangular = std::get_if<TriangularCube>(&spec.element))
    return triangular_lattice(*triangular, spec.angle_errors);
  if (const auto* ruled = std::get_if<RuledCells>(&spec.element)) return ruled_lattice(*ruled->pattern, spec.array);
  return rtp_lattice(spec, rows_are_shifted);
}

}  // namespace

Cell finished_cell(const Cell& cell, const PartSpec& spec) {
  return with_scratches(with_edges(cell, spec), spec);
}

Lattice make_lattice(const PartSpec& spec, bool rows_are_shifted) {
  Lattice lattice = sharp_lattice(spec, rows_are_shifted);
  for (Cell& cell : lattice.cells) cell = finished_cell(cell, spec);
  return lattice;
}

}  // namespace retrace::geometry
