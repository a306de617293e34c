#include "studies/design/io/design_format.h"

#include "geometry/io/substrate_rows.h"
#include "studies/design/io/design_rows.h"
#include "studies/design/io/design_rules.h"

namespace retrace::studies {
namespace {

using namespace schema;

constexpr Condition kTableOfNoBall = is_not(kKind, kBall);
constexpr Condition kNoMesh = without("part.mesh", "not allowed beside part.mesh, which is the whole part");
constexpr Condition kNoPlate = without("part.plate_mm", "not allowed beside part.plate_mm, which is the whole part");

constexpr Condition kWithElements[] = {kNoMesh, kNoPlate};
constexpr Condition kWithPlanes[] = {kNoMesh, kNoPlate, kTableOfNoBall};
constexpr Condition kPartTable[] = {kTableOfNoBall};
constexpr Condition kEntranceTable[] = {kTableOfNoBall};
constexpr Condition kSurfaceTable[] = {
    is_not(kKind, kBall, "not allowed for kind = \"ball\", whose surfaces are smooth")};
constexpr Condition kScratchesOnly[] = {without("part.mesh", kOfAMesh), without("part.plate_mm", kOfAMesh),
                                        is(kKind, kRtp)};

const Table kSurfaceTables[] = {
    {.name = "scratches",
     .meaning = "Grooves of V section that run up a facet of prisms from root to rim, at most 200. Those of a facet "
                "keep clear of each other; none on a `[base]`. They turn with the elements of a checker.",
     .rows = scratch_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with facet, position_um, width_um and depth_um",
     .when = kScratchesOnly}};

const Table kFormTables[] = {
    {.name = "terms",
     .meaning = "A polynomial over every facet, at most 45 terms; places are counted from its middle in units of its "
                "radius, the distance to the farthest corner. Nothing is taken off.",
     .rows = form_term_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with level, down and height_um"}};

constexpr std::string_view kLayerIndex[] = {"material", "refractive_index"};
constexpr Rule kLayerRules[] = {OneOf{kLayerIndex, "must have either material or refractive_index"}};
constexpr std::string_view kLayerShape =
    "a list of tables with material or refractive_index, and thickness_nm, the layer on the body first";
const Table kCoatingTables[] = {
    {.name = "facets",
     .meaning = "Layers on the retro facets, the one on the body first, at most 200, one of them opaque.",
     .rows = layer_rows(),
     .rules = kLayerRules,
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = kLayerShape},
    {.name = "entrance",
     .meaning = "The same on the entrance face, none of them opaque.",
     .rows = layer_rows(),
     .rules = kLayerRules,
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = kLayerShape,
     .when = kEntranceTable}};

constexpr Condition kWithZones[] = {kNoMesh,
                                    kNoPlate,
                                    kTableOfNoBall,
                                    without("base", "not allowed together with [base]"),
                                    without("wet_back", "not allowed together with [wet_back]"),
                                    without("form", "not allowed together with [form]"),
                                    without("array.mask", "not allowed together with array.mask"),
                                    without("part.facets", "not allowed together with facets in [part]")};
constexpr std::string_view kWhereAreZones[] = {"share",   "rectangles_mm", "polygon_mm", "rows",
                                               "columns", "mask",          "rest"};
constexpr Rule kZoneRules[] = {
    OneOf{kWhereAreZones,
          "must have one of share, rectangles_mm, polygon_mm, rows, columns, mask and rest, which say where it is"}};
constexpr std::string_view kWhichAreWet[] = {"share", "rectangle_mm", "disc_mm", "half_plane"};
constexpr Rule kWetBackRules[] = {
    OneOf{kWhichAreWet, "must have one of share, rectangle_mm, disc_mm and half_plane, which say where it is wet"}};
const Table kEntranceFaceTables[] = {
    {.name = "layers",
     .meaning = "Layers that are thick against the coherence of light, such as hard coats, the one nearest to the body "
                "first, at most 20. They lie on those of `coating.entrance`, under water.",
     .rows = thick_layer_rows(),
     .presence = Presence::list,
     .layout = Layout::in_line,
     .shape = "a list of tables with refractive_index, thickness_um and absorption_per_mm"}};

constexpr Row kRootRows[] = {{"title", Text{}, kNone, "Names curves in plots."}};
const Table kTables[] = {
    {.name = "element",
     .meaning = "What one element is.",
     .rows = element_rows(),
     .presence = Presence::implied,
     .when = kWithElements},
    {.name = "array",
     .meaning = "How elements are laid out over the part.",
     .rows = array_rows(),
     .presence = Presence::implied,
     .when = kWithElements},
    {.name = "base",
     .meaning = "What the elements of a finite array stand on, in place of z = 0.",
     .rows = geometry::substrate_rows(),
     .presence = Presence::optional,
     .when = kWithPlanes},
    {.name = "zone",
     .meaning = "A region of a finite part whose elements are not those of the others. Zones cover the part.",
     .rows = zone_rows(),
     .rules = kZoneRules,
     .presence = Presence::list,
     .when = kWithZones},
    {.name = "part",
     .meaning = "A mesh or a plate in place of elements, or planes of single facets.",
     .rows = part_rows(),
     .presence = Presence::optional,
     .when = kPartTable},
    {.name = "front",
     .meaning = "A curved face through which light enters, in place of the plane z = thickness_mm.",
     .rows = entrance_rows(),
     .presence = Presence::optional,
     .when = kEntranceTable},
    {.name = "body", .meaning = "What the part is made of.", .rows = body_rows(), .presence = Presence::implied},
    {.name = "wet_back",
     .meaning = "Another medium behind some elements of a finite array, such as water that has entered in places.",
     .rows = wet_back_rows(),
     .rules = kWetBackRules,
     .presence = Presence::optional,
     .when = kWithPlanes},
    {.name = "coating",
     .meaning = "Thin layers on its faces.",
     .tables = kCoatingTables,
     .presence = Presence::optional},
    {.name = "entrance",
     .meaning =
         "What the entrance face is like where it is not clean: layers, water, dust, scratches, haze, roughness.",
     .rows = entrance_face_rows(),
     .tables = kEntranceFaceTables,
     .presence = Presence::optional,
     .when = kEntranceTable},
    {.name = "light", .meaning = "The light that falls on it.", .rows = light_rows(), .presence = Presence::implied},
    {.name = "detector", .meaning = "What counts as returned.", .rows = detector_rows(), .presence = Presence::implied},
    {.name = "surface",
     .meaning = "What the retro facets and edges are like.",
     .rows = surface_rows(),
     .tables = kSurfaceTables,
     .presence = Presence::implied,
     .when = kSurfaceTable},
    {.name = "form",
     .meaning = "By what the retro facets of elements depart from planes, all alike: sink of moulded parts, a "
                "polynomial, a measured map.",
     .rows = form_rows(),
     .tables = kFormTables,
     .presence = Presence::optional,
     .when = kWithPlanes},
    {.name = "idealisation",
     .meaning = "Idealisations, to be checked against theory.",
     .rows = idealisation_rows(),
     .presence = Presence::implied}};

const Format kFormat = {"design",
                        "retrace.design/1",
                        "Design of a retroreflector array",
                        {.name = "",
                         .meaning = "A part and the light on it.",
                         .rows = kRootRows,
                         .tables = kTables,
                         .rules = design_rules()},
                        true};

}  // namespace

const Format& design_format() {
  return kFormat;
}

}  // namespace retrace::studies
