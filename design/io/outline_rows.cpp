#include "design/io/design_rows.h"
#include "geometry/io/step_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr NumberRange kCoordinate{.low = -1e6, .high = 1e6};
constexpr NumberRange kRadius{.low = 0.0, .high = 1e6};
constexpr Condition kOfPolygon[] = {is_given("polygon_mm", "only allowed together with polygon_mm")};
constexpr Condition kOfDxf[] = {is_given("dxf", "only allowed together with dxf")};

constexpr Condition kOfStep[] = {is_given("file", "only allowed together with file")};
constexpr Row kStepOutlineRow = {
    "file", File{"a STEP file"}, kNone,
    "STEP file (AP203, AP214 or AP242). The outline is the border of the selected faces, projected along z. The loop "
    "that encloses the largest area is the border, and the others are holes."};

constexpr Row kOutlineRows[] = {
    {"polygon_mm", NumberRows{2, kCoordinate, 3, 1000, "points"}, kNone,
     "`[[x, y], ...]`: corners of the outline, in their order along the border. The outline may be convex or not. Only "
     "the shape matters: the lower left corner of its bounding box becomes the origin of the part frame."},
    {"side_sagitta_mm", NumberOrNumbers{kCoordinate}, kNone,
     "List with one number for each side, beginning with the side from the first to the second corner: the height of "
     "the circular arc over the side. A positive arc bulges outwards, a negative one inwards, and 0 is a straight "
     "side.",
     kOfPolygon},
    {"corner_radius_mm", NumberOrNumbers{kRadius}, 0.0,
     "Radius of the rounded corners of `polygon_mm`: one number for all corners, or a list with one number for each "
     "corner. The arcs are tangent to both sides.",
     kOfPolygon},
    {"circle_mm", Numbers{3, kCoordinate, "numbers: x and y of the centre, and the radius"}, kNone,
     "`[x, y, radius]`: a circle as outline."},
    {"dxf", File{"a DXF file"}, kNone,
     "ASCII DXF file with the outline as `LINE`, `ARC`, `CIRCLE` and `LWPOLYLINE` entities, which form closed loops. "
     "The loop that encloses the largest area is the border, and the others are holes."},
    {"dxf_layer", Text{}, Computed{"all layers"}, "Layer of the DXF file that contains the outline.", kOfDxf},
    {"dxf_scale", kSize, Computed{"1 if the file has no unit ($INSUNITS), otherwise the length of its unit in mm"},
     "Factor that converts the unit of the DXF file to mm.", kOfDxf},
    kStepOutlineRow,
    where(geometry::kStepFaceRow, kOfStep),
    where(geometry::kStepSewRow, kOfStep),
    where(geometry::kStepRotationRow, kOfStep),
    {"holes_mm", NumberRows{3, kCoordinate, 1, 100, "holes"}, kNone,
     "`[[x, y, radius], ...]`: round holes through the part, in the coordinates of the outline."},
    {"margin_mm", Number{kRadius}, 0.0, "Width of a flat strip without elements along the border and the holes."},
    {"tolerance_mm", Number{kAboveZero, kPlausibleSize}, 0.005,
     "Maximum distance between an arc and the sides of the polygon that replaces it. The polygon has the area of the "
     "outline."}};

}  // namespace

std::span<const Row> outline_rows() {
  return kOutlineRows;
}

}  // namespace retrace::design
