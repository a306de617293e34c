// Defines the keys of the tables that describe a surface.
#include <array>
#include <iterator>
#include <utility>

#include "geometry/io/surface_tables.h"
#include "geometry/surface/lenslet.h"
#include "geometry/surface/periodic_spline.h"

namespace retrace::geometry {
namespace {

using namespace schema;

constexpr NumberRange kCoefficient{.low = -1e9, .high = 1e9};
constexpr NumberRange kPlace{.low = -1e4, .high = 1e4};
constexpr NumberRange kSize{.low = 0.0, .low_included = false, .high = 1e4};
constexpr Kind kPositiveMm = Number{kSize};
constexpr Kind kRatio = Number{{.low = 0.01, .high = 10.0}};
constexpr Kind kSplineDegree = Integer{{.low = 2.0, .high = kMaxSplineDegree}};
constexpr Kind kSamples = Integer{{.low = 16.0, .high = 4000.0}};
constexpr Kind kTerms = NumberRows{3, kCoefficient, 1, 200, "terms"};

constexpr Words kSags = {"plane", "conic", "asphere", "xy_polynomial", "zernike", "formula"};
constexpr Words kCurves = {"circle", "rectangle", "points", "formula"};
constexpr Words kSampled = {"rectangle", "formula"};
constexpr Words kBoundaries = {"circle", "intersection"};

constexpr Condition kOfConics[] = {is("kind", only(kSags, "conic", "asphere"))};
constexpr Condition kOfAsphere[] = {is("kind", only(kSags, "asphere"))};
constexpr Condition kOfPolynomial[] = {is("kind", only(kSags, "xy_polynomial"))};
constexpr Condition kOfZernike[] = {is("kind", only(kSags, "zernike"))};
constexpr Condition kOfPolynomials[] = {is("kind", only(kSags, "xy_polynomial", "zernike"))};
constexpr Condition kOfFormula[] = {is("kind", only(kSags, "formula"))};
constexpr Condition kWithRadius[] = {is_given("radius_mm")};

constexpr Row kSagRows[] = {
    {"kind", Word{kSags}, kRequired, "Kind of the function that defines the height (sag)."},
    {"radius_mm", Number{kCoefficient}, kRequired,
     "Radius of curvature at the vertex, not 0. If it is negative, the vertex is the highest point.", Access(),
     kOfConics},
    {"radius_mm", Number{kCoefficient}, kNone,
     "Radius of curvature, not 0, of a conic to which the polynomial is added. If it is negative, the vertex is the "
     "highest point of the conic.",
     kOfPolynomials},
    {"conic", Number{kCoefficient}, 0.0, "Conic constant: 0 is a sphere, -1 a paraboloid.", kWithRadius},
    {"even", NumberRows{2, kCoefficient, 1, 200, "terms"}, kRequired,
     "Even polynomial terms that are added to the conic, as rows `[power, coefficient]`. Allowed powers of r are 4, 6, "
     "... 20. The height and r are in mm.",
     kOfAsphere},
    {"terms", kTerms, kRequired,
     "Terms c (x / s)^i (y / s)^j of the polynomial, as rows `[i, j, c]`, with i + j <= 16 and c in mm. The length s "
     "is `scale_mm`.",
     Access(), kOfPolynomial},
    {"terms", kTerms, kRequired,
     "Orthonormal Zernike terms, as rows `[n, m, c]`: radial order n, azimuthal order m, and coefficient c in mm. "
     "Terms with m < 0 are the sine terms.",
     kOfZernike},
    {"scale_mm", kPositiveMm, 1.0, "Length s by which x and y are divided in `terms`.", kOfPolynomial},
    {"aperture_radius_mm", kPositiveMm, kRequired, "Radius of the disc on which the terms are defined.", kOfZernike},
    {"formula", Text{"a formula"}, kRequired,
     "Height in mm, as a formula of `x`, `y`, `r`, `theta` and, for lenslets, of the position `cx`, `cy` of the "
     "lenslet.",
     kOfFormula}};

constexpr Condition kCircleOnly[] = {is("kind", only(kCurves, "circle"))};
constexpr Condition kRectangleOnly[] = {is("kind", only(kCurves, "rectangle"))};
constexpr Condition kPointsOnly[] = {is("kind", only(kCurves, "points"))};
constexpr Condition kSampledOnly[] = {is("kind", kSampled)};
constexpr Row kBoundaryRows[] = {
    {"kind", Word{kCurves}, kRequired, "Kind of the boundary curve."},
    {"radius_mm", kPositiveMm, kRequired, "Radius of the circle.", kCircleOnly},
    {"size_mm", Numbers{2, kSize}, kRequired, "`[width, height]` of the rectangle.", kRectangleOnly},
    {"corner_mm", kPositiveMm, kRequired, "Radius of the rounded corners.", kRectangleOnly},
    {"points_mm", NumberRows{2, kPlace, 1, 4000, "points"}, kRequired,
     "Points of the curve. Unless `scattered` is true, they must be in order along the curve.", Access(), kPointsOnly},
    {"scattered", Flag{}, false, "Whether the points are in no particular order.", kPointsOnly},
    {"formula", Text{"a formula"}, kRequired, "Radius of the curve, in mm, as a formula of the azimuth `theta`.",
     kOfFormula},
    {"centre_mm", Numbers{2, kPlace}, Computed{"0, 0; for points the centroid of the enclosed area"},
     "Point from which the radii of the curve are measured."},
    {"degree", kSplineDegree, 3.0,
     "Degree of the periodic spline that represents the curve. The curve is C^(degree - 1) in azimuth."},
    {"samples", kSamples, 180.0, "Number of points at which the curve is sampled for the spline.", kSampledOnly}};

constexpr Row kExtrapolationRows[] = {{"order", Integer{{.low = 1.0, .high = jets::kMaxOrder}}, 2.0,
                                       "Order n: the surface is C^n along radial lines. It is C^n in all directions if "
                                       "the `degree` of the boundary is n + 1."}};

constexpr Condition kGridOnly[] = {is_absent("positions_mm")};
constexpr Condition kCirclesOnly[] = {is("boundary", only(kBoundaries, "circle"))};
constexpr Condition kIntersectionsOnly[] = {is("boundary", only(kBoundaries, "intersection"))};
constexpr Row kPlacedRows[] = {
    {"positions_mm", NumberRows{2, kPlace, 1, kMaxLenslets, "points"}, kNone,
     "Positions of the lenslets, as rows `[x, y]`."},
    {"hexagonal_pitch_mm", kPositiveMm, kNone, "Pitch of a hexagonal grid of lenslets."},
    {"square_pitch_mm", kPositiveMm, kNone, "Pitch of a square grid of lenslets."},
    {"within_mm", kPositiveMm, kRequired,
     "Radius of the circle about the origin inside of which the grid has lenslets.", kGridOnly},
    {"height_mm", Number{kPlace}, 0.0, "Height of a lenslet's origin above the base, along the normal of the base."},
    {"tilted", Flag{}, true, "Whether each lenslet is tilted so that its axis is the normal of the base."},
    {"boundary", Word{kBoundaries}, kRequired,
     "Boundary of a lenslet: a circle, or the intersection of the lenslet with the base."},
    {"boundary_radius_mm", kPositiveMm, kRequired, "Radius of the circle.", kCirclesOnly},
    {"search_mm", kPositiveMm, kRequired,
     "Maximum distance from the lenslet's position at which the intersection is searched.", kIntersectionsOnly},
    renamed("inner_share",
            Row{"inner_radius_ratio", kRatio, kRequired,
                "Radius at which the blend (transition from the lenslet to the base) begins, divided by the boundary's "
                "radius."}),
    renamed("outer_share",
            Row{"outer_radius_ratio", kRatio, kRequired,
                "Radius at which the blend ends and the base begins, divided by the boundary's radius. It must be "
                "greater than `inner_radius_ratio`."}),
    {"blend_order", Integer{{.low = 1.0, .high = kMaxBlendOrder}}, 2.0,
     "Order d of the blend, which is C^d at both ends."},
    {"degree", kSplineDegree, 3.0, "Degree of the periodic spline that represents the boundary."},
    {"samples", kSamples, 60.0, "Number of points at which the intersection is sampled for the spline.",
     kIntersectionsOnly}};
constexpr std::string_view kPlaceKeys[] = {"positions_mm", "hexagonal_pitch_mm", "square_pitch_mm"};
constexpr Rule kPlaceRules[] = {
    OneOf{kPlaceKeys, "must contain exactly one of the keys positions_mm, hexagonal_pitch_mm and square_pitch_mm"}};

constexpr auto kLensletRows =
    []<std::size_t... sag, std::size_t... place>(std::index_sequence<sag...>, std::index_sequence<place...>) {
  return std::array{kSagRows[sag]..., kPlacedRows[place]...};
}
(std::make_index_sequence<std::size(kSagRows)>{}, std::make_index_sequence<std::size(kPlacedRows)>{});

constexpr Condition kBeyondBoundary[] = {
    is_given("boundary", "requires a table [boundary], outside of which the surface is extrapolated")};
constexpr Table kTables[] = {{.name = "base", .meaning = "Sag of the surface.", .rows = kSagRows},
                             {.name = "boundary",
                              .meaning = "Closed curve inside of which the surface is the sag of `[base]`.",
                              .rows = kBoundaryRows,
                              .presence = Presence::optional},
                             {.name = "extrapolation",
                              .meaning = "Continuation of the surface outside of the boundary.",
                              .rows = kExtrapolationRows,
                              .presence = Presence::optional,
                              .when = kBeyondBoundary},
                             {.name = "lenslets",
                              .meaning = "Lenslets on the base, each with a sag in its own frame.",
                              .rows = kLensletRows,
                              .rules = kPlaceRules,
                              .presence = Presence::optional}};

}  // namespace

std::span<const Table> surface_tables() {
  return kTables;
}

}  // namespace retrace::geometry
