#include "geometry/io/base_rows.h"

#include <array>

#include "core/error.h"
#include "core/overloaded.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "geometry/formula.h"

namespace retrace::geometry {
namespace {

using namespace schema;

/// In the order of the alternatives of BaseShape.
constexpr Words kKinds = {"plane", "cylinder", "sphere", "formula"};
constexpr Words kAxes = {"x", "y"};
constexpr Words kStandings = {"normal", "parallel"};
constexpr Words kPins = {"pins"};

constexpr Condition kPlaneOnly[] = {is("kind", only(kKinds, "plane"))};
constexpr Condition kCylinderOnly[] = {is("kind", only(kKinds, "cylinder"))};
constexpr Condition kRoundOnly[] = {is("kind", only(kKinds, "cylinder", "sphere"))};
constexpr Condition kFormulaOnly[] = {is("kind", only(kKinds, "formula"))};
constexpr Condition kOfPins[] = {is("array.arrangement", kPins)};
constexpr Condition kOfNoPins[] = {is_not("array.arrangement", kPins)};

Value get_kind(const Base& base) {
  return static_cast<double>(base.shape.index());
}
void set_kind(Base& base, const Value& value) {
  const std::array<BaseShape, 4> shapes = {PlaneBase(), CylinderBase(), SphereBase(), FormulaBase()};
  base.shape = shapes[static_cast<std::size_t>(std::get<double>(value))];
}

Value get_radius(const Base& base) {
  const auto* const cylinder = std::get_if<CylinderBase>(&base.shape);
  return cylinder != nullptr ? cylinder->radius_mm : std::get<SphereBase>(base.shape).radius_mm;
}
void set_radius(Base& base, const Value& value) {
  auto* const cylinder = std::get_if<CylinderBase>(&base.shape);
  double& radius_mm = cylinder != nullptr ? cylinder->radius_mm : std::get<SphereBase>(base.shape).radius_mm;
  radius_mm = std::get<double>(value);
  if (radius_mm == 0.0) throw InputError("must not be 0; > 0 bulges towards the light, < 0 is hollow, got 0");
}

Value get_axis(const Base& base) {
  return std::get<CylinderBase>(base.shape).axis_is_x ? 0.0 : 1.0;
}
void set_axis(Base& base, const Value& value) {
  std::get<CylinderBase>(base.shape).axis_is_x = std::get<double>(value) == 0.0;
}

Value get_sag(const Base& base) {
  return std::get<FormulaBase>(base.shape).sag_mm->text();
}
void set_sag(Base& base, const Value& value) {
  std::get<FormulaBase>(base.shape).sag_mm = std::make_shared<const Formula>(std::get<std::string>(value));
}

void set_parallel(Base& base, const Value&) {
  base.standing = Standing::parallel;
}

constexpr Row kRows[] = {
    {"kind", Word{kKinds}, kRequired, "The shape.", access_by<get_kind, set_kind>},
    {"incline_deg", Number{{.low = 0.0, .high = 60.0}}, kRequired, "By how much it rises.",
     access_in<&Base::shape, &PlaneBase::incline_deg>, kPlaneOnly},
    {"azimuth_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0, "Towards where it rises, from +x towards +y.",
     access_in<&Base::shape, &PlaneBase::azimuth_deg>, kPlaneOnly},
    {"radius_mm", Number{{.low = -1e9, .high = 1e9}}, kRequired,
     "Not 0; > 0 bulges towards the light, < 0 is hollow; the middle of the part is its highest or lowest place.",
     access_by<get_radius, set_radius>, kRoundOnly},
    {"axis", Word{kAxes}, "y", "Along which it does not bend.", access_by<get_axis, set_axis>, kCylinderOnly},
    {"sag_mm", Text{"a formula of x and y in mm, such as \"-(x^2 + y^2) / 200\""}, kRequired,
     "The height in mm, towards the light, as a formula of `x` and `y` in mm from the middle of the part: numbers, "
     "`pi`, `+ - * / ^`, brackets, `sqrt exp log sin cos tan asin acos atan atan2 sinh cosh tanh abs`; at most 2000 "
     "characters.",
     access_by<get_sag, set_sag>, kFormulaOnly},
    {"elements", Word{kStandings}, "normal",
     "`\"normal\"`: each element stands along the base's normal at its middle, and sizes and gaps are arc lengths; "
     "`\"parallel\"`: all stay upright and only move along z, and sizes and gaps are those in plan.",
     access<&Base::standing>, kOfNoPins},
    {"elements",
     Word{only(kStandings, "parallel")},
     "parallel",
     "Pins share one axis.",
     {nullptr, set_by<set_parallel>},
     kOfPins}};

}  // namespace

std::span<const Row> base_rows() {
  return kRows;
}

std::string_view base_shape_key(const Base& base) {
  return std::visit(
      Overloaded{[](const PlaneBase&) { return "base.incline_deg"; }, [](const FormulaBase&) { return "base.sag_mm"; },
                 [](const auto&) { return "base.radius_mm"; }},
      base.shape);
}

}  // namespace retrace::geometry
