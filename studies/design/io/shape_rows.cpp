#include "studies/design/io/design_rows.h"

namespace retrace::studies {
namespace {

using namespace schema;

constexpr Kind kGap = Number{{.low = 0.0, .high = 1e6}};
constexpr geometry::SizeKeys kSizeKeys(kSize, kGap);
constexpr NumberRange kPlace{.low = -1e6, .high = 1e6};

constexpr Words kBallArrangements = {"single", "packed"};
constexpr auto kPacked = only(kBallArrangements, "packed");
constexpr auto kOffset = only(geometry::kArrangementWords, "offset");
constexpr auto kSingle = only(geometry::kArrangementWords, "single");
constexpr Words kExtents = {"finite", "infinite"};
constexpr Words kFinite = {"finite"};
constexpr Words kInfinite = {"infinite"};
constexpr Words kPartialElements = {"cut", "omit"};
constexpr Words kSides = {"top", "bottom"};

constexpr Condition kElementOfNoBall = is_not(kKind, kBall, "not allowed for kind = \"ball\", which has diameter_mm");
constexpr Condition kArrayOfNoBall =
    is_not(kKind, kBall, "not allowed for kind = \"ball\", whose layers are endless, with gap_mm between the balls");

constexpr Condition kPrismOnly[] = {kElementOfNoBall,
                                    is(kKind, kRtp, "only allowed for kind = \"rtp\", others have aperture_mm")};
constexpr Condition kCubeOnly[] = {
    kElementOfNoBall,
    is(kKind, geometry::kCubeKinds, "not allowed for kind = \"rtp\", which has base_mm and width_mm")};
constexpr Condition kCantOnly[] = {kElementOfNoBall, is(kKind, geometry::kCubeKinds, "only allowed for cube corners")};
constexpr Condition kBallOnly[] = {is(kKind, kBall)};

constexpr Row kElementRows[] = {
    {"kind", Word{geometry::kElementKinds}, kRequired, "What the elements are."},
    where(kSizeKeys.base_mm, kPrismOnly),
    where(kSizeKeys.width_mm, kPrismOnly),
    where(geometry::kApexAngleKey, kPrismOnly),
    where(kSizeKeys.aperture_mm, kCubeOnly),
    // Facets would become vertical at a cant of 35.26 degrees.
    {"cant_deg", Number{{.low = 0.0, .high = 30.0}}, 0.0,
     "Angle between the cube's axis, from the apex into the part, and +z.", kCantOnly, kZeroIsNone},
    {"cant_azimuth_deg", Number{kAzimuth}, 0.0, "Azimuth towards which the axis leans, from +x towards +y.", kCantOnly,
     kZeroIsNone},
    {"diameter_mm", kSize, kRequired, "Diameter of a ball.", kBallOnly},
    {"mirror_offset_mm", kGap, Computed{"0: the ball's own back is coated"},
     "From the ball to a mirror that is a bowl about the same centre; it needs a mirror, of aluminium or ideal.",
     kBallOnly},
    {"mirror_half_angle_deg", Number{{.low = 0.0, .low_included = false, .high = 90.0}},
     Computed{"90, or as far as the bowls of neighbours leave room"},
     "How far the mirror reaches from -z, seen from the ball's centre; at most to where the bowls of neighbours meet.",
     kBallOnly}};

constexpr Condition kOfPrisms[] = {is(kKind, kRtp)};
constexpr Condition kOfHexagons[] = {is(kKind, only(geometry::kElementKinds, "hexagonal_icc"))};
constexpr Condition kOfTriangles[] = {is(kKind, only(geometry::kElementKinds, "triangular_icc"))};
constexpr Condition kOfBalls[] = {is(kKind, kBall)};
constexpr Condition kOfSingle[] = {is(kArrangement, kSingle)};
constexpr Condition kOfPacked[] = {is(kArrangement, kPacked)};
constexpr Condition kOfOthers[] = {is_not(kArrangement, kBallArrangements)};
constexpr Condition kFiniteOnly[] = {
    kArrayOfNoBall,
    is_not(kArrangement, kSingle, "not allowed for arrangement = \"single\", whose extent is the element's aperture"),
    is_not(kExtent, kInfinite, "not allowed for extent = \"infinite\", which is one periodic cell")};
constexpr Condition kGapOnly[] = {kArrayOfNoBall, is(kKind, kRtp), is_not(kArrangement, kSingle)};
constexpr Condition kOffsetOnly[] = {kArrayOfNoBall, is(kArrangement, kOffset)};
constexpr Condition kNoBallArray[] = {kArrayOfNoBall};
constexpr Condition kMaskOnly[] = {
    kArrayOfNoBall, is(kKind, kRtp),
    is_not(kArrangement, kSingle, "only allowed for finite arrays that are not \"single\""),
    is_not(kExtent, kInfinite, "only allowed for finite arrays that are not \"single\"")};
constexpr Condition kThresholdOnly[] = {kArrayOfNoBall, beside("array.mask")};
constexpr Condition kBallGapOnly[] = {is(kKind, kBall), is_not(kArrangement, kSingle)};

constexpr Row kArrayRows[] = {
    {"arrangement", Word{geometry::kPrismArrangements}, "aligned",
     "Arrangement of the elements; `\"checker\"` needs base = width.", kOfPrisms},
    {"arrangement", Word{geometry::kHexagonalArrangements}, "honeycomb",
     "Arrangement of the elements; `\"pins\"` is a honeycomb of the ends of pins, see [base].", kOfHexagons},
    {"arrangement", Word{geometry::kTriangularArrangements}, "triangular", geometry::kArrangementMeaning, kOfTriangles},
    {"arrangement", Word{kBallArrangements}, "packed", "Arrangement of the balls; `\"packed\"` is an infinite layer.",
     kOfBalls},
    {"extent", Word{kFinite}, "finite", "A single element is finite.", kOfSingle},
    {"extent", Word{kInfinite}, "infinite", "A layer of balls is endless.", kOfPacked},
    {"extent", Word{kExtents}, "finite", "`\"infinite\"`: one periodic cell.", kOfOthers},
    where(kSizeKeys.x_length_mm, kFiniteOnly),
    where(kSizeKeys.y_length_mm, kFiniteOnly),
    where(kSizeKeys.x_offset_mm, kFiniteOnly, kZeroIsNone),
    where(kSizeKeys.y_offset_mm, kFiniteOnly, kZeroIsNone),
    {"partial_elements", Word{kPartialElements}, "cut", "What becomes of elements across the border.", kNoBallArray},
    where(kSizeKeys.x_gap_mm, kGapOnly, kZeroIsNone),
    where(kSizeKeys.y_gap_mm, kGapOnly, kZeroIsNone),
    where(geometry::kOverlapKey, kOffsetOnly),
    where(geometry::kShiftedRowsKey, kOffsetOnly),
    {"mask", File{"a picture"}, kNone,
     "A picture with one pixel for each element, whose dark pixels are elements; row 0 is the row of largest y. The "
     "others, and partial elements, are left out: there is flat back. Not together with `angle_error_sigma_arcmin` "
     "(but for `retrace job`) or `[part]` `facets`.",
     kMaskOnly},
    {"mask_threshold", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 0.7,
     "Pixels with grey < threshold * 255 are elements (0.7: 178 and below).", kThresholdOnly},
    {"gap_mm", kGap, 0.0, "Between neighbouring balls.", kBallGapOnly}};

constexpr std::string_view kScaleMeaning =
    "Factor from the unit of the STL file to mm: 1 for mm, 1000 for metres, 25.4 for inches, 0.001 for micrometres.";
constexpr std::string_view kBesidePlate = "not allowed beside plate_mm";
constexpr Condition kMeshOnly[] = {without("plate_mm", kBesidePlate)};
constexpr Condition kWithMesh[] = {without("plate_mm", kBesidePlate), beside("mesh")};
constexpr Condition kFacetsOnly[] = {without("plate_mm", kBesidePlate),
                                     without("mesh", "not allowed beside mesh, which has the facets that it has")};

constexpr Row kPartRows[] = {
    {"mesh", File{"an STL file"}, kNone,
     "An STL file, binary or ASCII, in the part frame, in place of elements; at most 10 million triangles.", kMeshOnly},
    {"scale", kSize, 1.0, kScaleMeaning, kWithMesh},
    {"allow_open", Flag{}, false,
     "Whether to trace a mesh with defects. Openings are closed by flat pieces, and bodies that intersect are united. "
     "A mesh that touches itself along edges is traced unchanged. A warning reports each defect; results apply to the "
     "repaired mesh.",
     kWithMesh},
    {"plate_mm", Numbers{2, kSaneSize, "lengths, along x and y"}, kNone,
     "Lengths along x and y of a plate whose flat back on z = 0 is its one retro facet, in place of elements."},
    {"facets", File{"a table of planes"}, kNone,
     "Of finite parts: a table of the planes in which their facets lie, in place of the nominal ones.", kFacetsOnly}};

constexpr Condition kTurnedOnly[] = {without("mesh", "not allowed beside mesh: a part has one front")};
constexpr Condition kSideOnly[] = {beside("mesh")};

constexpr Row kEntranceRows[] = {
    {"turned", File{"a turned part"}, kNone,
     "The file of a turned part (turning_file.md): its exact surface, material below.", kTurnedOnly},
    {"mesh", File{"an STL file"}, kNone, "An STL file, binary or ASCII, whose triangles are the front."},
    {"scale", kSize, 1.0, kScaleMeaning, kSideOnly},
    {"mesh_side", Word{kSides}, "top",
     "`\"top\"`: the front are its triangles that look towards +z; `\"bottom\"`: those that look towards -z, turned "
     "over, which is what `machined.stl` of `retrace turn` needs: it is the counterpart, moulded in the turned "
     "surface.",
     kSideOnly},
    {"centre_mm", Numbers{2, kPlace, "places, x and y"}, Computed{"the part's middle"},
     "`[x, y]`: where in the part's plane the file's origin lies."}};

constexpr NumberRange kLines{.low = 1.0, .high = 1e6};
constexpr Condition kBesideLines[] = {without("mask", "only allowed beside rows or columns"),
                                      without("rest", "only allowed beside rows or columns"),
                                      without("share", "only allowed beside rows or columns"),
                                      without("rectangles_mm", "only allowed beside rows or columns"),
                                      without("polygon_mm", "only allowed beside rows or columns")};
constexpr Condition kBesideMask[] = {beside("mask")};
constexpr Row kZoneRows[] = {
    {"share", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, kNone,
     "Of the part's area, as a stripe over its whole height; stripes stand side by side along x, in their order, and "
     "their shares add to 1, to 1e-6."},
    {"rectangles_mm", NumberRows{4, kPlace, 1, 1000, "rectangles"}, kNone,
     "`[[x_from, y_from, x_to, y_to], ...]`: rectangles of the part's plan, each with an array of its own."},
    {"polygon_mm", NumberRows{2, kPlace, 3, 100, "points"}, kNone,
     "`[[x, y], ...]`: the corners of a convex polygon of the part's plan."},
    {"rows", NumberOrNumbers{kLines, true}, kNone,
     "Elements of the array all over the part: those of these rows along x, counted from 1, that of least y."},
    {"columns", NumberOrNumbers{kLines, true}, kNone, "Likewise those of these columns along y, counted from least x."},
    {"every", Whole{kLines}, kNone, "Rows, or columns, are counted from 1 again after so many.", kBesideLines},
    {"mask", File{"a picture"}, kNone,
     "A picture that covers the part, row 0 at largest y: the elements whose centroids its dark pixels hold."},
    {"mask_threshold", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 0.7,
     "Pixels with grey < threshold * 255 are dark.", kBesideMask},
    {"rest", Flag{}, kNone, "true: all elements that are of no other zone."},
    {"rotation_deg", Number{kAzimuth}, 0.0,
     "By which its elements are turned in the plane, from +x towards +y, about the middle of the region's box; of "
     "rows, columns, masks and the rest each about its own centroid, to the same outline."},
    {"set", Texts{}, kNone,
     "`[\"KEY=VALUE\", ...]`: what is other than the design says, as with `--set`: keys of `[element]`, of `[array]` "
     "but for extent, lengths, margins and mask, and angles and edges of `[surface]`."}};

}  // namespace

std::span<const Row> element_rows() {
  return kElementRows;
}
std::span<const Row> array_rows() {
  return kArrayRows;
}
std::span<const Row> part_rows() {
  return kPartRows;
}
std::span<const Row> zone_rows() {
  return kZoneRows;
}
std::span<const Row> entrance_rows() {
  return kEntranceRows;
}

}  // namespace retrace::studies
