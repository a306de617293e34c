#include "design/io/design_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr NumberRange kAtLeastZero{.low = 0.0};
constexpr NumberRange kAngleError{.low = -300.0, .high = 300.0};
constexpr NumberRange kAngleErrorArcsec{.low = 60.0 * kAngleError.low, .high = 60.0 * kAngleError.high};
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

constexpr Words kOffsetKind = {"offset"};

constexpr Condition kThicknessOfMesh[] = {is_not(kKind, kBall), is_given("part.mesh")};
constexpr Condition kThicknessOfSolid[] = {is_not(kKind, kBall), is_given("part.solid")};
constexpr Condition kThicknessOfOthers[] = {
    is_not(kKind, kBall, "not allowed for element.kind = \"ball\", which has no plate"), is_absent("part.mesh"),
    is_absent("part.solid"),
    is_not("substrate.kind", kOffsetKind,
           "not allowed for substrate.kind = \"offset\", whose elements are substrate.wall_mm below the entrance "
           "surface"),
    is_not(kKind, geometry::kRoundCube, "not allowed for element.kind = \"round_icc\", which has length_mm")};

constexpr Condition kWithLayerIndex[] = {is_given("refractive_index")};
constexpr Condition kIndexOfMaterial[] = {
    is_absent("refractive_index", "not allowed together with refractive_index, which holds at every temperature")};

// Ranges and kinds of values that the keys of the body and the keys of the shells have in common.
constexpr NumberRange kIndexOfBody{.low = 1.0, .high = 10.0};
constexpr Kind kAbsorptionNumber = Number{kAtLeastZero};
constexpr Kind kAbsorptionCurve = Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, absorption_per_mm]", 2};
constexpr Row kAbsorptionByWavelength = {"absorption_per_mm", kAbsorptionCurve, kNone,
                                         "Absorption coefficient as a function of wavelength."};

constexpr Row kBodyRows[] = {
    {"thickness_mm", kSize, kRequired,
     "Thickness of the plate between the entrance face and the nominal rims of the elements. With an "
     "`[entrance_surface]`, it is the height of the origin of the surface above the nominal rims.",
     kThicknessOfOthers},
    {"thickness_mm", kSize, kNone,
     "Thickness of the plate. If this key is given, it must equal the thickness of the mesh.", kThicknessOfMesh},
    {"thickness_mm", kSize, kNone,
     "Thickness of the plate. If this key is given, it must equal the thickness of the solid.", kThicknessOfSolid},
    {"material", Text{}, "PMMA", "Name of the material. `retrace list materials` shows the available names."},
    {"catalogue", File{"a glass catalogue"}, kNone,
     "Glass catalogue in the AGF format, as published by glass makers. `material` is then the name of a glass in the "
     "catalogue. Alternatively, a record of refractiveindex.info (`.yml`). Such a record has only one material, and "
     "`material` is not needed."},
    {"refractive_index", Number{kIndexOfBody}, Computed{"that of the material"},
     "Refractive index of the body relative to air. It takes precedence over the index of the material."},
    {"temperature_c", Number{{.low = -200.0, .high = 400.0}}, Computed{"the temperature of the material's data"},
     "Temperature of the part and the surrounding air. The refractive indices of both depend on it. All lengths of the "
     "design apply at this temperature. Only for materials with thermo-optic coefficients, and not together with "
     "`refractive_index`.",
     kIndexOfMaterial},
    {"absorption_per_mm", kAbsorptionNumber, Computed{"that of the material"},
     "Napierian absorption coefficient of the body, for power. It takes precedence over the absorption of the "
     "material. A list of two or more `[wavelength_nm, absorption_per_mm]` gives the coefficient as a function of "
     "wavelength (for coloured lenses), with linear interpolation. The list must cover all wavelengths of the light."},
    kAbsorptionByWavelength,
    {"facet_coating", Word{kCoatings}, "none",
     "Coating of the retro facets. `\"aluminium\"`: an opaque film that absorbs all light that it does not reflect. "
     "Other layers are specified in `[coating]`."},
    {"back_index", Number{{.low = 1.0, .high = 3.0}}, 1.0,
     "Refractive index, relative to air, of the medium behind the retro facets, such as water (1.333) or glue. The "
     "medium at the entrance face and at the sides of the part is always air."}};

constexpr NumberRange kGapOfShell{.low = 0.0, .high = 1e6};
constexpr NumberRange kRadiusOfShell{.low = -1e6, .high = 1e6};
constexpr NumberRange kWedge{.low = -30.0, .high = 30.0};
constexpr NumberRange kTilt{.low = -60.0, .high = 60.0};
constexpr double kNoRotation[] = {0.0, 0.0};

constexpr Row kShellRows[] = {
    {"thickness_mm", kSize, kRequired,
     "Distance between both surfaces at the middle of the part, along the normal of the outer surface. The middle is "
     "the centre of the outline's bounding box."},
    {"gap_mm", Number{kGapOfShell}, kRequired,
     "Distance at the middle from the inner surface to the next surface towards the part: the outer surface of the "
     "next shell, or the entrance surface."},
    {"material", Text{}, "PMMA", "Name of the material. `retrace list materials` shows the available names."},
    {"refractive_index", Number{kIndexOfBody}, Computed{"that of the material"},
     "Refractive index of the shell relative to air. It takes precedence over the index of the material."},
    {"absorption_per_mm", kAbsorptionNumber, Computed{"that of the material"},
     "Napierian absorption coefficient of the shell, for power. A list of two or more `[wavelength_nm, "
     "absorption_per_mm]` gives the coefficient as a function of wavelength, as in `[body]`."},
    kAbsorptionByWavelength,
    {"outer_radius_mm", Number{kRadiusOfShell}, Computed{"plane"},
     "Radius of the sphere on the side of the source. It is above 0 if the surface is convex towards the source, and "
     "below 0 if it is concave; not 0. The surface must extend over the whole part."},
    {"inner_radius_mm", Number{kRadiusOfShell}, Computed{"plane"},
     "Radius of the sphere on the side of the part. It is above 0 if this surface, like an outer surface, is curved "
     "towards the source; not 0."},
    {"wedge_deg", Numbers{2, kWedge, "angles, about x and about y"}, std::span<const double>(kNoRotation),
     "`[about x, about y]`: rotation of the inner surface relative to the outer surface, about the middle of the inner "
     "surface."},
    {"tilt_deg", Numbers{2, kTilt, "angles, about x and about y"}, std::span<const double>(kNoRotation),
     "`[about x, about y]`: rotation of the whole shell about the middle of its inner surface, first about x and then "
     "about y."}};

constexpr Condition kWithFraction[] = {is_given("fraction")};
constexpr NumberRange kPlaceInPart{.low = -1e6, .high = 1e6};

constexpr Row kWetBackRows[] = {
    {"index", Number{{.low = 1.0, .high = 3.0}}, kRequired,
     "Refractive index, relative to air, of the medium behind the selected elements, such as water (1.333). The medium "
     "behind all other elements is that of `body.back_index`."},
    renamed("share", Row{"fraction", Number{{.low = 0.0, .high = 1.0}}, kNone,
                         "Probability that an element is selected. The choice depends on a hash of its row, its column "
                         "and `seed`."}),
    {"seed", Integer{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Seed of the random choice of elements.", kWithFraction},
    {"rectangle_mm", Numbers{4, kPlaceInPart, "coordinates, x and y of two corners"}, kNone,
     "`[x_min, y_min, x_max, y_max]`: rectangle in the part frame. Elements whose centroid is inside the rectangle are "
     "selected."},
    {"disc_mm", Numbers{3, kPlaceInPart, "lengths, x and y of the centre and the radius"}, kNone,
     "`[x, y, radius]`: centre and radius of a disc in the part frame. Elements whose centroid is inside the disc are "
     "selected."},
    {"half_plane", Numbers{3, kPlaceInPart, "numbers, x and y in mm and an azimuth in degrees"}, kNone,
     "`[x_mm, y_mm, azimuth_deg]`: half-plane in the part frame. Its border passes through the point (x, y) and is "
     "perpendicular to the azimuth. The half-plane extends from the border in the direction of the azimuth. Elements "
     "whose centroid is inside the half-plane are selected."}};

// Allowed refractive indices of a coating layer. The upper limit is high because metals have indices up to about 500 in
// the far infrared.
constexpr NumberRange kIndexOfLayer{.low = 0.0, .low_included = false, .high = 1000.0};

constexpr Row kLayerRows[] = {
    {"material", Text{}, kNone, "Name of a material or a metal; `retrace list materials` shows the available names."},
    {"refractive_index", Number{kIndexOfLayer}, kNone,
     "Refractive index of the layer relative to air, instead of the index of a material."},
    {"extinction_coefficient", Number{{.low = 0.0, .high = 1000.0}}, 0.0,
     "Extinction coefficient of the layer, the imaginary part of the refractive index.", kWithLayerIndex},
    {"thickness_nm", Number{{.low = 0.0, .high = 1e6}}, kNone,
     "Thickness of the layer. Without this key, the layer is opaque; it must then be a metal or have an extinction "
     "coefficient above 0."}};

constexpr Condition kNoSpectrum[] = {
    is_absent("spectrum", "not allowed together with spectrum: give either wavelength_nm or spectrum")};
constexpr Condition kWithSpectrum[] = {is_given("spectrum", "only allowed together with spectrum")};
constexpr Condition kLinearOnly[] = {is("polarisation", kLinear)};

constexpr Row kLightRows[] = {
    {"spectrum",
     WordOrFile{kIlluminants, ".csv", "\"A\", \"D65\", a file that ends in .csv or a list of [wavelength_nm, power]"},
     kNone,
     "Spectrum of the light, instead of `wavelength_nm`: a CIE illuminant, a file such as `\"lamp.csv\"`, or a list of "
     "spectral lines `[[wavelength_nm, power], ...]`. Each wavelength may occur only once in the list."},
    {"spectrum", Pairs{kAboveZero, kAtLeastZero, "[wavelength_nm, power]"}, kNone, "Spectral lines."},
    {"weighting", Word{kWeightings}, "photopic",
     "Weighting of power. `\"photopic\"`: power is weighted by the luminous efficiency of the CIE, which is 0 outside "
     "of 380 to 780 nm. Results are then fractions of the luminous flux. `\"radiant\"`: power is not weighted.",
     kWithSpectrum},
    {"wavelength_nm", Number{kAboveZero}, 587.56,
     "Wavelength of the light in vacuum. A wavelength outside the range of the material's data causes a warning.",
     kNoSpectrum},
    {"polarisation", Word{kPolarisations, " or a list of four Stokes parameters"}, "unpolarised",
     "Polarisation of the light: a word, or the Stokes parameters `[i, q, u, v]` with i > 0 and q^2 + u^2 + v^2 <= "
     "i^2."},
    {"polarisation", Numbers{4, {}, "Stokes parameters"}, kNone, "Stokes parameters."},
    {"polarisation_angle_deg", Number{kAzimuth}, 0.0,
     "Direction of the electric field, measured from the first axis of polarisation towards the second axis.",
     kLinearOnly}};

constexpr Row kDetectorRows[] = {
    {"acceptance_half_angle_deg", NumberOrNumbers{{.low = 0.0, .low_included = false, .high = 90.0}}, 0.5,
     "Half-angle of the acceptance cone, in air. For a list, the RRE of each half-angle is computed."}};

constexpr Condition kErrorOfPrism[] = {is_absent("part.mesh", kNotWithMesh), is_absent("part.solid", kNotWithMesh),
                                       is_absent("part.plate_mm", kNotWithMesh), is(kKind, kRtp)};
constexpr Condition kErrorOfCube[] = {is_absent("part.mesh", kNotWithMesh), is_absent("part.solid", kNotWithMesh),
                                      is_absent("part.plate_mm", kNotWithMesh),
                                      is(kKind, only(geometry::kElementKinds, "hexagonal_icc", "ruled"))};
constexpr Condition kArcsecOfCube[] = {
    is_absent("part.mesh", kNotWithMesh), is_absent("part.solid", kNotWithMesh),
    is_absent("part.plate_mm", kNotWithMesh), is(kKind, geometry::kCubeKindsOfDesigns, "only allowed for cube corners"),
    is_absent("surface.dihedral_error_arcmin", "not allowed together with dihedral_error_arcmin")};
constexpr Condition kErrors[] = {is_absent("part.mesh", kNotWithMesh), is_absent("part.solid", kNotWithMesh),
                                 is_absent("part.plate_mm", kNotWithMesh)};
constexpr Condition kModelOfMap[] = {is_given("height_map")};
constexpr Condition kModelOfOthers[] = {is_absent("height_map")};
constexpr Condition kAbgOnly[] = {is("model", kAbg)};
constexpr Condition kMapOnly[] = {is("model", kHeightMap)};
constexpr Condition kMicrofacetOnly[] = {is("model", kMicrofacet)};

constexpr Kind kEdgeUm = Number{{.low = 0.0}};
constexpr Row kSurfaceRows[] = {
    {"dihedral_error_arcmin", Number{kAngleError}, 0.0, "Error of the apex angle. It is added to `apex_angle_deg`.",
     kErrorOfPrism, kZeroIsNone},
    {"dihedral_error_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "Errors of the dihedral angles: one number for all dihedral edges, or a list of three numbers for the edges at "
     "the azimuths 0, 120 and 240 degrees.",
     kErrorOfCube, kZeroIsNone},
    {"dihedral_error_arcsec", NumberOrNumbers{kAngleErrorArcsec}, kNone,
     "Errors of the dihedral angles in arc seconds, instead of `dihedral_error_arcmin`. One number or three numbers.",
     kArcsecOfCube},
    {"facet_tilt_arcmin", NumberOrNumbers{kAngleError}, 0.0,
     "Tilts of the facets; positive tilts open the element. A list with one number for each facet, or 0 for no tilts. "
     "Prisms: the facets towards -x and +x. Cube corners: the facets between the edges at 0 and 120, 120 and 240, 240 "
     "and 360 degrees.",
     kErrors, kZeroIsNone},
    {"angle_error_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, 0.0,
     "Standard deviation of random tilts, which are added to all other angle errors. Only for finite parts. The random "
     "tilts of all facets of all elements are Gaussian and independent.",
     kErrors, kZeroIsNone},
    {"angle_error_seed", Integer{{.low = 0.0, .high = 4294967295.0}}, 1.0, "Seed of the random tilts.", kErrors},
    {"walls", Word{kWalls}, "smooth",
     "Model of the walls between elements and along the border. `\"absorbing\"`: these walls absorb all light."},
    {"model", Word{kModels}, "height_map", "Scatter model of rough facets.", kModelOfMap},
    {"model", Word{kModels}, Computed{"`\"harvey_shack\"` with roughness or waviness, otherwise `\"smooth\"`"},
     "Scatter model of rough facets.", kModelOfOthers},
    {"abg_a", Number{{.low = 0.0, .low_included = false, .high = 1e6}}, kRequired,
     "Parameter A, per sr, of the scatter model BSDF = A / (B + \\|dbeta\\|^g).", kAbgOnly},
    {"abg_b", Number{{.low = 1e-12, .high = 1e6}}, kRequired,
     "Parameter B of the scatter model that is given at `abg_a`.", kAbgOnly},
    {"abg_g", Number{{.low = 1e-3, .high = 100.0}}, kRequired,
     "Parameter g of the scatter model that is given at `abg_a`.", kAbgOnly},
    {"height_map", File{"the file of a measured map"}, kRequired,
     "Measured height map, in a format that `retrace metrology` reads. It has at least 8 x 8 and at most 4,194,304 "
     "points.",
     kMapOnly},
    renamed("height_map_level_axis", Row{"height_map_horizontal_axis", Word{kAxes}, "x",
                                         "Axis of the map that is horizontal on a facet. On a prism, the horizontal "
                                         "direction is parallel to the roof edge.",
                                         kMapOnly}),
    {"height_map_form", Word{kForms}, "plane",
     "Form that is subtracted from the map: its best-fit plane or polynomial of the given degree.", kMapOnly},
    {"slope_distribution", Word{kSlopeDistributions}, "beckmann", "Distribution of the slopes of the microfacets.",
     kMicrofacetOnly},
    {"roughness_sq_nm", Number{kHeight}, 0.0, "Rms height of the roughness, for `harvey_shack`."},
    {"correlation_length_um", Number{kLength}, 0.0,
     "Length at which the Gaussian autocorrelation of the roughness is 1/e. It is required together with "
     "`roughness_sq_nm`."},
    {"correlation_length_down_um", Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     Computed{"`correlation_length_um`"},
     "Correlation length in the direction down the facet, for roughness with a lay, such as feed marks. "
     "`correlation_length_um` is then the horizontal correlation length, which on a prism is parallel to the roof "
     "edge."},
    {"waviness_sq_nm", Number{kHeight}, 0.0, "Rms height of the waviness, for `harvey_shack` and `microfacet`."},
    {"waviness_length_um", Number{kLength}, 0.0,
     "Period of the waviness. It is required together with `waviness_sq_nm`."},
    {"root_radius_um", kEdgeUm, 0.0,
     "Radius of the roots, the lines where facets of one element meet. It is at most a quarter of the base, or a tenth "
     "of the aperture.",
     kErrors, kZeroIsNone},
    {"root_chamfer_um", kEdgeUm, 0.0,
     "Width of the flat that replaces each root, measured across the root. Not together with a radius.", kErrors,
     kZeroIsNone},
    {"rim_radius_um", kEdgeUm, 0.0,
     "Radius of the rims, the lines where an element meets its neighbours or flat land. It is at most a quarter of the "
     "base, or a tenth of the aperture.",
     kErrors, kZeroIsNone},
    {"rim_chamfer_um", kEdgeUm, 0.0,
     "Width of the flat that replaces each rim, measured across the rim. Not together with a radius.", kErrors,
     kZeroIsNone},
    {"edge_chords", Integer{{.low = 4.0, .high = 64.0}}, 16.0,
     "Number of plane strips that approximate the rounding of an edge, from one facet to the other.", kErrors}};

constexpr Row kScratchRows[] = {
    {"facet", Word{kFacets}, kRequired, "Facet with the scratch, named by the direction that the facet faces."},
    {"position_um", Number{}, kRequired,
     "Position of the centre of the scratch along the roof edge, measured from the centre of the element towards +y."},
    {"width_um", Number{{.low = 0.01, .high = 100.0}}, kRequired,
     "Width of the scratch, measured across it; it must be less than the width of the element."},
    {"depth_um", Number{}, kRequired,
     "Depth of the scratch, measured into the part along the normal of the facet; at most half of the width; a "
     "negative value is a ridge."}};

constexpr NumberRange kPower{.low = 0.0, .high = 8.0};
constexpr NumberRange kFormHeight{.low = -100.0, .high = 100.0};
constexpr Condition kWithFormMap[] = {is_given("map")};
constexpr Row kFormRows[] = {
    {"sink_um", Number{kFormHeight}, 0.0,
     "Sag of a facet: distance by which the centroid of the facet is displaced into the body, relative to the corner "
     "farthest from it. The facet is a paraboloid. A negative value is a bulge. The best-fit plane is subtracted."},
    {"map", File{"the file of a measured map"}, kNone,
     "Measured height map of a facet, in a format that `retrace metrology` reads. The centre of the map is placed at "
     "the centroid of the facet. A polynomial is fitted to the heights. The best-fit plane of the polynomial over the "
     "facet is subtracted."},
    renamed("map_level_axis", Row{"map_horizontal_axis", Word{kAxes}, "x",
                                  "Axis of the map that is horizontal on a facet.", kWithFormMap}),
    {"map_degree", Integer{{.low = 2.0, .high = 8.0}}, 4.0, "Degree of the polynomial that is fitted to the map.",
     kWithFormMap}};
constexpr Row kFormTermRows[] = {
    renamed("level", Row{"x_power", Integer{kPower}, kRequired, "Power of the horizontal coordinate of the facet."}),
    renamed("down", Row{"y_power", Integer{kPower}, kRequired,
                        "Power of the coordinate down the facet; the sum of both powers is at most 8."}),
    {"height_um", Number{kFormHeight}, kRequired,
     "Coefficient: height of the term, positive out of the body, where both coordinates equal the radius of the "
     "facet."}};

constexpr Row kIdealisationRows[] = {
    {"facets", Word{kFacetModels}, "real",
     "Model of the retro facets. `\"mirror\"`: the facets reflect all light at every angle."},
    {"entrance", Word{kEntranceModels}, "real",
     "Model of the entrance face. `\"lossless\"`: the face refracts and transmits all light. Light that reaches it "
     "from inside beyond the critical angle is not traced further."}};

}  // namespace

std::span<const Row> body_rows() {
  return kBodyRows;
}
std::span<const Row> shell_rows() {
  return kShellRows;
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

}  // namespace retrace::design
