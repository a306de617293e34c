#include "geometry/io/substrate_rows.h"

#include <array>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "geometry/io/step_rows.h"

namespace retrace::geometry {
namespace {

using namespace schema;

/// Words of the key `kind`, in the order of the alternatives of SubstrateShape.
constexpr Words kKinds = {"plane", "cylinder", "sphere", "formula"};
/// Kinds of substrates in designs. A job has no entrance surface and names no STEP files. It therefore allows only
/// `kKinds`.
constexpr Words kKindsOfDesign = {"plane", "cylinder", "sphere", "formula", "offset", "step"};
constexpr Words kAxes = {"x", "y"};
constexpr Words kElementAxesWords = {"normal", "parallel"};
constexpr Words kPins = {"pins"};

constexpr Condition kPlaneOnly[] = {is("kind", only(kKinds, "plane"))};
constexpr Condition kCylinderOnly[] = {is("kind", only(kKinds, "cylinder"))};
constexpr Condition kRoundOnly[] = {is("kind", only(kKinds, "cylinder", "sphere"))};
constexpr Condition kFormulaOnly[] = {is("kind", only(kKinds, "formula"))};
constexpr Condition kOffsetOnly[] = {is("kind", only(kKindsOfDesign, "offset"))};
constexpr Condition kStepOnly[] = {is("kind", only(kKindsOfDesign, "step"))};
constexpr Condition kOfPins[] = {is("array.arrangement", kPins)};
constexpr Condition kOfNoPins[] = {is_not("array.arrangement", kPins)};
constexpr Condition kOfNoPinsOnSurface[] = {
    is_not("array.arrangement", kPins),
    is_not("substrate.kind", only(kKindsOfDesign, "offset"),
           "not allowed for substrate.kind = \"offset\", whose elements are parallel to z")};

Value get_kind(const Substrate& substrate) {
  return static_cast<double>(substrate.shape.index());
}
void set_kind(Substrate& substrate, const Value& value) {
  const std::array<SubstrateShape, 6> shapes = {PlaneSubstrate(),   CylinderSubstrate(), SphereSubstrate(),
                                                FormulaSubstrate(), OffsetSubstrate(),   StepFace()};
  substrate.shape = shapes[static_cast<std::size_t>(std::get<double>(value))];
  if (std::holds_alternative<OffsetSubstrate>(substrate.shape)) substrate.element_axes = ElementAxes::parallel;
}

Value get_radius(const Substrate& substrate) {
  const auto* const cylinder = std::get_if<CylinderSubstrate>(&substrate.shape);
  return cylinder != nullptr ? cylinder->radius_mm : std::get<SphereSubstrate>(substrate.shape).radius_mm;
}
void set_radius(Substrate& substrate, const Value& value) {
  auto* const cylinder = std::get_if<CylinderSubstrate>(&substrate.shape);
  double& radius_mm = cylinder != nullptr ? cylinder->radius_mm : std::get<SphereSubstrate>(substrate.shape).radius_mm;
  radius_mm = std::get<double>(value);
  if (radius_mm == 0.0)
    throw InputError(
        "must not be 0, got 0; a positive radius is convex towards the light, a negative radius is concave");
}

Value get_axis(const Substrate& substrate) {
  return std::get<CylinderSubstrate>(substrate.shape).axis_is_x ? 0.0 : 1.0;
}
void set_axis(Substrate& substrate, const Value& value) {
  std::get<CylinderSubstrate>(substrate.shape).axis_is_x = std::get<double>(value) == 0.0;
}

Value get_sag(const Substrate& substrate) {
  return std::get<FormulaSubstrate>(substrate.shape).sag_mm->text;
}
void set_sag(Substrate& substrate, const Value& value) {
  substrate.shape = formula_substrate(std::get<std::string>(value));
}

StepFace& step_face_of(Substrate& substrate) {
  return std::get<StepFace>(substrate.shape);
}
const StepFace& step_face_of(const Substrate& substrate) {
  return std::get<StepFace>(substrate.shape);
}
/// Access to a member of the selection in a STEP file.
template <auto member>
constexpr Access kAccessInChoice = {
    [](const void* object) { return get_member<member>(&step_face_of(*static_cast<const Substrate*>(object)).choice); },
    [](void* object, const Value& value) {
      set_member<member>(&step_face_of(*static_cast<Substrate*>(object)).choice, value);
    }};

void set_parallel(Substrate& substrate, const Value&) {
  substrate.element_axes = ElementAxes::parallel;
}

constexpr Row kRows[] = {
    {"kind", Word{kKinds}, kRequired, "Shape of the substrate.", access_by<get_kind, set_kind>},
    {"incline_deg", Number{{.low = 0.0, .high = 60.0}}, kRequired,
     "Inclination of the plane: angle between the substrate and the plane z = 0.",
     access_in<&Substrate::shape, &PlaneSubstrate::incline_deg>, kPlaneOnly},
    {"azimuth_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0,
     "Azimuth of the direction in which the plane rises, measured from +x towards +y.",
     access_in<&Substrate::shape, &PlaneSubstrate::azimuth_deg>, kPlaneOnly},
    {"radius_mm", Number{{.low = -1e9, .high = 1e9}}, kRequired,
     "Radius of curvature, not 0. If it is positive, the substrate is convex towards the light; if it is negative, the "
     "substrate is concave. The centre of the part is the highest or the lowest point of the substrate.",
     access_by<get_radius, set_radius>, kRoundOnly},
    {"axis", Word{kAxes}, "y", "Direction of the axis of the cylinder.", access_by<get_axis, set_axis>, kCylinderOnly},
    {"sag_mm", Text{"a formula of x and y in mm, such as \"-(x^2 + y^2) / 200\""}, kRequired,
     "Height of the substrate in mm, positive towards the light, as a formula of `x` and `y`. These are in mm, "
     "measured from the centre of the part. The formula can contain numbers, `pi`, `+ - * / ^`, brackets, `sqrt exp "
     "log sin cos tan asin acos atan atan2 sinh cosh tanh abs`, and has at most 2000 characters.",
     access_by<get_sag, set_sag>, kFormulaOnly},
    renamed("elements",
            Row{"element_axes", Word{kElementAxesWords}, "normal",
                "Orientation of the elements. `\"normal\"`: the axis of each element is the normal of the substrate at "
                "the centre of the element, and sizes and gaps are arc lengths. `\"parallel\"`: the axes stay parallel "
                "to z, elements are only shifted along z, and sizes and gaps are measured in plan.",
                access<&Substrate::element_axes>, kOfNoPins}),
    renamed("elements", Row{"element_axes",
                            Word{only(kElementAxesWords, "parallel")},
                            "parallel",
                            "Orientation of the elements. The axes of all pins are parallel.",
                            {nullptr, set_by<set_parallel>},
                            kOfPins})};

/// Index of the row of `element_axes` for elements other than pins. In designs, this row has the condition
/// kOfNoPinsOnSurface.
constexpr std::size_t kAxesRow = std::size(kRows) - 2;
constexpr Row kKindRowOfDesign = {"kind", Word{kKindsOfDesign}, kRequired,
                                  "Shape of the substrate. `\"offset\"`: below the entrance surface, which must have a "
                                  "`kind`. `\"step\"`: a face of a "
                                  "STEP file.",
                                  access_by<get_kind, set_kind>};
constexpr Row kWallRow = {
    "wall_mm",
    Number{{.low = 0.0, .low_included = false, .high = 1e6}},
    kRequired,
    "Minimum thickness of the wall between the nominal rim of an element and the `[entrance_surface]`, measured along "
    "z over the outline of the element. Each element is placed at the height at which its wall has this thickness. The "
    "axes of the elements are parallel to z. `body.thickness_mm` is then not needed.",
    access_in<&Substrate::shape, &OffsetSubstrate::wall_mm>,
    kOffsetOnly};

/// Returns row `k` of the table in designs. Most rows are those of the table in jobs. The row of `kind` allows one more
/// value, and the row of `element_axes` has another condition.
constexpr Row row_of_design(std::size_t k) {
  if (k == 0) return kKindRowOfDesign;
  return k == kAxesRow ? where(kRows[k], kOfNoPinsOnSurface) : kRows[k];
}
constexpr auto kRowsOfDesign = []<std::size_t... k>(std::index_sequence<k...>) {
  return std::array{row_of_design(k)...,
                    kWallRow,
                    with(kStepFileRow, access_in<&Substrate::shape, &StepFace::name>, kStepOnly),
                    with(kStepFaceRow, kAccessInChoice<&StepChoice::face>, kStepOnly),
                    with(kStepSewRow, kAccessInChoice<&StepChoice::sew_mm>, kStepOnly),
                    with(kStepOriginRow, kAccessInChoice<&StepChoice::origin_mm>, kStepOnly),
                    with(kStepRotationRow, kAccessInChoice<&StepChoice::rotation_deg>, kStepOnly)};
}
(std::make_index_sequence<std::size(kRows)>{});

}  // namespace

std::span<const Row> design_substrate_rows() {
  return kRowsOfDesign;
}

std::span<const Row> substrate_rows() {
  return kRows;
}

std::string_view substrate_shape_key(const Substrate& substrate) {
  return std::visit(
      Overloaded{[](const PlaneSubstrate&) { return "substrate.incline_deg"; },
                 [](const FormulaSubstrate&) { return "substrate.sag_mm"; },
                 [](const OffsetSubstrate&) { return "substrate.wall_mm"; },
                 [](const StepFace&) { return "substrate.file"; }, [](const auto&) { return "substrate.radius_mm"; }},
      substrate.shape);
}

}  // namespace retrace::geometry
