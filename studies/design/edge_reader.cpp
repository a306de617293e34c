#include "studies/design/edge_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <variant>

#include "core/number_format.h"
#include "geometry/lattice.h"

namespace retrace::studies {
namespace {

using geometry::Arrangement;
using geometry::PartSpec;

/// How wide an edge may be: what it takes of a facet must leave some of it.
double widest_edge_um(const PartSpec& part) {
  const geometry::Cell cell = geometry::element_cell(part.element, part.angle_errors);
  const geometry::Rectangle box = geometry::bounding_box(cell.outline);
  const auto* rtp = std::get_if<geometry::RtpElement>(&part.element);
  return 1e3 * (rtp != nullptr ? 0.25 * rtp->base_mm : 0.1 * box.size().minCoeff());
}

/// Rims that land keeps apart are rounded against it, so that it must be wide enough.
void check_land(const TableReader& surface, const PartSpec& part) {
  if (!part.edges.rounds_rims() || !std::holds_alternative<geometry::RtpElement>(part.element)) return;
  const bool is_checker = part.arrangement == Arrangement::checker;
  const double reach_mm = geometry::rim_reach_over_land_mm(part);
  const double needed_mm = is_checker ? reach_mm : 2.0 * reach_mm;  // in a checker one of two neighbours is turned
  const auto check = [&](std::string_view gap, double gap_mm) {
    if (gap_mm <= 0.0 || gap_mm >= needed_mm) return;
    surface.fail(part.edges.rim_radius_mm > 0.0 ? "rim_radius_um" : "rim_chamfer_um",
                 fmt::format("rims of that shape need an array.{} of 0 or >= {} mm, got {}", gap, shortest(needed_mm),
                             shortest(gap_mm)));
  };
  check("x_gap_mm", part.x_gap_mm);
  if (is_checker) check("y_gap_mm", part.y_gap_mm);
}

int read_chords(TableReader& surface) {
  constexpr std::string_view key = "edge_chords";
  constexpr Range range{.low = 4.0, .high = 64.0};
  const double given = surface.number(key, range).value_or(geometry::EdgeShape{}.chords);
  if (std::fmod(given, 2.0) != 0.0)
    surface.fail(key, fmt::format("must be an even number {}, got {}", range.text(), shortest(given)));
  return static_cast<int>(given);
}

}  // namespace

void read_edges(TableReader& surface, PartSpec& part) {
  const Range range{.low = 0.0, .high = widest_edge_um(part)};
  const auto read_mm = [&](std::string_view key) { return 1e-3 * surface.number(key, range).value_or(0.0); };
  geometry::EdgeShape& edges = part.edges;
  edges.root_radius_mm = read_mm("root_radius_um");
  edges.root_chamfer_mm = read_mm("root_chamfer_um");
  edges.rim_radius_mm = read_mm("rim_radius_um");
  edges.rim_chamfer_mm = read_mm("rim_chamfer_um");
  edges.chords = read_chords(surface);
  if (edges.root_radius_mm > 0.0 && edges.root_chamfer_mm > 0.0)
    surface.fail("root_chamfer_um", "must be 0 where root_radius_um is given");
  if (edges.rim_radius_mm > 0.0 && edges.rim_chamfer_mm > 0.0)
    surface.fail("rim_chamfer_um", "must be 0 where rim_radius_um is given");
  check_land(surface, part);
}

}  // namespace retrace::studies
