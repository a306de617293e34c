// Defines the keys of the tables that describe a surface.
#include <algorithm>
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
constexpr Kind kShare = Number{{.low = 0.01, .high = 10.0}};
constexpr Kind kSplineDegree = Whole{{.low = 2.0, .high = kMostSplineDegree}};
constexpr Kind kSamples = Whole{{.low = 16.0, .high = 4000.0}};
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
constexpr Condition kWithRadius[] = {beside("radius_mm")};

constexpr Row kSagRows[] = {
    {"kind", Word{kSags}, kRequired, "Kind of function that gives the height."},
    {"radius_mm", Number{kCoefficient}, kRequired,
     "Radius of curvature at the vertex, not 0. If it is negative, the centre is the highest point.", Access(),
     kOfConics},
    {"radius_mm", Number{kCoefficient}, kNone,
     "Radius of curvature, not 0, of a conic to which the polynomial is added. If it is negative, the centre is the "
     "highest point of the conic.",
     kOfPolynomials},
    {"conic", Number{kCoefficient}, 0.0, "Conic constant: 0 is a sphere, -1 a paraboloid.", kWithRadius},
    {"even", NumberRows{2, kCoefficient, 1, 200, "terms"}, kRequired,
     "Terms of the even polynomial, as rows `[power, coefficient]` of r^4, r^6, ... r^20, in mm.", kOfAsphere},
    {"terms", kTerms, kRequired, "Terms c (x / s)^i (y / s)^j of a degree of at most 16, as rows `[i, j, c]`.",
     Access(), kOfPolynomial},
    {"terms", kTerms, kRequired, "Orthonormal Zernike terms, as rows `[n, m, c]`; m < 0 are the sine terms.",
     kOfZernike},
    {"scale_mm", kPositiveMm, 1.0, "Length s in the terms.", kOfPolynomial},
    {"aperture_radius_mm", kPositiveMm, kRequired, "Radius of the disc on which the terms are defined.", kOfZernike},
    {"formula", Text{"a formula"}, kRequired,
     "Height as a formula of `x`, `y`, `r`, `theta` and, for lenslets, of their position `cx`, `cy`.", kOfFormula}};

constexpr Condition kCircleOnly[] = {is("kind", only(kCurves, "circle"))};
constexpr Condition kRectangleOnly[] = {is("kind", only(kCurves, "rectangle"))};
constexpr Condition kPointsOnly[] = {is("kind", only(kCurves, "points"))};
constexpr Condition kSampledOnly[] = {is("kind", kSampled)};
constexpr Row kBoundaryRows[] = {
    {"kind", Word{kCurves}, kRequired, "Kind of curve."},
    {"radius_mm", kPositiveMm, kRequired, "Radius of the circle.", kCircleOnly},
    {"size_mm", Numbers{2, kSize}, kRequired, "`[width, height]` of the rectangle.", kRectangleOnly},
    {"corner_mm", kPositiveMm, kRequired, "Radius of the rounded corners.", kRectangleOnly},
    {"points_mm", NumberRows{2, kPlace, 1, 4000, "points"}, kRequired,
     "Points of the curve; in order along the curve unless `scattered` is true.", Access(), kPointsOnly},
    {"scattered", Flag{}, false, "True if the points are in no particular order.", kPointsOnly},
    {"formula", Text{"a formula"}, kRequired, "Radius as a function of `theta`.", kOfFormula},
    {"centre_mm", Numbers{2, kPlace}, Computed{"0, 0; for points the centroid of the enclosed area"},
     "Point from which radii are measured."},
    {"degree", kSplineDegree, 3.0, "Degree of the periodic spline, which is C^(degree - 1) in azimuth."},
    {"samples", kSamples, 180.0, "Number of samples of the curve.", kSampledOnly}};

constexpr Row kExtrapolationRows[] = {{"order", Whole{{.low = 1.0, .high = jets::kMostOrder}}, 2.0,
                                       "Order n: the surface is C^n along radial lines. It is smooth in all directions "
                                       "if the `degree` of the boundary is n + 1."}};

constexpr Condition kGridOnly[] = {without("positions_mm")};
constexpr Condition kCirclesOnly[] = {is("boundary", only(kBoundaries, "circle"))};
constexpr Condition kIntersectionsOnly[] = {is("boundary", only(kBoundaries, "intersection"))};
constexpr Row kPlacedRows[] = {
    {"positions_mm", NumberRows{2, kPlace, 1, kMostLenslets, "places"}, kNone,
     "Positions of the lenslets, as rows `[x, y]`."},
    {"hexagonal_pitch_mm", kPositiveMm, kNone, "Pitch of a hexagonal grid of lenslets."},
    {"square_pitch_mm", kPositiveMm, kNone, "Pitch of a square grid of lenslets."},
    {"within_mm", kPositiveMm, kRequired, "Radius within which the grid has lenslets.", kGridOnly},
    {"height_mm", Number{kPlace}, 0.0, "Height of a lenslet's origin above the base, along the normal."},
    {"tilted", Flag{}, true, "Whether lenslets are tilted so that their axis is the normal of the base."},
    {"boundary", Word{kBoundaries}, kRequired,
     "Boundary of a lenslet: a circle, or the intersection of lenslet and base."},
    {"boundary_radius_mm", kPositiveMm, kRequired, "Radius of the circle.", kCirclesOnly},
    {"search_mm", kPositiveMm, kRequired, "Radius within which the intersection is searched.", kIntersectionsOnly},
    {"inner_share", kShare, kRequired,
     "Radius at which the blend leaves the lenslet, as a fraction of the boundary's radius."},
    {"outer_share", kShare, kRequired,
     "Radius at which the blend reaches the base, as a fraction of the boundary's radius. It is above `inner_share`."},
    {"blend_order", Whole{{.low = 1.0, .high = kMostBlendOrder}}, 2.0,
     "Order d of the blend, which is C^d at both ends."},
    {"degree", kSplineDegree, 3.0, "Degree of the boundary's spline."},
    {"samples", kSamples, 60.0, "Number of samples of the intersection.", kIntersectionsOnly}};
constexpr std::string_view kPlaceKeys[] = {"positions_mm", "hexagonal_pitch_mm", "square_pitch_mm"};
constexpr Rule kPlaceRules[] = {
    OneOf{kPlaceKeys, "must have one of positions_mm, hexagonal_pitch_mm and square_pitch_mm"}};

constexpr auto kLensletRows =
    []<std::size_t... sag, std::size_t... place>(std::index_sequence<sag...>, std::index_sequence<place...>) {
  return std::array{kSagRows[sag]..., kPlacedRows[place]...};
}
(std::make_index_sequence<std::size(kSagRows)>{}, std::make_index_sequence<std::size(kPlacedRows)>{});

constexpr Condition kBeyondBoundary[] = {beside("boundary", "needs a [boundary] beyond which to extrapolate")};
constexpr Table kTables[] = {{.name = "base", .meaning = "Sag of the surface.", .rows = kSagRows},
                             {.name = "boundary",
                              .meaning = "Curve within which the surface is the sag.",
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
