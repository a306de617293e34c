#include "fabrication/job/io/base_keys.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string_view>

#include "core/number_format.h"
#include "fabrication/job/base_cells.h"
#include "geometry/base_part.h"
#include "geometry/formula.h"

namespace retrace::fabrication {
namespace {

using geometry::Standing;

/// In the order of the alternatives of geometry::BaseShape.
constexpr std::array<std::string_view, 4> kKindWords = {"plane", "cylinder", "sphere", "formula"};
constexpr std::array<std::string_view, 4> kShapeKeys = {"incline_deg", "radius_mm", "radius_mm", "sag_mm"};
constexpr std::array<std::string_view, 2> kAxisWords = {"y", "x"};
constexpr std::array<std::string_view, 2> kStandingWords = {"normal", "parallel"};
constexpr NumberRange kIncline{.low = 0.0, .high = 60.0};
constexpr NumberRange kAzimuth{.low = -360.0, .high = 360.0};
constexpr NumberRange kRadius{.low = -1e9, .high = 1e9};

double read_radius(TomlTable& table) {
  const double radius_mm = table.required_number("radius_mm", kRadius);
  if (radius_mm == 0.0) table.fail("radius_mm", "must not be 0; > 0 bulges towards the light, < 0 is hollow, got 0");
  return radius_mm;
}

geometry::FormulaBase read_formula(TomlTable& table) {
  const std::string text = table.required_text("sag_mm");
  try {
    return {std::make_shared<const geometry::Formula>(text)};
  } catch (const InputError& error) {
    table.fail("sag_mm", error.what());
  }
}

geometry::BaseShape read_shape(TomlTable& table, std::size_t kind) {
  switch (kind) {
    case 0: {
      const double incline_deg = table.required_number("incline_deg", kIncline);
      return geometry::PlaneBase{incline_deg, table.number("azimuth_deg", kAzimuth).value_or(0.0)};
    }
    case 1: {
      const double radius_mm = read_radius(table);
      return geometry::CylinderBase{radius_mm, table.choice("axis", kAxisWords).value_or(0) == 1};
    }
    case 2:
      return geometry::SphereBase{read_radius(table)};
    default:
      return read_formula(table);
  }
}

std::string number_line(std::string_view key, double value) {
  return fmt::format("{} = {}\n", key, shortest(value));
}

struct ShapeText {
  std::string operator()(const geometry::PlaneBase& plane) const {
    return number_line("incline_deg", plane.incline_deg) + number_line("azimuth_deg", plane.azimuth_deg);
  }
  std::string operator()(const geometry::CylinderBase& cylinder) const {
    return number_line("radius_mm", cylinder.radius_mm) +
           fmt::format("axis = {}\n", toml_text(kAxisWords[cylinder.axis_is_x ? 1 : 0]));
  }
  std::string operator()(const geometry::SphereBase& sphere) const {
    return number_line("radius_mm", sphere.radius_mm);
  }
  std::string operator()(const geometry::FormulaBase& formula) const {
    return fmt::format("sag_mm = {}\n", toml_text(formula.sag_mm->text()));
  }
};

}  // namespace

geometry::Base read_base(TomlTable table, InputLocation& at) {
  const std::size_t kind = table.required_choice("kind", kKindWords);
  geometry::Base base;
  base.shape = read_shape(table, kind);
  base.standing = table.choice("elements", kStandingWords).value_or(0) == 0 ? Standing::normal : Standing::parallel;
  at = table.where(kShapeKeys[kind]);
  return base;
}

std::string base_text(const geometry::Base& base) {
  return fmt::format("kind = {}\n", toml_text(kKindWords[base.shape.index()])) + std::visit(ShapeText{}, base.shape) +
         fmt::format("elements = {}\n", toml_text(kStandingWords[base.standing == Standing::normal ? 0 : 1]));
}

void check_array_on_base(const Job& job, const InputLocation& at) {
  const Array& array = job.array;
  if (job.workpiece.kind == WorkpieceKind::direct)
    throw InputError(at,
                     "needs a mould: workpiece.kind must be \"mould\" where elements stand on a base, got \"direct\"");
  if (array.arrangement == geometry::Arrangement::single)
    throw InputError(at, "not allowed for arrangement = \"single\"");
  if (array.x_offset_mm != 0.0 || array.y_offset_mm != 0.0)
    throw InputError(at, "not allowed together with array.x_offset_mm and y_offset_mm");
  if (!array.pattern.empty()) throw InputError(at, "not allowed together with array.pattern");
}

void check_base_of(const Job& job, const InputLocation& at) {
  try {
    geometry::check_base(part_on_base(job));
    const std::vector<CutElement> elements = cut_elements(job);
    if (elements.empty()) throw InputError("must carry one whole element within the part, it carries none");
    stock_mm(job, elements, job.process.clearance_mm);
  } catch (const InputError& error) {
    throw InputError(at, error.what());
  }
}

}  // namespace retrace::fabrication
