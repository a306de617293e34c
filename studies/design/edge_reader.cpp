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
void check_land(const schema::Document& document, const PartSpec& part) {
  if (!part.edges.rounds_rims() || !std::holds_alternative<geometry::RtpElement>(part.element)) return;
  const bool is_checker = part.arrangement == Arrangement::checker;
  const double reach_mm = geometry::rim_reach_over_land_mm(part);
  const double needed_mm = is_checker ? reach_mm : 2.0 * reach_mm;  // in a checker one of two neighbours is turned
  const auto check = [&](std::string_view gap, double gap_mm) {
    if (gap_mm <= 0.0 || gap_mm >= needed_mm) return;
    document.fail(part.edges.rim_radius_mm > 0.0 ? "surface.rim_radius_um" : "surface.rim_chamfer_um",
                  fmt::format("rims of that shape need an array.{} of 0 or >= {} mm, got {}", gap, shortest(needed_mm),
                              shortest(gap_mm)));
  };
  check("x_gap_mm", part.x_gap_mm);
  if (is_checker) check("y_gap_mm", part.y_gap_mm);
}

int read_chords(const schema::Document& document) {
  constexpr std::string_view key = "surface.edge_chords";
  const double chords = document.number(key);
  if (std::fmod(chords, 2.0) != 0.0)
    document.fail(key, fmt::format("must be an even number, got {}", shortest(chords)));
  return static_cast<int>(chords);
}

}  // namespace

void read_edges(const schema::Document& document, PartSpec& part) {
  const NumberRange range{.low = 0.0, .high = widest_edge_um(part)};
  const auto read_mm = [&](std::string_view key) {
    const double um = document.number(key);
    if (!range.contains(um)) document.fail(key, fmt::format("must be {}, got {}", range.text(), shortest(um)));
    return 1e-3 * um;
  };
  geometry::EdgeShape& edges = part.edges;
  edges.root_radius_mm = read_mm("surface.root_radius_um");
  edges.root_chamfer_mm = read_mm("surface.root_chamfer_um");
  edges.rim_radius_mm = read_mm("surface.rim_radius_um");
  edges.rim_chamfer_mm = read_mm("surface.rim_chamfer_um");
  edges.chords = read_chords(document);
  if (edges.root_radius_mm > 0.0 && edges.root_chamfer_mm > 0.0)
    document.fail("surface.root_chamfer_um", "must be 0 where root_radius_um is given");
  if (edges.rim_radius_mm > 0.0 && edges.rim_chamfer_mm > 0.0)
    document.fail("surface.rim_chamfer_um", "must be 0 where rim_radius_um is given");
  check_land(document, part);
}

}  // namespace retrace::studies
