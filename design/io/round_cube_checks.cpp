#include "design/io/round_cube_checks.h"

#include <fmt/format.h>

#include <numbers>
#include <span>
#include <variant>

#include "core/number_format.h"
#include "core/schema/access.h"
#include "design/io/optics_checks.h"
#include "design/io/outline_reader.h"
#include "design/io/part_reader.h"
#include "geometry/elements/element_cells.h"

namespace retrace::design {

using geometry::PartSpec, geometry::RoundCube, schema::Document;

void check_length_of_round_cube(const Document& document, const PartSpec& part) {
  constexpr double kRoundingMm = 1e-9;
  if (!std::holds_alternative<RoundCube>(part.element)) return;
  const double depth_mm = geometry::element_depth_mm(part.element, part.angle_errors);
  const double min_mm = depth_mm + min_thickness_mm(part);
  if (depth_mm + part.thickness_mm >= min_mm - kRoundingMm) return;
  const bool is_edge = document.has("element.edge_length_mm");
  const double factor = is_edge ? std::numbers::sqrt3 : 1.0;
  const std::string_view key = is_edge ? "element.edge_length_mm" : "element.length_mm";
  document.fail(key, fmt::format("must be >= {} so that the facets meet the rim of the face, got {}",
                                 shortest(factor * min_mm), shortest(document.number(key))));
}

void check_face_of_round_cube(const Document& document, const PartSpec& part) {
  const auto* const cube = std::get_if<RoundCube>(&part.element);
  if (cube == nullptr) return;
  const NumberRange chamfers{.low = 0.0, .high = 0.5 * cube->diameter_mm, .high_included = false};
  if (!chamfers.contains(cube->chamfer_mm))
    document.fail("element.chamfer_mm", fmt::format("must be {}, got {}", chamfers.text(), shortest(cube->chamfer_mm)));
  for (const std::string_view key : {"surface.rim_radius_um", "surface.rim_chamfer_um"})
    if (document.number(key) > 0.0)
      document.fail(key, "not allowed for element.kind = \"round_icc\", which has element.chamfer_mm");
  if (document.has("shell") && (cube->chamfer_mm > 0.0 || cube->mount_diameter_mm > 0.0))
    document.fail("shell", "not allowed together with a mount or a chamfer in [element]");
  if (document.has("part.facets")) document.fail("part.facets", "not allowed for element.kind = \"round_icc\"");
  if (!cube->outline) return;
  if (cube->chamfer_mm > 0.0)
    document.fail("element.chamfer_mm", "must be 0 together with [outline], got " + shortest(cube->chamfer_mm));
  if (document.has("outline.margin_mm") && document.number("outline.margin_mm") > 0.0)
    document.fail("outline.margin_mm", "must be 0 for element.kind = \"round_icc\"");
  if (!cube->outline->is_convex() || !geometry::contains(cube->outline->hull, cube->outline->box_mm.centre(), 0.0))
    document.fail(
        document.has("outline.holes_mm") ? "outline.holes_mm" : outline_key(document),
        "must be a convex outline without holes that contains the centre of its bounding box, because the apex "
        "is below this centre");
}

void check_hollow(const Document& document) {
  constexpr std::string_view key = "element.hollow";
  if (!document.has(key) || !document.flag(key)) return;
  for (const std::string_view of_body : std::span(kHollowKeys).subspan(1, kRefusedKeysOfHollow))
    if (document.has(of_body)) document.fail(of_body, "not allowed together with element.hollow = true");
  if (document.text("idealisation.facets") == "mirror" || document.text("body.facet_coating") != "none") return;
  for (std::size_t i = 0; i < document.count(kFacetLayers); ++i)
    if (!document.has(schema::path_of_entry(kFacetLayers, i) + ".thickness_nm")) return;
  document.fail(key,
                "requires mirrors: idealisation.facets = \"mirror\", body.facet_coating = \"aluminium\" or an opaque "
                "layer in coating.facets");
}

}  // namespace retrace::design
