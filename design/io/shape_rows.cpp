#include "design/io/design_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr Kind kGap = Number{{.low = 0.0, .high = 1e6}};
constexpr geometry::SizeKeys kSizeKeys(kSize, kGap);
constexpr NumberRange kPlace{.low = -1e6, .high = 1e6};
constexpr NumberRange kCellSpread{.low = 0.0, .high = 1e6};

constexpr Words kBallArrangements = {"single", "packed"};
constexpr auto kPacked = only(kBallArrangements, "packed");
constexpr auto kRuledArrangement = only(geometry::kArrangementWords, "ruled");
constexpr auto kOffset = only(geometry::kArrangementWords, "offset");
constexpr Words kExtents = {"finite", "infinite"};
constexpr Words kFinite = {"finite"};
constexpr Words kPartialElements = {"cut", "omit"};

constexpr Condition kElementOfNoBall =
    is_not(kKind, kBall, "not allowed for element.kind = \"ball\", which has diameter_mm");
constexpr Condition kArrayOfNoBall =
    is_not(kKind, kBall,
           "not allowed for element.kind = \"ball\", because a layer of balls is infinite and its spacing is gap_mm");

constexpr Condition kNotRound =
    is_not(kKind, geometry::kRoundCube, "not allowed for element.kind = \"round_icc\", which has diameter_mm");

constexpr Condition kNotRuled =
    is_not(kKind, geometry::kRuled, "not allowed for element.kind = \"ruled\", whose cells are described by [grooves]");

constexpr Condition kPrismOnly[] = {
    kElementOfNoBall, kNotRound, kNotRuled,
    is(kKind, kRtp, "only allowed for element.kind = \"rtp\"; other kinds have aperture_mm")};
constexpr Condition kCubeOnly[] = {
    kElementOfNoBall, kNotRound, kNotRuled,
    is(kKind, geometry::kCubeKinds, "not allowed for element.kind = \"rtp\", which has base_mm and width_mm")};
constexpr Condition kCantOnly[] = {kElementOfNoBall, kNotRuled,
                                   is(kKind, geometry::kCubeKindsOfDesigns, "only allowed for cube corners")};
constexpr Condition kBallOnly[] = {is(kKind, kBall)};
constexpr Condition kRoundOnly[] = {is(kKind, geometry::kRoundCube)};
constexpr Condition kEdgeLengthOnly[] = {is(kKind, geometry::kRoundCube),
                                         is_absent("element.length_mm", "not allowed together with length_mm")};

constexpr Row kElementRows[] = {
    {"kind", Word{geometry::kElementKinds}, kRequired,
     "Kind of the elements: prisms, hexagonal or triangular cube corners, a single cube corner with a circular face "
     "(`\"round_icc\"`), cells between sets of V-grooves (`\"ruled\"`), or balls."},
    where(kSizeKeys.base_mm, kPrismOnly),
    where(kSizeKeys.width_mm, kPrismOnly),
    where(geometry::kApexAngleKey, kPrismOnly),
    where(kSizeKeys.aperture_mm, kCubeOnly),
    // Facets would become vertical at a cant of 35.26 degrees.
    {"cant_deg", Number{{.low = 0.0, .high = 30.0}}, 0.0,
     "Angle between +z and the axis of the cube corner. The axis points from the apex into the part.", kCantOnly,
     kZeroIsNone},
    {"cant_azimuth_deg", Number{kAzimuth}, 0.0,
     "Azimuth of the direction towards which the axis is tilted, measured from +x towards +y.", kCantOnly, kZeroIsNone},
    {"diameter_mm", kSize, kRequired, "Diameter of the balls.", kBallOnly},
    {"diameter_mm", kSize, kRequired,
     "Diameter of the circular face. The circle is replaced by a polygon of the same area with 180 sides.", kRoundOnly},
    {"length_mm", kSize,
     Computed{
         "the minimum length, at which the facets reach the rim of the face: `diameter_mm` / sqrt(2) + 1e-6 mm, and "
         "more if angle errors or a cant raise the facets"},
     "Length from the apex to the face.", kRoundOnly},
    {"edge_length_mm", kSize, Computed{"sqrt(3) times the length"},
     "Length of the dihedral edges of the cube corner from the apex to the plane of the face, without the cut by the "
     "circular outline. It is sqrt(3) times the length and replaces `length_mm`.",
     kEdgeLengthOnly},
    {"chamfer_mm", kGap, 0.0,
     "Width of the chamfer at the rim of the face, in plan. Light that meets the chamfer from outside or from inside "
     "is stopped.",
     kRoundOnly},
    {"recess_mm", kGap, 0.0,
     "Depth of the face below the edge of its mount. The edge stops light on its way to the face and on its way back.",
     kRoundOnly},
    {"mount_diameter_mm", kSize, Computed{"`diameter_mm` with a recess, otherwise there is no mount"},
     "Diameter of the circular edge of the mount. It is centred on the face.", kRoundOnly},
    {"hollow", Flag{}, false,
     "true: three mirrors without a body, so that the refractive index is 1 inside and outside. The mirrors need "
     "`idealisation.facets` = `\"mirror\"`, a `body.facet_coating` or an opaque layer in `coating.facets`.",
     kRoundOnly},
    {"mirror_offset_mm", kGap, Computed{"0: the back of the ball itself is coated"},
     "Distance from the ball to the mirror behind it. The mirror is a spherical bowl with the same centre as the ball. "
     "A value above 0 needs a mirror: aluminium, an opaque layer, or an ideal mirror.",
     kBallOnly},
    {"mirror_half_angle_deg", Number{{.low = 0.0, .low_included = false, .high = 90.0}},
     Computed{"90, or the angle at which the bowls of neighbouring balls meet if this angle is smaller"},
     "Angle from -z up to which the mirror extends, measured at the centre of the ball. It is at most the angle at "
     "which the bowls of neighbouring balls meet.",
     kBallOnly}};

constexpr Condition kOfPrisms[] = {is(kKind, kRtp)};
constexpr Condition kOfHexagons[] = {is(kKind, only(geometry::kElementKinds, "hexagonal_icc"))};
constexpr Condition kOfTriangles[] = {is(kKind, only(geometry::kElementKinds, "triangular_icc"))};
constexpr Condition kOfRuled[] = {is(kKind, geometry::kRuled)};
constexpr Condition kOfBalls[] = {is(kKind, kBall)};
constexpr Condition kOfRound[] = {is(kKind, geometry::kRoundCube)};
constexpr Condition kOfSingle[] = {is(kArrangement, kSingle)};
constexpr Condition kOfPacked[] = {is(kArrangement, kPacked)};
constexpr Condition kOfOthers[] = {is_not(kArrangement, kBallArrangements)};
constexpr Condition kFiniteOnly[] = {
    kArrayOfNoBall,
    is_not(kArrangement, kSingle,
           "not allowed for array.arrangement = \"single\", whose extent is the element's aperture"),
    is_not(kExtent, kInfinite, "not allowed for array.extent = \"infinite\", which is one periodic cell")};
constexpr std::string_view kNotWithOutline =
    "not allowed together with [outline], which determines the size of the part";
constexpr Condition kLengthOnly[] = {kFiniteOnly[0], kFiniteOnly[1], kFiniteOnly[2],
                                     is_absent("outline", kNotWithOutline)};
constexpr Condition kGapOnly[] = {kArrayOfNoBall, is(kKind, kRtp), is_not(kArrangement, kSingle)};
constexpr Condition kOffsetOnly[] = {kArrayOfNoBall, is(kArrangement, kOffset)};
constexpr Condition kNoBallArray[] = {kArrayOfNoBall};
constexpr std::string_view kNeedsFiniteArray =
    "only allowed for array.extent = \"finite\" and if array.arrangement is not \"single\"";
constexpr Condition kMaskOnly[] = {kArrayOfNoBall, is(kKind, kRtp), is_not(kArrangement, kSingle, kNeedsFiniteArray),
                                   is_not(kExtent, kInfinite, kNeedsFiniteArray)};
constexpr Condition kThresholdOnly[] = {kArrayOfNoBall, is_given("array.mask")};
constexpr Condition kInfiniteOnly[] = {kArrayOfNoBall,
                                       is(kExtent, kInfinite, "only allowed for array.extent = \"infinite\"")};
constexpr Condition kSpreadOnly[] = {kInfiniteOnly[0], kInfiniteOnly[1],
                                     is_given("array.depth_spread_nm", "only allowed together with depth_spread_nm")};
constexpr Condition kBallGapOnly[] = {is(kKind, kBall), is_not(kArrangement, kSingle)};

constexpr Row kArrayRows[] = {
    {"arrangement", Word{geometry::kPrismArrangements}, "aligned",
     "Arrangement of the elements. `\"checker\"`: neighbouring prisms are rotated by 90 degrees to each other; "
     "`base_mm` must equal `width_mm`.",
     kOfPrisms},
    {"arrangement", Word{geometry::kHexagonalArrangements}, "honeycomb",
     "Arrangement of the elements. `\"pins\"`: a honeycomb of cells that are the ends of parallel pins; see "
     "[substrate].",
     kOfHexagons},
    {"arrangement", Word{geometry::kTriangularArrangements}, "triangular", geometry::kArrangementMeaning, kOfTriangles},
    {"arrangement", Word{kRuledArrangement}, "ruled",
     "Arrangement of the cells. The grooves of a ruled array determine the positions of its cells.", kOfRuled},
    {"arrangement", Word{kSingle}, "single",
     "Arrangement of the element. A cube corner with a circular face is single.", kOfRound},
    {"arrangement", Word{kBallArrangements}, "packed",
     "Arrangement of the balls. `\"packed\"` is an infinite layer with hexagonal packing.", kOfBalls},
    {"extent", Word{kFinite}, "finite", "Extent of the array. A single element is finite.", kOfSingle},
    {"extent", Word{kInfinite}, "infinite", "Extent of the array. A layer of balls is infinite.", kOfPacked},
    {"extent", Word{kExtents}, "finite", "Extent of the array. `\"infinite\"` is one periodic cell.", kOfOthers},
    where(kSizeKeys.x_length_mm, kLengthOnly),
    where(kSizeKeys.y_length_mm, kLengthOnly),
    where(kSizeKeys.x_offset_mm, kLengthOnly, kZeroIsNone),
    where(kSizeKeys.y_offset_mm, kLengthOnly, kZeroIsNone),
    {"partial_elements", Word{kPartialElements}, "cut",
     "Treatment of elements that cross the border of the part. `\"cut\"`: they are cut at the border. `\"omit\"`: they "
     "are replaced by a flat back.",
     kNoBallArray},
    where(kSizeKeys.x_gap_mm, kGapOnly, kZeroIsNone),
    where(kSizeKeys.y_gap_mm, kGapOnly, kZeroIsNone),
    where(geometry::kOverlapKey, kOffsetOnly),
    where(geometry::kShiftedRowsKey, kOffsetOnly),
    {"mask", File{"a picture"}, kNone,
     "Image with one pixel for each element. The first row of pixels belongs to the elements at the largest y. Only "
     "cells with a dark pixel have an element. All other cells, and all partial elements, are replaced by flat back. "
     "Not allowed together with `angle_error_sigma_arcmin` (except for `retrace job`) or with `[part]` `facets`.",
     kMaskOnly},
    {"mask_threshold", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 0.7,
     "Threshold for dark pixels. A pixel is dark if its grey value (0 to 255) is below `mask_threshold` * 255. With "
     "0.7, values up to 178 are dark.",
     kThresholdOnly},
    {"depth_spread_nm", Number{kCellSpread}, kNone,
     "Standard deviation of the depths of cells. If it is given, the fields of different cells are added, and light "
     "leaves in diffraction orders of the array and as diffuse light. Without it, the intensities of cells are added, "
     "as for cells whose depths differ by more than a wavelength.",
     kInfiniteOnly},
    {"spacing_spread_nm", Number{kCellSpread}, 0.0,
     "Standard deviation of the positions of cells, along x and along y. Errors of different cells are independent.",
     kSpreadOnly},
    {"gap_mm", kGap, 0.0, "Gap between neighbouring balls.", kBallGapOnly}};

constexpr std::string_view kBesidePlate = "not allowed together with plate_mm";
constexpr std::string_view kBesideSolid = "not allowed together with solid, because a part has only one shape";
constexpr Condition kMeshOnly[] = {is_absent("plate_mm", kBesidePlate), is_absent("solid", kBesideSolid)};
constexpr Condition kSolidOnly[] = {is_absent("plate_mm", kBesidePlate)};
constexpr Condition kWithMesh[] = {is_absent("plate_mm", kBesidePlate), is_given("mesh")};
constexpr Condition kWithSolid[] = {is_absent("plate_mm", kBesidePlate), is_given("solid")};
constexpr Condition kFacetsOnly[] = {
    is_absent("plate_mm", kBesidePlate),
    is_absent("mesh", "not allowed together with mesh, which determines all facets"),
    is_absent("solid", "not allowed together with solid, which determines all facets")};
constexpr Words kFacings = {"up", "down"};
constexpr double kNoRotations[] = {0.0, 0.0, 0.0};

constexpr Row kRotateRow = {"rotate_deg", Numbers{3, kAzimuth, "angles, about x, y and z"},
                            std::span<const double>(kNoRotations),
                            "`[x, y, z]`: rotations of the file about its origin, first about x, then about y, then "
                            "about z of the part frame."};
constexpr Row kFacingRow = {"facing", Word{kFacings}, "up",
                            "Direction of the entrance face in the file, after `rotate_deg`. `\"down\"`: the part is "
                            "rotated by 180 degrees about x, so that its entrance face points towards +z."};

constexpr Row kPartRows[] = {
    {"mesh", File{"an STL or OBJ file"}, kNone,
     "Triangle mesh of the whole part: STL (binary or ASCII), or OBJ if the name ends in `.obj`. It replaces the "
     "elements. It has at most 10 million triangles.",
     kMeshOnly},
    {"solid", File{"a STEP file"}, kNone,
     "STEP file (AP203, AP214 or AP242) with the whole part as a solid. It replaces the elements. Its units are those "
     "of the file. Plane faces are exact.",
     kSolidOnly},
    {"scale", kSize, 1.0, kScaleMeaning, kWithMesh},
    where(kRotateRow, kWithMesh),
    where(kRotateRow, kWithSolid),
    where(kFacingRow, kWithMesh),
    where(kFacingRow, kWithSolid),
    {"weld_mm", Number{{.low = 0.0, .high = 1.0}}, 0.0,
     "Maximum distance of vertices that are merged to one vertex. 0: only vertices at the same position are merged.",
     kWithMesh},
    {"chord_mm", Number{{.low = 1e-6, .high = 1.0}}, 0.001,
     "Maximum distance between curved faces of the solid and the triangles by which they are traced.", kWithSolid},
    {"allow_open", Flag{}, false,
     "true: a mesh with defects is traced. Openings are closed by flat patches. A mesh that touches itself along edges "
     "is traced unchanged. A warning reports each defect. Results apply to the repaired mesh.",
     kWithMesh},
    {"plate_mm", Numbers{2, kPlausibleSize, "lengths, along x and y"}, kNone,
     "Lengths along x and y of a plate that replaces the elements. The flat back of the plate, on z = 0, is its only "
     "retro facet."},
    {"facets", File{"a table of planes"}, kNone,
     "Table with the plane of each facet of a finite part. These planes replace the nominal planes of the facets.",
     kFacetsOnly}};

constexpr NumberRange kLines{.low = 1.0, .high = 1e6};
constexpr Condition kBesideLines[] = {is_absent("mask", "only allowed together with rows or columns"),
                                      is_absent("rest", "only allowed together with rows or columns"),
                                      is_absent("area_fraction", "only allowed together with rows or columns"),
                                      is_absent("rectangles_mm", "only allowed together with rows or columns"),
                                      is_absent("polygon_mm", "only allowed together with rows or columns")};
constexpr Condition kBesideMask[] = {is_given("mask")};
constexpr Row kZoneRows[] = {
    renamed("share", Row{"area_fraction", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, kNone,
                         "Fraction of the part's area. The zone is a stripe over the whole length of the part along y. "
                         "The stripes are placed side by side along x, in the order of the file. Their fractions must "
                         "add up to 1 within 1e-6."}),
    {"rectangles_mm", NumberRows{4, kPlace, 1, 1000, "rectangles"}, kNone,
     "`[[x_from, y_from, x_to, y_to], ...]`: rectangles in the plan of the part. Each rectangle has its own array."},
    {"polygon_mm", NumberRows{2, kPlace, 3, 100, "points"}, kNone,
     "`[[x, y], ...]`: corners of a convex polygon in the plan of the part."},
    {"rows", NumberOrNumbers{kLines, true}, kNone,
     "Numbers of the rows (parallel to x) whose elements belong to the zone. Rows extend over the whole part and are "
     "counted from 1 at the smallest y."},
    {"columns", NumberOrNumbers{kLines, true}, kNone,
     "Numbers of the columns (parallel to y) whose elements belong to the zone. Columns extend over the whole part and "
     "are counted from 1 at the smallest x."},
    {"every", Integer{kLines}, kNone, "Number of rows or columns after which their numbering starts again at 1.",
     kBesideLines},
    {"mask", File{"a picture"}, kNone,
     "Image that covers the whole part. Its first row of pixels is at the largest y. Elements whose centroid is on a "
     "dark pixel belong to the zone."},
    {"mask_threshold", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 0.7,
     "Threshold for dark pixels. A pixel is dark if its grey value (0 to 255) is below `mask_threshold` * 255.",
     kBesideMask},
    {"rest", Flag{}, kNone, "true: the zone consists of all elements that belong to no other zone."},
    {"rotation_deg", Number{kAzimuth}, 0.0,
     "Rotation about z, from +x towards +y. The array of a region is rotated about the centre of the region's bounding "
     "box. Elements that are selected by `rows`, `columns`, `mask` or `rest` are rotated individually about their own "
     "centroids; the rotation must not change their outline."},
    {"set", Texts{}, kNone,
     "`[\"KEY=VALUE\", ...]`: values of this zone that differ from those of the design, written as for `--set`. "
     "Allowed are keys of `[element]`, keys of `[array]` except extent, lengths, margins and mask, and the keys of "
     "`[surface]` for angles and edges."}};

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

}  // namespace retrace::design
