#include "studies/design/base_reader.h"

#include <memory>
#include <string>
#include <variant>

#include "core/overloaded.h"
#include "geometry/base_part.h"
#include "geometry/formula.h"

namespace retrace::studies {
namespace {

using geometry::Standing;
using schema::Document;

double radius_of(const Document& document) {
  const double radius_mm = document.number("base.radius_mm");
  if (radius_mm == 0.0) document.fail("base.radius_mm", "must not be 0; > 0 bulges towards the light, < 0 is hollow");
  return radius_mm;
}

geometry::FormulaBase formula_of(const Document& document) {
  try {
    return {std::make_shared<const geometry::Formula>(document.text("base.sag_mm"))};
  } catch (const InputError& error) {
    document.fail("base.sag_mm", error.what());
  }
}

geometry::BaseShape shape_of(const Document& document) {
  const std::string kind = document.text("base.kind");
  if (kind == "plane")
    return geometry::PlaneBase{document.number("base.incline_deg"), document.number("base.azimuth_deg")};
  if (kind == "cylinder") return geometry::CylinderBase{radius_of(document), document.text("base.axis") == "x"};
  if (kind == "sphere") return geometry::SphereBase{radius_of(document)};
  return formula_of(document);
}

/// A base has a part of some size over it, and nothing of its own to say about margins.
void check_array_on_base(const Document& document, const geometry::PartSpec& part) {
  constexpr std::string_view key = "base.kind";
  if (part.extent == geometry::Extent::infinite)
    document.fail(key, "not allowed for extent = \"infinite\": give lengths");
  if (part.arrangement == geometry::Arrangement::single) document.fail(key, "not allowed for arrangement = \"single\"");
  if (part.x_offset_mm > 0.0 || part.y_offset_mm > 0.0)
    document.fail(key, "not allowed together with array.x_offset_mm and y_offset_mm");
}

}  // namespace

std::string_view base_shape_key(const geometry::Base& base) {
  return std::visit(Overloaded{[](const geometry::PlaneBase&) { return "base.incline_deg"; },
                               [](const geometry::FormulaBase&) { return "base.sag_mm"; },
                               [](const auto&) { return "base.radius_mm"; }},
                    base.shape);
}

void read_base(const Document& document, geometry::PartSpec& part) {
  if (!document.has("base")) return;
  check_array_on_base(document, part);
  const bool is_parallel = document.text("base.elements") == "parallel";
  part.base = geometry::Base{shape_of(document), is_parallel ? Standing::parallel : Standing::normal};
}

void check_base(const Document& document, const geometry::PartSpec& part) {
  if (!part.base) return;
  const std::string_view key = base_shape_key(*part.base);
  const bool has_gaps = part.x_gap_mm > 0.0 || part.y_gap_mm > 0.0;
  const bool is_plane = std::holds_alternative<geometry::PlaneBase>(part.base->shape);
  if (part.edges.rounds_rims() && part.base->standing == Standing::normal && (has_gaps || !is_plane))
    document.fail(key, "rounded or chamfered rims need elements = \"parallel\", or a plane base and no gaps");
  try {
    geometry::check_base(part);
  } catch (const InputError& error) {
    document.fail(key, error.what());
  }
}

}  // namespace retrace::studies
