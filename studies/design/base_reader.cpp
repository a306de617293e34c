#include "studies/design/base_reader.h"

#include <variant>

#include "core/schema/reader.h"
#include "geometry/base_part.h"
#include "geometry/io/base_rows.h"

namespace retrace::studies {
namespace {

using geometry::Standing;
using schema::Document;

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

void read_base(const Document& document, geometry::PartSpec& part) {
  if (!document.has("base")) return;
  check_array_on_base(document, part);
  schema::fill(document, {.name = "base", .meaning = {}, .rows = geometry::base_rows()}, "base", &part.base.emplace());
}

void check_base(const Document& document, const geometry::PartSpec& part) {
  if (!part.base) return;
  const std::string_view key = geometry::base_shape_key(*part.base);
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
