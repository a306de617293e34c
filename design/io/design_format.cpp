#include "design/io/design_format.h"

#include "design/io/design_rows.h"
#include "design/io/design_rules.h"
#include "design/io/groove_rows.h"
#include "geometry/io/substrate_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr Condition kTableOfNoBall = is_not(kKind, kBall);
constexpr Condition kNoMesh =
    is_absent("part.mesh", "not allowed together with part.mesh, because part.mesh describes the whole part");
constexpr Condition kNoSolid =
    is_absent("part.solid", "not allowed together with part.solid, because part.solid describes the whole part");
constexpr Condition kNoPlate = is_absent(
    "part.plate_mm", "not allowed together with part.plate_mm, because part.plate_mm describes the whole part");

constexpr Condition kWithElements[] = {kNoMesh, kNoSolid, kNoPlate};
constexpr Condition kWithPlanes[] = {kNoMesh, kNoSolid, kNoPlate, kTableOfNoBall};
constexpr Condition kPartTable[] = {kTableOfNoBall};
constexpr Condition kEntranceTable[] = {kTableOfNoBall};
constexpr Condition kSurfaceTable[] = {
    is_not(kKind, kBall, "not allowed for element.kind = \"ball\", whose surfaces are smooth")};
constexpr Condition kScratchesOnly[] = {is_absent("part.mesh", kNotWithMesh), is_absent("part.solid", kNotWithMesh),
                                        is_absent("part.plate_mm", kNotWithMesh), is(kKind, kRtp)};

const Table kSurfaceTables[] = {
    {.name = "scratches",
     .meaning = "Scratches on the facets of prisms: V-shaped grooves that run up a facet from the root to the rim. At "
                "most 200 are allowed, and none on a `[substrate]`. Scratches on the same facet must not overlap. In a "
                "`checker` array, scratches are rotated with their elements.",
     .rows = scratch_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with facet, position_um, width_um and depth_um",
     .when = kScratchesOnly}};

const Table kFormTables[] = {
    {.name = "terms",
     .meaning = "Terms of a polynomial over every facet, at most 45. Coordinates are measured from the centroid of the "
                "facet. Their unit is the radius of the facet, which is the distance from the centroid to the farthest "
                "corner. The best-fit plane is not subtracted.",
     .rows = form_term_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with x_power, y_power and height_um"}};

constexpr std::string_view kLayerIndex[] = {"material", "refractive_index"};
constexpr Rule kLayerRules[] = {OneOf{kLayerIndex, "must contain either the key material or the key refractive_index"}};
constexpr std::string_view kLayerShape =
    "a list of tables with material or refractive_index, and thickness_nm, starting with the layer on the body";
const Table kCoatingTables[] = {{.name = "facets",
                                 .meaning = "Layers on the retro facets, in order from the body outwards. At most 200 "
                                            "layers are allowed, and at most one may be opaque.",
                                 .rows = layer_rows(),
                                 .rules = kLayerRules,
                                 .presence = Presence::list,
                                 .layout = Layout::in_line,
                                 .shape = kLayerShape},
                                {.name = "entrance",
                                 .meaning = "Layers on the entrance face, in order from the body outwards. At most 200 "
                                            "layers are allowed, and none may be opaque.",
                                 .rows = layer_rows(),
                                 .rules = kLayerRules,
                                 .presence = Presence::list,
                                 .layout = Layout::in_line,
                                 .shape = kLayerShape,
                                 .when = kEntranceTable}};

constexpr Condition kWithZones[] = {kNoMesh,
                                    kNoSolid,
                                    kNoPlate,
                                    kTableOfNoBall,
                                    is_absent("substrate", "not allowed together with [substrate]"),
                                    is_absent("wet_back", "not allowed together with [wet_back]"),
                                    is_absent("form", "not allowed together with [form]"),
                                    is_absent("array.mask", "not allowed together with array.mask"),
                                    is_absent("part.facets", "not allowed together with facets in [part]")};
constexpr Condition kWithOutline[] = {kNoMesh, kNoSolid, kNoPlate, kTableOfNoBall,
                                      is_not(kExtent, kInfinite, "not allowed for array.extent = \"infinite\"")};
constexpr std::string_view kOutlineBorders[] = {"polygon_mm", "circle_mm", "dxf", "file"};
constexpr Rule kOutlineRules[] = {
    OneOf{kOutlineBorders,
          "must contain exactly one of the keys polygon_mm, circle_mm, dxf and file, which determine its border"}};
constexpr std::string_view kWhereAreZones[] = {"area_fraction", "rectangles_mm", "polygon_mm", "rows",
                                               "columns",       "mask",          "rest"};
constexpr Rule kZoneRules[] = {OneOf{kWhereAreZones,
                                     "must contain exactly one of the keys area_fraction, rectangles_mm, polygon_mm, "
                                     "rows, columns, mask and rest, which determine its region or its elements"}};
constexpr std::string_view kWhichAreWet[] = {"fraction", "rectangle_mm", "disc_mm", "half_plane"};
constexpr Rule kWetBackRules[] = {OneOf{kWhichAreWet,
                                        "must contain exactly one of the keys fraction, rectangle_mm, disc_mm and "
                                        "half_plane, which select the wet elements"}};
const Table kEntranceFaceTables[] = {
    {.name = "layers",
     .meaning = "Layers that are much thicker than the coherence length of the light, such as hard coats, in order "
                "from the body outwards. At most 20 are allowed. They are on top of the layers of `coating.entrance`, "
                "and water is on top of them.",
     .rows = thick_layer_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with refractive_index, thickness_um and absorption_per_mm"}};

constexpr Condition kRuledOnly[] = {kNoMesh, kNoPlate,
                                    is(kKind, geometry::kRuled, "only allowed for element.kind = \"ruled\"")};
/// Returns the description of the table of one groove set.
Table groove_table(std::size_t number) {
  return {.name = kGrooveSets[number],
          .meaning =
              "Set of parallel grooves. The form `custom` has two to four sets, a to d. In the other forms, which "
              "have the sets a, b and c, the table changes the set that the form determines.",
          .rows = groove_set_rows(),
          .presence = Presence::optional};
}
const Table kGrooveTables[] = {groove_table(0), groove_table(1), groove_table(2), groove_table(3)};

constexpr Row kRootRows[] = {
    {"title", Text{}, kNone, "Title of the design. It is used as the name of the design's curves in plots."}};
const Table kTables[] = {
    {.name = "element",
     .meaning = "Kind and dimensions of one element.",
     .rows = element_rows(),
     .presence = Presence::implied,
     .when = kWithElements},
    {.name = "grooves",
     .meaning = "Grooves of ruled cells. In the part frame, the surface is the upper envelope of the groove faces, and "
                "the bottoms of the deepest grooves are on z = 0.",
     .rows = groove_rows(),
     .tables = kGrooveTables,
     .presence = Presence::optional,
     .when = kRuledOnly},
    {.name = "array",
     .meaning = "Arrangement of the elements over the part.",
     .rows = array_rows(),
     .presence = Presence::implied,
     .when = kWithElements},
    {.name = "outline",
     .meaning = "Outline of a finite part that is not a rectangle. It replaces `x_length_mm`, `y_length_mm` and the "
                "offsets of `[array]`. The array fills the bounding box of the outline, and the outline cuts it. The "
                "outline of a round cube corner cuts its face; the apex is below the centre of the bounding box.",
     .rows = outline_rows(),
     .rules = kOutlineRules,
     .presence = Presence::optional,
     .when = kWithOutline},
    {.name = "substrate",
     .meaning = "Surface on which the elements of a finite array are placed, instead of the plane z = 0.",
     .rows = geometry::design_substrate_rows(),
     .presence = Presence::optional,
     .when = kWithPlanes,
     .former = "base"},
    {.name = "zone",
     .meaning = "Region of a finite part, or set of its elements, with elements that differ from those of other zones. "
                "The zones cover the whole part.",
     .rows = zone_rows(),
     .rules = kZoneRules,
     .presence = Presence::list,
     .when = kWithZones},
    {.name = "part",
     .meaning = "Mesh, solid or plate that replaces the elements, or planes of individual facets.",
     .rows = part_rows(),
     .presence = Presence::optional,
     .when = kPartTable},
    {.name = "entrance_surface",
     .meaning = "Curved surface through which light enters, instead of the plane z = thickness_mm.",
     .rows = entrance_rows(),
     .presence = Presence::optional,
     .when = kEntranceTable,
     .former = "front"},
    {.name = "shell",
     .meaning = "Separate lens in the air in front of the entrance face, such as the outer lens of a lamp. The shells "
                "are given in the order from the source to the part.",
     .rows = shell_rows(),
     .presence = Presence::list,
     .when = kEntranceTable},
    {.name = "body",
     .meaning = "Plate and material of the part, and the medium behind its retro facets.",
     .rows = body_rows(),
     .presence = Presence::implied},
    {.name = "wet_back",
     .meaning = "Another medium behind some elements of a finite array, for example where water has entered.",
     .rows = wet_back_rows(),
     .rules = kWetBackRules,
     .presence = Presence::optional,
     .when = kWithPlanes},
    {.name = "coating",
     .meaning = "Thin layers on the faces of the part.",
     .tables = kCoatingTables,
     .presence = Presence::optional},
    {.name = "entrance",
     .meaning =
         "State of an entrance face that is not clean or not smooth: layers, water, dust, scratches, haze, roughness.",
     .rows = entrance_face_rows(),
     .tables = kEntranceFaceTables,
     .presence = Presence::optional,
     .when = kEntranceTable},
    {.name = "light", .meaning = "Light that falls on the part.", .rows = light_rows(), .presence = Presence::implied},
    {.name = "detector",
     .meaning = "Cone of directions in which light counts as returned.",
     .rows = detector_rows(),
     .presence = Presence::implied},
    {.name = "surface",
     .meaning = "Angle errors, texture and edges of the retro facets.",
     .rows = surface_rows(),
     .tables = kSurfaceTables,
     .presence = Presence::implied,
     .when = kSurfaceTable},
    {.name = "form",
     .meaning = "Deviation of the retro facets of elements from planes, equal for all facets: sink of moulded parts, a "
                "polynomial, or a measured height map.",
     .rows = form_rows(),
     .tables = kFormTables,
     .presence = Presence::optional,
     .when = kWithPlanes},
    {.name = "idealisation",
     .meaning = "Idealisations, for comparisons with theory.",
     .rows = idealisation_rows(),
     .presence = Presence::implied}};

const Format kFormat = {"design",
                        "retrace.design/1",
                        "Design of a retroreflector array",
                        {.name = "",
                         .meaning = "Part, and the light that falls on it.",
                         .rows = kRootRows,
                         .tables = kTables,
                         .rules = design_rules()},
                        true};

}  // namespace

const Format& design_format() {
  return kFormat;
}

}  // namespace retrace::design
