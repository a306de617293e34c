#include "fabrication/turning/io/part_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/schema/conditions.h"
#include "fabrication/turning/lenslet.h"
#include "fabrication/turning/periodic_spline.h"
#include "fabrication/turning/surface.h"

namespace retrace::fabrication::turning {
namespace {

using namespace schema;

constexpr NumberRange kCoefficient{.low = -1e9, .high = 1e9};
constexpr NumberRange kPlace{.low = -1e4, .high = 1e4};
constexpr NumberRange kSize{.low = 0.0, .low_included = false, .high = 1e4};
constexpr Kind kPositiveMm = Number{kSize};
constexpr Kind kPositive = Number{{.low = 0.0, .low_included = false, .high = 1e9}};
constexpr Kind kShare = Number{{.low = 0.01, .high = 10.0}};
constexpr Kind kSplineDegree = Whole{{.low = 2.0, .high = kMostSplineDegree}};
constexpr Kind kSamples = Whole{{.low = 16.0, .high = 4000.0}};
constexpr Kind kTerms = NumberRows{3, kCoefficient, 1, 200, "terms"};

constexpr Words kSags = {"plane", "conic", "asphere", "xy_polynomial", "zernike", "formula"};
constexpr Words kCurves = {"circle", "rectangle", "points", "formula"};
constexpr Words kSampled = {"rectangle", "formula"};
constexpr Words kBoundaries = {"circle", "intersection"};
constexpr Words kStrategies = {"spiral", "raster"};
constexpr Words kSamplings = {"angle", "arc"};
constexpr Words kServos = {"slow", "fast"};

constexpr Condition kOfConics[] = {is("kind", only(kSags, "conic", "asphere"))};
constexpr Condition kOfAsphere[] = {is("kind", only(kSags, "asphere"))};
constexpr Condition kOfPolynomial[] = {is("kind", only(kSags, "xy_polynomial"))};
constexpr Condition kOfZernike[] = {is("kind", only(kSags, "zernike"))};
constexpr Condition kOfPolynomials[] = {is("kind", only(kSags, "xy_polynomial", "zernike"))};
constexpr Condition kOfFormula[] = {is("kind", only(kSags, "formula"))};
constexpr Condition kWithRadius[] = {beside("radius_mm")};

constexpr Row kSagRows[] = {
    {"kind", Word{kSags}, kRequired, "What gives the height."},
    {"radius_mm", Number{kCoefficient}, kRequired, "Not 0; negative: the middle is the highest place.", Access(),
     kOfConics},
    {"radius_mm", Number{kCoefficient}, kNone, "Likewise, of a conic below the polynomial.", kOfPolynomials},
    {"conic", Number{kCoefficient}, 0.0, "0 is a sphere, -1 a paraboloid.", kWithRadius},
    {"even", NumberRows{2, kCoefficient, 1, 200, "terms"}, kRequired,
     "Rows `[power, coefficient]` of r^4, r^6, ... r^20, in mm.", kOfAsphere},
    {"terms", kTerms, kRequired, "Rows `[i, j, c]` of c (x / s)^i (y / s)^j, of a degree of at most 16.", Access(),
     kOfPolynomial},
    {"terms", kTerms, kRequired, "Rows `[n, m, c]` of orthonormal terms, of sin for m < 0.", kOfZernike},
    {"scale_mm", kPositiveMm, 1.0, "The s of the terms.", kOfPolynomial},
    {"aperture_radius_mm", kPositiveMm, kRequired, "Of the terms' disc.", kOfZernike},
    {"formula", Text{"a formula"}, kRequired, "Of `x`, `y`, `r`, `theta` and, for lenslets, their place `cx`, `cy`.",
     kOfFormula}};

constexpr Condition kCircleOnly[] = {is("kind", only(kCurves, "circle"))};
constexpr Condition kRectangleOnly[] = {is("kind", only(kCurves, "rectangle"))};
constexpr Condition kPointsOnly[] = {is("kind", only(kCurves, "points"))};
constexpr Condition kSampledOnly[] = {is("kind", kSampled)};
constexpr Row kBoundaryRows[] = {
    {"kind", Word{kCurves}, kRequired, "What gives the curve."},
    {"radius_mm", kPositiveMm, kRequired, "Of the circle.", kCircleOnly},
    {"size_mm", Numbers{2, kSize}, kRequired, "`[width, height]`.", kRectangleOnly},
    {"corner_mm", kPositiveMm, kRequired, "Radius of the corners.", kRectangleOnly},
    {"points_mm", NumberRows{2, kPlace, 1, 4000, "points"}, kRequired, "In their order along the curve.", Access(),
     kPointsOnly},
    {"scattered", Flag{}, false, "Whether they come in any order.", kPointsOnly},
    {"formula", Text{"a formula"}, kRequired, "The radius, of `theta`.", kOfFormula},
    {"centre_mm", Numbers{2, kPlace}, Computed{"0, 0; of points their mean"}, "Of the polar form."},
    {"degree", kSplineDegree, 3.0, "Of the periodic spline: C^(degree - 1) in azimuth."},
    {"samples", kSamples, 180.0, "Of the curve.", kSampledOnly}};

constexpr Row kExtrapolationRows[] = {{"order", Whole{{.low = 1.0, .high = kMostOrder}}, 2.0,
                                       "n: C^n along radial lines; smooth all round with a `degree` of n + 1."}};

constexpr Condition kGridOnly[] = {without("positions_mm")};
constexpr Condition kCirclesOnly[] = {is("boundary", only(kBoundaries, "circle"))};
constexpr Condition kIntersectionsOnly[] = {is("boundary", only(kBoundaries, "intersection"))};
constexpr Row kPlacedRows[] = {
    {"positions_mm", NumberRows{2, kPlace, 1, kMostLenslets, "places"}, kNone, "Rows `[x, y]`."},
    {"hexagonal_pitch_mm", kPositiveMm, kNone, "Of a hexagonal grid."},
    {"square_pitch_mm", kPositiveMm, kNone, "Of a square grid."},
    {"within_mm", kPositiveMm, kRequired, "Radius within which the grid has places.", kGridOnly},
    {"height_mm", Number{kPlace}, 0.0, "Of the origin of a lenslet above the base, along the normal."},
    {"tilted", Flag{}, true, "Whether lenslets are tilted to the base's normal."},
    {"boundary", Word{kBoundaries}, kRequired, "A circle, or where lenslet and base meet."},
    {"boundary_radius_mm", kPositiveMm, kRequired, "Of the circle.", kCirclesOnly},
    {"search_mm", kPositiveMm, kRequired, "How far the intersection is searched.", kIntersectionsOnly},
    {"inner_share", kShare, kRequired, "Of the boundary's radius, where the blend leaves the lenslet."},
    {"outer_share", kShare, kRequired, "The same where it reaches the base; above `inner_share`."},
    {"blend_order", Whole{{.low = 1.0, .high = kMostBlendOrder}}, 2.0, "d: C^d at both ends."},
    {"degree", kSplineDegree, 3.0, "Of the boundary's spline."},
    {"samples", kSamples, 60.0, "Of the intersection.", kIntersectionsOnly}};
constexpr std::string_view kPlaceKeys[] = {"positions_mm", "hexagonal_pitch_mm", "square_pitch_mm"};
constexpr Rule kPlaceRules[] = {
    OneOf{kPlaceKeys, "must have one of positions_mm, hexagonal_pitch_mm and square_pitch_mm"}};

constexpr auto kLensletRows =
    []<std::size_t... sag, std::size_t... place>(std::index_sequence<sag...>, std::index_sequence<place...>) {
  return std::array{kSagRows[sag]..., kPlacedRows[place]...};
}
(std::make_index_sequence<std::size(kSagRows)>{}, std::make_index_sequence<std::size(kPlacedRows)>{});

constexpr Condition kNoLeastSkew[] = {without("find_least_skew")};
constexpr Row kToolRows[] = {
    {"nose_radius_mm", Number{{.low = 1e-4, .high = 100.0}}, kRequired, "Of the round edge."},
    {"clearance_deg", Number{{.low = 0.0, .low_included = false, .high = 60.0}}, kRequired,
     "Of the conical flank, against the normal of the rake face."},
    {"window_deg", Number{{.low = 1.0, .high = 178.0}}, 120.0, "Arc of the nose that is sharp, symmetric."},
    {"rake_deg", Number{{.low = -80.0, .high = 45.0}}, 0.0, "Positive: the face leans back."},
    {"skew_deg", Number{{.low = -80.0, .high = 80.0}}, 0.0,
     "Turn about the shank: of a spiral made by moving along Y, of a raster by C = -skew.", kNoLeastSkew},
    {"find_least_skew", Flag{}, false, "Whether to take the skew nearest to 0 that clears, within +-60."}};

constexpr Condition kSpiralOnly[] = {is("strategy", only(kStrategies, "spiral"))};
constexpr Condition kRasterOnly[] = {is("strategy", only(kStrategies, "raster"))};
constexpr Condition kAngleOnly[] = {is("sampling", only(kSamplings, "angle"))};
constexpr Condition kArcOnly[] = {is("sampling", only(kSamplings, "arc"))};
constexpr Kind kArcUm = Number{{.low = 0.1, .high = 1e4}};
constexpr Row kPathRows[] = {
    {"strategy", Word{kStrategies}, "spiral", "How the tool goes over the part."},
    {"feed_um", Number{{.low = 1e-3, .high = 1e4}}, kNone, "A turn, or from line to line."},
    {"scallop_nm", Number{{.low = 1e-3, .high = 1e6}}, kNone,
     "In its place: the feed whose cusps on a flat are so high."},
    {"clear_mm", Number{{.low = 0.01, .high = 1e3}}, 1.0, "Above the part, for moves without cutting."},
    {"radius_mm", kPositiveMm, kRequired, "From the part's rim to the centre.", kSpiralOnly},
    {"overrun_mm", Number{{.low = 0.0, .high = 1e3}}, 0.0,
     "Beyond the rim, where a spiral starts: on a surface that falls outwards the nose touches inside of its lowest "
     "point.",
     kSpiralOnly},
    {"spindle_rpm", Number{{.low = 0.01, .high = 1e5}}, kRequired, "Turns a minute.", kSpiralOnly},
    {"sampling", Word{kSamplings}, "angle",
     "What is equal from point to point; the controller joins them by straight moves of all axes, so a curved cut "
     "wants "
     "short ones: an arc s leaves s^2 k / 8.",
     kSpiralOnly},
    {"points_per_turn", Whole{{.low = 8.0, .high = 100000.0}}, 360.0, "Points by angle.", kAngleOnly},
    {"arc_um", kArcUm, kRequired, "From point to point.", kArcOnly},
    {"arc_um", kArcUm, kRequired, "Likewise along the lines.", kRasterOnly},
    {"servo", Word{kServos}, "slow",
     "`\"fast\"`: Z follows the mean over a turn, the rest is the stroke in `servo.csv`.", kAngleOnly},
    {"servo", Word{only(kServos, "slow")}, "slow", "A fast tool servo goes by the spindle's angle.", Access(),
     kArcOnly},
    {"size_mm", Numbers{2, kSize}, kRequired, "`[across the lines (X), along them (Y)]`.", kRasterOnly},
    {"cutting_mm_per_min", Number{{.low = 0.1, .high = 1e5}}, kRequired, "Along the lines.", kRasterOnly}};
constexpr std::string_view kFeedKeys[] = {"feed_um", "scallop_nm"};
constexpr Rule kPathRules[] = {OneOf{kFeedKeys, "must have either feed_um or scallop_nm"}};

constexpr Row kLimitRows[] = {{"travel_mm", Numbers{2, kPlace}, kNone, "`[low, high]`, which rise."},
                              {"speed_mm_per_s", kPositive, kNone, "Speed that is not exceeded."},
                              {"acceleration_mm_per_s2", kPositive, kNone, "The same of acceleration."},
                              {"jerk_mm_per_s3", kPositive, kNone, "The same of jerk."}};
constexpr Row kMachineRows[] = {{"spindle_rpm", kPositive, kNone, "Greatest speed of the spindle."}};
constexpr Table limits(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .rows = kLimitRows, .presence = Presence::optional};
}
constexpr Table kAxes[] = {limits("x", "Limits of X."), limits("y", "Limits of Y."), limits("z", "Limits of Z."),
                           limits("servo", "Limits of a fast tool servo.")};

constexpr Condition kRoundOnly[] = {
    is("path.strategy", only(kStrategies, "spiral"), "must not be given for a raster: meshes are round")};
constexpr Row kInspectRows[] = {
    {"form_tolerance_nm", kPositive, 10.0, "Larger form errors, and cuts below the surface, fail."},
    {"map_pixels", Whole{{.low = 11.0, .high = 2001.0}}, 101.0,
     "Of the map, each of which shows the greatest deviation over one feed across the cuts."},
    {"mesh_thickness_mm", kPositiveMm, kNone,
     "Writes `machined.stl`: what is moulded in the surface that the programs leave, with a level entrance face so far "
     "above its highest place.",
     kRoundOnly},
    {"mesh_rings", Whole{{.low = 2.0, .high = 1000.0}}, 100.0, "Circles of that mesh."}};

constexpr Condition kBeyondBoundary[] = {beside("boundary", "needs a [boundary] beyond which to extrapolate")};
constexpr Row kRows[] = {{"title", Text{}, kNone, "One line."}};
constexpr Table kTables[] = {{.name = "base", .meaning = "The sag.", .rows = kSagRows},
                             {.name = "boundary",
                              .meaning = "Within which the surface is the sag.",
                              .rows = kBoundaryRows,
                              .presence = Presence::optional},
                             {.name = "extrapolation",
                              .meaning = "How the surface goes on beyond it.",
                              .rows = kExtrapolationRows,
                              .presence = Presence::optional,
                              .when = kBeyondBoundary},
                             {.name = "lenslets",
                              .meaning = "Lenslets on the base, each a sag in its own frame.",
                              .rows = kLensletRows,
                              .rules = kPlaceRules,
                              .presence = Presence::optional},
                             {.name = "tool", .meaning = "The diamond.", .rows = kToolRows},
                             {.name = "path", .meaning = "How it moves.", .rows = kPathRows, .rules = kPathRules},
                             {.name = "machine",
                              .meaning = "Limits of the machine; what is not given is not limited.",
                              .rows = kMachineRows,
                              .tables = kAxes,
                              .presence = Presence::implied},
                             {.name = "inspect",
                              .meaning = "What is asked of the result.",
                              .rows = kInspectRows,
                              .presence = Presence::implied}};

constexpr Format kFormat = {"turned_part",
                            "retrace.turned_part/1",
                            "Freeform surface, turned",
                            {"", "A surface, the tool, its path, the machine and the inspection.", kRows, kTables}};

}  // namespace

const Format& turned_part_format() {
  return kFormat;
}

}  // namespace retrace::fabrication::turning
