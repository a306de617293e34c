#include "studies/design/io/design_rows.h"

namespace retrace::studies {
namespace {

using namespace schema;

constexpr NumberRange kAtLeastZero{.low = 0.0};
constexpr NumberRange kAngleError{.low = -300.0, .high = 300.0};
// Limits of heights and lengths. They are beyond the values of optical surfaces and keep squares and exponentials
// finite.
constexpr NumberRange kHeight{.low = 0.0, .high = 1e5};
constexpr NumberRange kLength{.low = 0.0, .high = 1e6};

constexpr Words kCoatings = {"none", "aluminium"};
constexpr Words kPolarisations = {"unpolarised", "linear", "right_circular", "left_circular"};
constexpr Words kLinear = {"linear"};
constexpr Words kIlluminants = {"A", "D65"};
constexpr Words kWeightings = {"photopic", "radiant"};
constexpr Words kFacetModels = {"real", "mirror"};
constexpr Words kEntranceModels = {"real", "lossless"};
constexpr Words kModels = {"smooth", "harvey_shack", "abg", "microfacet", "height_map"};
constexpr Words kAbg = {"abg"};
constexpr Words kMicrofacet = {"microfacet"};
constexpr Words kHeightMap = {"height_map"};
constexpr Words kSlopeDistributions = {"beckmann", "ggx"};
constexpr Words kForms = {"plane", "poly2", "poly3", "poly4", "poly5", "poly6", "poly7", "poly8"};
constexpr Words kWalls = {"smooth", "absorbing"};
constexpr Words kFacets = {"-x", "+x"};

constexpr Condition kThicknessOfMesh[] = {is_not(kKind, kBall), beside("part.mesh")};
constexpr Condition kThicknessOfOthers[] = {is_not(kKind, kBall, "not allowed for kind = \"ball\", which has no plate"),
                                            without("part.mesh")};

constexpr Condition kWithLayerIndex[] = {beside("refractive_index")};
constexpr Condition kIndexOfMaterial[] = {
    without("refractive_index", "not allowed together with refractive_index, which holds at every temperature")};

constexpr Row kBodyRows[] = {
    {"thickness_mm", kSize, kRequired,
     "The plate between the entrance face and the nominal rims; with a `[front]`: between the origin of its file and "
     "the rims.",
     kThicknessOfOthers},
    {"thickness_mm", kSize, kNone, "The mesh's own, if it is given.", kThicknessOfMesh},
    {"material", Text{}, "PMMA", "A name that `retrace list materials` shows."},
    {"catalogue", File{"a glass catalogue"}, kNone,
     "A catalogue of glasses in the AGF format, such as makers publish: `material` is then the name of one of them. Or "
     "a "
     "record of refractiveindex.info (`.yml`), which has one material: `material` is then not needed."},
    {"refractive_index", Number{{.low = 1.0, .high = 10.0}}, Computed{"the material's"},
     "Relative to air; takes precedence over the material."},
    {"temperature_c", Number{{.low = -200.0, .high = 400.0}}, Computed{"that of the material's data"},
     "Of the part and the air around it, whose indices change with it; lengths are those at that temperature. For "
     "materials with thermo-optic coefficients; not together with `refractive_index`.",
     kIndexOfMaterial},
    {"absorption_per_mm", Number{kAtLeastZero}, Computed{"the material's"},
     "Napierian, for power; takes precedence over the material. A list of two or more `[wavelength_nm, "
     "absorption_per_mm]`, linear between, gives it by wavelength (coloured lenses) and must reach all wavelengths of "
     "the light."},
    {"absorption_per_mm", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, absorption_per_mm]", 2}, kNone,
     "By wavelength."},
    {"facet_coating", Word{kCoatings}, "none",
     "`\"aluminium\"`: an opaque film on the retro facets; what it does not reflect is absorbed. `[coating]` has "
     "more."},
    {"back_index", Number{{.low = 1.0, .high = 3.0}}, 1.0,
     "Relative to air; of what lies behind the facets, such as water (1.333) or glue; air is in front and at the "
     "sides."}};

constexpr Condition kWithShare[] = {beside("share")};
constexpr NumberRange kPlaceInPart{.low = -1e6, .high = 1e6};

constexpr Row kWetBackRows[] = {
    {"index", Number{{.low = 1.0, .high = 3.0}}, kRequired,
     "Relative to air; of what lies behind these elements, such as water (1.333); behind the others lies what "
     "`body.back_index` says."},
    {"share", Number{{.low = 0.0, .high = 1.0}}, kNone,
     "The chance of each element to be one of them, by a hash of its row, its column and `seed`."},
    {"seed", Whole{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Of that choice.", kWithShare},
    {"rectangle_mm", Numbers{4, kPlaceInPart, "places, x and y of two corners"}, kNone,
     "`[x, y, x, y]`: elements whose middle lies in a rectangle of the part frame, its least corner first."},
    {"disc_mm", Numbers{3, kPlaceInPart, "lengths, x and y of the centre and the radius"}, kNone,
     "`[x, y, radius]`: those whose middle lies in a disc."},
    {"half_plane", Numbers{3, kPlaceInPart, "numbers, x and y in mm and an azimuth in degrees"}, kNone,
     "`[x_mm, y_mm, azimuth_deg]`: those whose middle lies on the side towards that azimuth of a line through x, y."}};

// Allowed refractive indices of a coating layer. The upper limit is high because metals have indices up to about 500 in
// the far infrared.
constexpr NumberRange kIndexOfLayer{.low = 0.0, .low_included = false, .high = 1000.0};

constexpr Row kLayerRows[] = {
    {"material", Text{}, kNone, "A name that `retrace list materials` shows, of a material or a metal."},
    {"refractive_index", Number{kIndexOfLayer}, kNone, "Relative to air; replaces the index of a material."},
    {"extinction_coefficient", Number{{.low = 0.0, .high = 1000.0}}, 0.0, "Imaginary part of that index.",
     kWithLayerIndex},
    {"thickness_nm", Number{{.low = 0.0, .high = 1e6}}, kNone,
     "Without it the layer is opaque, which takes a metal or an extinction coefficient above 0."}};

constexpr Condition kNoSpectrum[] = {
    without("spectrum", "not allowed together with spectrum: one of the two says what the light is")};
constexpr Condition kWithSpectrum[] = {beside("spectrum", "only allowed together with spectrum")};
constexpr Condition kLinearOnly[] = {is("polarisation", kLinear)};

constexpr Row kLightRows[] = {
    {"spectrum",
     WordOrFile{kIlluminants, ".csv", "\"A\", \"D65\", a file that ends in .csv or a list of [wavelength_nm, power]"},
     kNone,
     "In place of `wavelength_nm`: CIE illuminants, a file such as `\"lamp.csv\"`, or a list of lines "
     "`[[wavelength_nm, power], ...]`, each wavelength once."},
    {"spectrum", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, power]"}, kNone, "Lines."},
    {"weighting", Word{kWeightings}, "photopic",
     "`\"photopic\"` weighs power by the CIE's luminous efficiency, which is 0 outside 380 to 780 nm, so that shares "
     "are of the luminous flux; `\"radiant\"` does not.",
     kWithSpectrum},
    {"wavelength_nm", Number{kAboveZero}, 587.56,
     "In vacuum; a wavelength outside the material's data gives a warning.", kNoSpectrum},
    {"polarisation", Word{kPolarisations, " or a list of four Stokes parameters"}, "unpolarised",
     "A word, or Stokes parameters `[i, q, u, v]` with i > 0 and q^2 + u^2 + v^2 <= i^2."},
    {"polarisation", Numbers{4, {}, "Stokes parameters"}, kNone, "Stokes parameters."},
    {"polarisation_angle_deg", Number{kAzimuth}, 0.0, "Of the electric field, from the first axis towards the second.",
     kLinearOnly}};

constexpr Row kDetectorRows[] = {{"acceptance_half_angle_deg",
                                  NumberOrNumbers{{.low = 0.0, .low_included = false, .high = 90.0}}, 0.5,
                                  "In air; a list gives RRE for each."}};

constexpr Condition kErrorOfPrism[] = {without("part.mesh", kOfAMesh), without("part.plate_mm", kOfAMesh),
                                       is(kKind, kRtp)};
constexpr Condition kErrorOfCube[] = {without("part.mesh", kOfAMesh), without("part.plate_mm", kOfAMesh),
                                      is(kKind, geometry::kCubeKinds)};
constexpr Condition kErrors[] = {without("part.mesh", kOfAMesh), without("part.plate_mm", kOfAMesh)};
constexpr Condition kModelOfMap[] = {beside("height_map")};
constexpr Condition kModelOfOthers[] = {without("height_map")};
constexpr Condition kAbgOnly[] = {is("model", kAbg)};
constexpr Condition kMapOnly[] = {is("model", kHeightMap)};
constexpr Condition kMicrofacetOnly[] = {is("model", kMicrofacet)};

constexpr Kind kEdgeUm = Number{{.low = 0.0}};
constexpr Row kSurfaceRows[] = {
    {"dihedral_error_arcmin", Number{kAngleError}, 0.0, "The same as that much more apex angle.", kErrorOfPrism,
     kZeroIsNone},
    {"dihedral_error_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "A number for all dihedral edges, or a list of three for those at 0, +120 and +240 degrees.", kErrorOfCube,
     kZeroIsNone},
    {"facet_tilt_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "A list with one number for each facet, or 0; prisms: towards -x, +x; cube corners: between the edges at 0 and "
     "120, 120 and 240, 240 and 360 degrees.",
     kErrors, kZeroIsNone},
    {"angle_error_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, 0.0,
     "Of finite parts: standard deviation of a further tilt of every facet of every element, Gaussian and independent.",
     kErrors, kZeroIsNone},
    {"angle_error_seed", Whole{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Of those tilts.", kErrors},
    {"walls", Word{kWalls}, "smooth", "`\"absorbing\"`: walls of elements and of the border let no light go on."},
    {"model", Word{kModels}, "height_map", "How rough facets scatter.", kModelOfMap},
    {"model", Word{kModels}, Computed{"`\"harvey_shack\"` with roughness or waviness, otherwise `\"smooth\"`"},
     "How rough facets scatter.", kModelOfOthers},
    {"abg_a", Number{{.low = 0.0, .low_included = false, .high = 1e6}}, kRequired,
     "Per sr; BSDF = A / (B + \\|dbeta\\|^g).", kAbgOnly},
    {"abg_b", Number{{.low = 1e-12, .high = 1e6}}, kRequired, "See `abg_a`.", kAbgOnly},
    {"abg_g", Number{{.low = 1e-3, .high = 100.0}}, kRequired, "See `abg_a`.", kAbgOnly},
    {"height_map", File{"the file of a measured map"}, kRequired,
     "A measured map, as `retrace metrology` reads them, of 8 x 8 to 4,194,304 points.", kMapOnly},
    {"height_map_level_axis", Word{kAxes}, "x",
     "The axis of the map that lies level on a facet: along the roof edge of a prism.", kMapOnly},
    {"height_map_form", Word{kForms}, "plane", "Form that is removed from the map.", kMapOnly},
    {"slope_distribution", Word{kSlopeDistributions}, "beckmann", "Of the microfacets.", kMicrofacetOnly},
    {"roughness_sq_nm", Number{kHeight}, 0.0, "Of `harvey_shack`: rms height."},
    {"correlation_length_um", Number{kLength}, 0.0,
     "Where the Gaussian autocorrelation of the roughness is 1/e; required together with `roughness_sq_nm`."},
    {"correlation_length_down_um", Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     Computed{"`correlation_length_um`"},
     "Of roughness with a lay, such as feed marks: its length down the facet; `correlation_length_um` is then the "
     "level "
     "one, along the roof edge of a prism."},
    {"waviness_sq_nm", Number{kHeight}, 0.0, "Of `harvey_shack` and `microfacet`: rms height of the waviness."},
    {"waviness_length_um", Number{kLength}, 0.0, "Period of the waviness; required together with `waviness_sq_nm`."},
    {"root_radius_um", kEdgeUm, 0.0,
     "Radius of the roots, where facets of one element meet; to a quarter of the base, or a tenth of the aperture.",
     kErrors, kZeroIsNone},
    {"root_chamfer_um", kEdgeUm, 0.0, "Width of a flat in their place, across it; not together with a radius.", kErrors,
     kZeroIsNone},
    {"rim_radius_um", kEdgeUm, 0.0, "Radius of the rims, where neighbouring elements meet; the same bound.", kErrors,
     kZeroIsNone},
    {"rim_chamfer_um", kEdgeUm, 0.0, "Width of a flat in their place, across it; not together with a radius.", kErrors,
     kZeroIsNone},
    {"edge_chords", Whole{{.low = 4.0, .high = 64.0}}, 16.0, "Plane strips that stand for an arc from facet to facet.",
     kErrors}};

constexpr Row kScratchRows[] = {
    {"facet", Word{kFacets}, kRequired, "Which facet it lies on: by the side it faces."},
    {"position_um", Number{}, kRequired, "Of its middle along the roof edge, from the element's middle towards +y."},
    {"width_um", Number{{.low = 0.01, .high = 100.0}}, kRequired, "Across it; less than the element's."},
    {"depth_um", Number{}, kRequired,
     "Normal to the facet and into the part, at most half the width; < 0 is a ridge."}};

constexpr NumberRange kPower{.low = 0.0, .high = 8.0};
constexpr NumberRange kFormHeight{.low = -100.0, .high = 100.0};
constexpr Condition kWithFormMap[] = {beside("map")};
constexpr Row kFormRows[] = {
    {"sink_um", Number{kFormHeight}, 0.0,
     "How far the middle of a facet sinks into the body against its farthest corner, as a paraboloid; < 0: it bulges. "
     "The plane that fits it best is taken off."},
    {"map", File{"the file of a measured map"}, kNone,
     "Heights of a facet, as `retrace metrology` reads them, about its middle: a polynomial is fitted, less the plane "
     "that fits this best over the facet."},
    {"map_level_axis", Word{kAxes}, "x", "The axis of the map that lies level on a facet.", kWithFormMap},
    {"map_degree", Whole{{.low = 2.0, .high = 8.0}}, 4.0, "Of that polynomial.", kWithFormMap}};
constexpr Row kFormTermRows[] = {
    {"level", Whole{kPower}, kRequired, "Power of the place along the facet's level axis."},
    {"down", Whole{kPower}, kRequired, "Power of that down the facet; both together at most 8."},
    {"height_um", Number{kFormHeight}, kRequired, "Out of the body, where both places are the facet's radius."}};

constexpr Row kIdealisationRows[] = {
    {"facets", Word{kFacetModels}, "real", "`\"mirror\"`: retro facets reflect everything at every angle."},
    {"entrance", Word{kEntranceModels}, "real",
     "`\"lossless\"`: the entrance face refracts and passes everything; beyond the critical angle light ends."}};

}  // namespace

std::span<const Row> body_rows() {
  return kBodyRows;
}
std::span<const Row> wet_back_rows() {
  return kWetBackRows;
}
std::span<const Row> layer_rows() {
  return kLayerRows;
}
std::span<const Row> light_rows() {
  return kLightRows;
}
std::span<const Row> detector_rows() {
  return kDetectorRows;
}
std::span<const Row> surface_rows() {
  return kSurfaceRows;
}
std::span<const Row> scratch_rows() {
  return kScratchRows;
}
std::span<const Row> form_rows() {
  return kFormRows;
}
std::span<const Row> form_term_rows() {
  return kFormTermRows;
}
std::span<const Row> idealisation_rows() {
  return kIdealisationRows;
}

}  // namespace retrace::studies
