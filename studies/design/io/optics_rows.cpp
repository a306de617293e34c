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
     "Thickness of the plate between the entrance face and the nominal rims. With a `[front]`, it is measured from the "
     "origin of its file to the rims.",
     kThicknessOfOthers},
    {"thickness_mm", kSize, kNone, "Thickness of the plate. If it is given, it must equal the thickness of the mesh.",
     kThicknessOfMesh},
    {"material", Text{}, "PMMA", "Name of a material that `retrace list materials` shows."},
    {"catalogue", File{"a glass catalogue"}, kNone,
     "Catalogue of glasses in the AGF format, as published by makers; `material` is then the name of one of its "
     "glasses. Or a record of refractiveindex.info (`.yml`), which has one material; `material` is then not needed."},
    {"refractive_index", Number{{.low = 1.0, .high = 10.0}}, Computed{"that of the material"},
     "Refractive index relative to air. It takes precedence over the material."},
    {"temperature_c", Number{{.low = -200.0, .high = 400.0}}, Computed{"the temperature of the material's data"},
     "Temperature of the part and the surrounding air, whose indices depend on it; lengths are those at this "
     "temperature. For materials with thermo-optic coefficients; not together with `refractive_index`.",
     kIndexOfMaterial},
    {"absorption_per_mm", Number{kAtLeastZero}, Computed{"that of the material"},
     "Napierian absorption coefficient, for power; it takes precedence over the material. A list of two or more "
     "`[wavelength_nm, absorption_per_mm]`, with linear interpolation, gives it as a function of wavelength (coloured "
     "lenses) and must cover all wavelengths of the light."},
    {"absorption_per_mm", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, absorption_per_mm]", 2}, kNone,
     "Absorption coefficient as a function of wavelength."},
    {"facet_coating", Word{kCoatings}, "none",
     "Coating of the retro facets. `\"aluminium\"`: an opaque film that absorbs all light that it does not reflect. "
     "`[coating]` allows other layers."},
    {"back_index", Number{{.low = 1.0, .high = 3.0}}, 1.0,
     "Refractive index, relative to air, of the medium behind the facets, such as water (1.333) or glue. The medium at "
     "the entrance face and at the sides of the part is air."}};

constexpr Condition kWithShare[] = {beside("share")};
constexpr NumberRange kPlaceInPart{.low = -1e6, .high = 1e6};

constexpr Row kWetBackRows[] = {
    {"index", Number{{.low = 1.0, .high = 3.0}}, kRequired,
     "Refractive index, relative to air, of the medium behind these elements, such as water (1.333). The medium behind "
     "all other elements is that of `body.back_index`."},
    {"share", Number{{.low = 0.0, .high = 1.0}}, kNone,
     "Probability that an element is selected. The choice depends on a hash of its row, its column and `seed`."},
    {"seed", Whole{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Seed of the random choice of elements.", kWithShare},
    {"rectangle_mm", Numbers{4, kPlaceInPart, "places, x and y of two corners"}, kNone,
     "`[x, y, x, y]`: rectangle in the part frame, given by its corners of smallest and of largest x and y. Elements "
     "whose centroid lies in it are selected."},
    {"disc_mm", Numbers{3, kPlaceInPart, "lengths, x and y of the centre and the radius"}, kNone,
     "`[x, y, radius]`: disc. Elements whose centroid lies in it are selected."},
    {"half_plane", Numbers{3, kPlaceInPart, "numbers, x and y in mm and an azimuth in degrees"}, kNone,
     "`[x_mm, y_mm, azimuth_deg]`: half-plane whose border passes through x, y and which extends from there towards "
     "the azimuth. Elements whose centroid lies in it are selected."}};

// Allowed refractive indices of a coating layer. The upper limit is high because metals have indices up to about 500 in
// the far infrared.
constexpr NumberRange kIndexOfLayer{.low = 0.0, .low_included = false, .high = 1000.0};

constexpr Row kLayerRows[] = {
    {"material", Text{}, kNone, "Name of a material or a metal that `retrace list materials` shows."},
    {"refractive_index", Number{kIndexOfLayer}, kNone,
     "Refractive index relative to air, in place of that of a material."},
    {"extinction_coefficient", Number{{.low = 0.0, .high = 1000.0}}, 0.0,
     "Extinction coefficient, the imaginary part of the refractive index.", kWithLayerIndex},
    {"thickness_nm", Number{{.low = 0.0, .high = 1e6}}, kNone,
     "Thickness of the layer. Without this key the layer is opaque, and must be a metal or have an extinction "
     "coefficient above 0."}};

constexpr Condition kNoSpectrum[] = {
    without("spectrum", "not allowed together with spectrum: one of the two says what the light is")};
constexpr Condition kWithSpectrum[] = {beside("spectrum", "only allowed together with spectrum")};
constexpr Condition kLinearOnly[] = {is("polarisation", kLinear)};

constexpr Row kLightRows[] = {
    {"spectrum",
     WordOrFile{kIlluminants, ".csv", "\"A\", \"D65\", a file that ends in .csv or a list of [wavelength_nm, power]"},
     kNone,
     "Spectrum of the light, in place of `wavelength_nm`: a CIE illuminant, a file such as `\"lamp.csv\"`, or a list "
     "of lines `[[wavelength_nm, power], ...]` with each wavelength once."},
    {"spectrum", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, power]"}, kNone, "Spectral lines."},
    {"weighting", Word{kWeightings}, "photopic",
     "Weighting of power. `\"photopic\"` weights power by the CIE's luminous efficiency, which is 0 outside 380 to 780 "
     "nm, so that results are fractions of the luminous flux. `\"radiant\"` does not weight it.",
     kWithSpectrum},
    {"wavelength_nm", Number{kAboveZero}, 587.56,
     "Wavelength in vacuum. A wavelength outside the range of the material's data gives a warning.", kNoSpectrum},
    {"polarisation", Word{kPolarisations, " or a list of four Stokes parameters"}, "unpolarised",
     "State of polarisation: a word, or Stokes parameters `[i, q, u, v]` with i > 0 and q^2 + u^2 + v^2 <= i^2."},
    {"polarisation", Numbers{4, {}, "Stokes parameters"}, kNone, "Stokes parameters."},
    {"polarisation_angle_deg", Number{kAzimuth}, 0.0,
     "Direction of the electric field, from the first axis towards the second.", kLinearOnly}};

constexpr Row kDetectorRows[] = {{"acceptance_half_angle_deg",
                                  NumberOrNumbers{{.low = 0.0, .low_included = false, .high = 90.0}}, 0.5,
                                  "Half-angle of the acceptance cone, in air. A list gives RRE for each half-angle."}};

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
    {"dihedral_error_arcmin", Number{kAngleError}, 0.0, "Error of the apex angle, which is added to `apex_angle_deg`.",
     kErrorOfPrism, kZeroIsNone},
    {"dihedral_error_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "Errors of the dihedral angles: a number for all dihedral edges, or a list of three for the edges at 0, +120 and "
     "+240 degrees.",
     kErrorOfCube, kZeroIsNone},
    {"facet_tilt_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "Tilts of the facets: a list with one number for each facet, or 0. Prisms: the facets towards -x, +x; cube "
     "corners: the facets between the edges at 0 and 120, 120 and 240, 240 and 360 degrees.",
     kErrors, kZeroIsNone},
    {"angle_error_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, 0.0,
     "Standard deviation of additional random tilts, for finite parts. The tilt of every facet of every element is "
     "Gaussian and independent.",
     kErrors, kZeroIsNone},
    {"angle_error_seed", Whole{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Seed of the random tilts.", kErrors},
    {"walls", Word{kWalls}, "smooth",
     "Model of the walls. `\"absorbing\"`: walls of elements and of the border absorb all light."},
    {"model", Word{kModels}, "height_map", "Scatter model of rough facets.", kModelOfMap},
    {"model", Word{kModels}, Computed{"`\"harvey_shack\"` with roughness or waviness, otherwise `\"smooth\"`"},
     "Scatter model of rough facets.", kModelOfOthers},
    {"abg_a", Number{{.low = 0.0, .low_included = false, .high = 1e6}}, kRequired,
     "Parameter A, per sr, of the model BSDF = A / (B + \\|dbeta\\|^g).", kAbgOnly},
    {"abg_b", Number{{.low = 1e-12, .high = 1e6}}, kRequired, "Parameter B of the model in `abg_a`.", kAbgOnly},
    {"abg_g", Number{{.low = 1e-3, .high = 100.0}}, kRequired, "Parameter g of the model in `abg_a`.", kAbgOnly},
    {"height_map", File{"the file of a measured map"}, kRequired,
     "Measured map of heights, in a format that `retrace metrology` reads, of 8 x 8 to 4,194,304 points.", kMapOnly},
    {"height_map_level_axis", Word{kAxes}, "x",
     "Axis of the map that is horizontal on a facet, which is along the roof edge of a prism.", kMapOnly},
    {"height_map_form", Word{kForms}, "plane", "Form that is removed from the map.", kMapOnly},
    {"slope_distribution", Word{kSlopeDistributions}, "beckmann", "Distribution of the slopes of the microfacets.",
     kMicrofacetOnly},
    {"roughness_sq_nm", Number{kHeight}, 0.0, "Rms height of the roughness, for `harvey_shack`."},
    {"correlation_length_um", Number{kLength}, 0.0,
     "Length at which the Gaussian autocorrelation of the roughness is 1/e. It is required together with "
     "`roughness_sq_nm`."},
    {"correlation_length_down_um", Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     Computed{"`correlation_length_um`"},
     "Correlation length down the facet, for roughness with a lay, such as feed marks. `correlation_length_um` is then "
     "the horizontal correlation length, along the roof edge of a prism."},
    {"waviness_sq_nm", Number{kHeight}, 0.0, "Rms height of the waviness, for `harvey_shack` and `microfacet`."},
    {"waviness_length_um", Number{kLength}, 0.0,
     "Period of the waviness. It is required together with `waviness_sq_nm`."},
    {"root_radius_um", kEdgeUm, 0.0,
     "Radius of the roots, where facets of one element meet. It is at most a quarter of the base, or a tenth of the "
     "aperture.",
     kErrors, kZeroIsNone},
    {"root_chamfer_um", kEdgeUm, 0.0,
     "Width of a flat in place of each root, across the root. Not together with a radius.", kErrors, kZeroIsNone},
    {"rim_radius_um", kEdgeUm, 0.0,
     "Radius of the rims, where neighbouring elements meet. It is at most a quarter of the base, or a tenth of the "
     "aperture.",
     kErrors, kZeroIsNone},
    {"rim_chamfer_um", kEdgeUm, 0.0,
     "Width of a flat in place of each rim, across the rim. Not together with a radius.", kErrors, kZeroIsNone},
    {"edge_chords", Whole{{.low = 4.0, .high = 64.0}}, 16.0,
     "Number of plane strips that approximate an arc from facet to facet.", kErrors}};

constexpr Row kScratchRows[] = {
    {"facet", Word{kFacets}, kRequired, "Facet with the scratch, named by the side that it faces."},
    {"position_um", Number{}, kRequired,
     "Position of the scratch's centre along the roof edge, from the centre of the element towards +y."},
    {"width_um", Number{{.low = 0.01, .high = 100.0}}, kRequired,
     "Width across the scratch, less than the width of the element."},
    {"depth_um", Number{}, kRequired,
     "Depth normal to the facet and into the part, at most half the width; < 0 is a ridge."}};

constexpr NumberRange kPower{.low = 0.0, .high = 8.0};
constexpr NumberRange kFormHeight{.low = -100.0, .high = 100.0};
constexpr Condition kWithFormMap[] = {beside("map")};
constexpr Row kFormRows[] = {
    {"sink_um", Number{kFormHeight}, 0.0,
     "Depth by which the centroid of a facet sinks into the body relative to its farthest corner, in the shape of a "
     "paraboloid; < 0: it bulges. The best-fit plane is subtracted."},
    {"map", File{"the file of a measured map"}, kNone,
     "Measured heights of a facet, in a format that `retrace metrology` reads, about the centre of the map. A "
     "polynomial is fitted to them, and its best-fit plane over the facet is subtracted."},
    {"map_level_axis", Word{kAxes}, "x", "Axis of the map that is horizontal on a facet.", kWithFormMap},
    {"map_degree", Whole{{.low = 2.0, .high = 8.0}}, 4.0, "Degree of the polynomial that is fitted to the map.",
     kWithFormMap}};
constexpr Row kFormTermRows[] = {
    {"level", Whole{kPower}, kRequired, "Power of the coordinate along the horizontal axis of the facet."},
    {"down", Whole{kPower}, kRequired, "Power of the coordinate down the facet; the sum of both powers is at most 8."},
    {"height_um", Number{kFormHeight}, kRequired,
     "Height out of the body where both coordinates equal the radius of the facet."}};

constexpr Row kIdealisationRows[] = {
    {"facets", Word{kFacetModels}, "real",
     "Model of the retro facets. `\"mirror\"`: they reflect all light at every angle."},
    {"entrance", Word{kEntranceModels}, "real",
     "Model of the entrance face. `\"lossless\"`: it refracts and transmits all light; light beyond the critical angle "
     "ends."}};

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
