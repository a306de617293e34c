#include "studies/design/base_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "core/number_format.h"
#include "geometry/base_part.h"
#include "geometry/formula.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {
namespace {

using geometry::Standing;

enum class BaseKind { plane, cylinder, sphere, formula };

constexpr std::array kBaseKinds = {
    Choice<BaseKind>{"plane", BaseKind::plane}, Choice<BaseKind>{"cylinder", BaseKind::cylinder},
    Choice<BaseKind>{"sphere", BaseKind::sphere}, Choice<BaseKind>{"formula", BaseKind::formula}};
constexpr std::array kAxes = {Choice<bool>{"x", true}, Choice<bool>{"y", false}};
constexpr std::array kStandings = {Choice<Standing>{"normal", Standing::normal},
                                   Choice<Standing>{"parallel", Standing::parallel}};
constexpr Range kIncline{.low = 0.0, .high = 60.0};
constexpr Range kInclineAzimuth{.low = -360.0, .high = 360.0};
constexpr Range kRadius{.low = -1e9, .high = 1e9};

std::string_view shape_key(BaseKind kind) {
  switch (kind) {
    case BaseKind::plane:
      return "incline_deg";
    case BaseKind::cylinder:
    case BaseKind::sphere:
      return "radius_mm";
    case BaseKind::formula:
      break;
  }
  return "sag_mm";
}

double read_radius(TableReader& base) {
  const double radius_mm = base.required_number("radius_mm", kRadius);
  if (radius_mm == 0.0) base.fail("radius_mm", "must not be 0; > 0 bulges towards the light, < 0 is hollow");
  return radius_mm;
}

geometry::FormulaBase read_formula(TableReader& base) {
  const std::optional<std::string> text = base.text("sag_mm");
  if (!text) base.fail("sag_mm", "missing, must be a formula of x and y in mm, such as \"-(x^2 + y^2) / 200\"");
  try {
    return {std::make_shared<const geometry::Formula>(*text)};
  } catch (const InputError& error) {
    base.fail("sag_mm", error.what());
  }
}

geometry::BaseShape read_shape(TableReader& base, BaseKind kind) {
  if (kind != BaseKind::plane) base.refuse({"incline_deg", "azimuth_deg"}, "only allowed for kind = \"plane\"");
  if (kind != BaseKind::cylinder) base.refuse({"axis"}, "only allowed for kind = \"cylinder\"");
  if (kind != BaseKind::cylinder && kind != BaseKind::sphere)
    base.refuse({"radius_mm"}, "only allowed for kind = \"cylinder\" and \"sphere\"");
  if (kind != BaseKind::formula) base.refuse({"sag_mm"}, "only allowed for kind = \"formula\"");
  switch (kind) {
    case BaseKind::plane:
      return geometry::PlaneBase{base.required_number("incline_deg", kIncline),
                                 base.number("azimuth_deg", kInclineAzimuth).value_or(0.0)};
    case BaseKind::cylinder:
      return geometry::CylinderBase{read_radius(base), base.choice("axis", all(kAxes)).value_or(false)};
    case BaseKind::sphere:
      return geometry::SphereBase{read_radius(base)};
    case BaseKind::formula:
      break;
  }
  return read_formula(base);
}

Standing read_standing(TableReader& base, const geometry::PartSpec& part) {
  const Standing given =
      base.choice("elements", all(kStandings)).value_or(part.is_pin_bundle ? Standing::parallel : Standing::normal);
  if (part.is_pin_bundle && given != Standing::parallel)
    base.fail("elements", "must be \"parallel\" for arrangement = \"pins\", whose pins share one axis");
  return given;
}

/// A base has a part of some size over it, and nothing of its own to say about margins.
void check_array_on_base(TableReader& base, const geometry::PartSpec& part) {
  if (part.extent == geometry::Extent::infinite)
    base.fail("kind", "not allowed for extent = \"infinite\": give lengths");
  if (part.arrangement == geometry::Arrangement::single) base.fail("kind", "not allowed for arrangement = \"single\"");
  if (part.x_offset_mm > 0.0 || part.y_offset_mm > 0.0)
    base.fail("kind", "not allowed together with array.x_offset_mm and y_offset_mm");
}

}  // namespace

InputLocation read_base(const DesignDocument& document, geometry::PartSpec& part) {
  if (document.root().get("base") == nullptr) return {};
  TableReader base(document, "base");
  const BaseKind kind = base.required_choice("kind", all(kBaseKinds));
  check_array_on_base(base, part);
  const geometry::BaseShape shape = read_shape(base, kind);
  part.base = geometry::Base{shape, read_standing(base, part)};
  base.finish();
  return base.where(shape_key(kind));
}

void check_base_of(const Design& design) {
  if (!design.part.base) return;
  if (design.mask) throw InputError(design.mask->location, "not allowed together with [base]");
  const geometry::PartSpec& part = design.part;
  const bool has_gaps = part.x_gap_mm > 0.0 || part.y_gap_mm > 0.0;
  const bool is_plane = std::holds_alternative<geometry::PlaneBase>(part.base->shape);
  if (part.edges.rounds_rims() && part.base->standing == Standing::normal && (has_gaps || !is_plane))
    throw InputError(design.base_location,
                     "rounded or chamfered rims need elements = \"parallel\", or a plane base and no gaps");
  try {
    geometry::check_base(part);
  } catch (const InputError& error) {
    throw InputError(design.base_location, error.what());
  }
}

}  // namespace retrace::studies
