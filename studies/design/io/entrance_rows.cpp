#include "studies/design/io/design_rows.h"

namespace retrace::studies {
namespace {

using namespace schema;

constexpr NumberRange kShare{.low = 0.0, .high = 1.0};
constexpr NumberRange kSpreadDeg{.low = 0.01, .high = 45.0};
constexpr NumberRange kThickUm{.low = 0.0, .low_included = false, .high = 1e6};

constexpr Row kEntranceFaceRows[] = {
    {"film_coverage", Number{kShare}, 0.0, "Fraction of the face under an even film of water; 1 is the whole face."},
    {"water_index", Number{{.low = 1.0, .high = 2.0}}, 1.333,
     "Refractive index of the film and the drops, relative to air."},
    {"drop_coverage", Number{kShare}, 0.0, "Fraction of the face under drops, which are spherical caps."},
    {"drop_contact_angle_deg", Number{{.low = 1.0, .high = 90.0}}, kNone,
     "Angle between the surface of a drop and the face, at the rim of the drop. It is required together with "
     "`drop_coverage`."},
    {"dust_coverage", Number{kShare}, 0.0, "Fraction of the face under dust."},
    {"dust_albedo", Number{kShare}, kNone,
     "Fraction of the light on the dust that is scattered, evenly by Lambert's law; the rest is absorbed. It is "
     "required together with `dust_coverage`."},
    {"dust_forward_share", Number{kShare}, kNone,
     "Fraction of the light scattered by dust that goes on to the other side of the dust. It is required together with "
     "`dust_coverage`."},
    {"scratch_coverage", Number{kShare}, 0.0, "Fraction of the face under fine scratches."},
    {"scratch_spread_deg", Number{kSpreadDeg}, kNone,
     "Angle in air, across a scratch, at which the Gaussian lobe of the deflected light falls to 1/e. It is required "
     "together with `scratch_coverage`."},
    {"scratch_azimuth_deg", Number{kAzimuth}, Computed{"all directions equally"},
     "Direction of the scratches, from +x towards +y."},
    {"haze", Number{kShare}, 0.0,
     "Fraction of the light passing the face along its normal that is deflected by more than 2.5 degrees in air, as "
     "defined by ASTM D1003."},
    {"haze_spread_deg", Number{kSpreadDeg}, kNone,
     "Angle in air, in all directions, at which the Gaussian lobe of the haze falls to 1/e. It is required together "
     "with `haze`."},
    {"roughness_sq_nm", Number{{.low = 0.0, .high = 1e5}}, 0.0, "Rms height of the roughness of the face itself."},
    {"correlation_length_um", Number{{.low = 0.0, .high = 1e6}}, 0.0,
     "Length at which the Gaussian autocorrelation of this roughness is 1/e. It is required together with "
     "`roughness_sq_nm`."}};

constexpr Row kThickLayerRows[] = {
    {"refractive_index", Number{{.low = 1.0, .high = 4.0}}, kRequired, "Refractive index relative to air."},
    {"thickness_um", Number{kThickUm}, kRequired,
     "Thickness, much larger than the coherence length of the light; it affects only the absorption."},
    {"absorption_per_mm", Number{{.low = 0.0}}, 0.0, "Napierian absorption coefficient, for power."}};

}  // namespace

std::span<const Row> entrance_face_rows() {
  return kEntranceFaceRows;
}
std::span<const Row> thick_layer_rows() {
  return kThickLayerRows;
}

}  // namespace retrace::studies
