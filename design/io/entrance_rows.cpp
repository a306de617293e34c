#include "design/io/design_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr NumberRange kFraction{.low = 0.0, .high = 1.0};
constexpr NumberRange kSpreadDeg{.low = 0.01, .high = 45.0};
constexpr NumberRange kThickUm{.low = 0.0, .low_included = false, .high = 1e6};

constexpr Row kEntranceFaceRows[] = {
    {"film_coverage", Number{kFraction}, 0.0,
     "Fraction of the entrance face that is covered by a uniform film of water. 1 is the whole face."},
    {"water_index", Number{{.low = 1.0, .high = 2.0}}, 1.333,
     "Refractive index of the film and of the drops, relative to air."},
    {"drop_coverage", Number{kFraction}, 0.0,
     "Fraction of the entrance face that is covered by water drops. The drops are spherical caps."},
    {"drop_contact_angle_deg", Number{{.low = 1.0, .high = 90.0}}, kNone,
     "Angle between the surface of a drop and the face, at the rim of the drop. It is required together with "
     "`drop_coverage`."},
    {"dust_coverage", Number{kFraction}, 0.0, "Fraction of the entrance face that is covered by dust."},
    {"dust_albedo", Number{kFraction}, kNone,
     "Fraction of the light falling on the dust that the dust scatters, with a Lambertian distribution. The dust "
     "absorbs the remaining light. It is required together with `dust_coverage`."},
    renamed("dust_forward_share", Row{"dust_forward_fraction", Number{kFraction}, kNone,
                                      "Fraction of the scattered light that dust scatters forward, to the other side "
                                      "of the dust. It is required together with `dust_coverage`."}),
    {"scratch_coverage", Number{kFraction}, 0.0, "Fraction of the entrance face that is covered by fine scratches."},
    {"scratch_spread_deg", Number{kSpreadDeg}, kNone,
     "Angle in air, perpendicular to a scratch, at which the Gaussian lobe of the deflected light falls to 1/e. It is "
     "required together with `scratch_coverage`."},
    {"scratch_azimuth_deg", Number{kAzimuth}, Computed{"all directions equally"},
     "Azimuth of the direction of the scratches, measured from +x towards +y."},
    {"haze", Number{kFraction}, 0.0,
     "Fraction of the light passing through the entrance face along its normal that is deflected by more than 2.5 "
     "degrees in air, as defined by ASTM D1003."},
    {"haze_spread_deg", Number{kSpreadDeg}, kNone,
     "Angle in air at which the Gaussian lobe of the haze falls to 1/e. The lobe is rotationally symmetric. It is "
     "required together with `haze`."},
    {"roughness_sq_nm", Number{{.low = 0.0, .high = 1e5}}, 0.0, "Rms height of the roughness of the entrance face."},
    {"correlation_length_um", Number{{.low = 0.0, .high = 1e6}}, 0.0,
     "Length at which the Gaussian autocorrelation of the roughness of the entrance face is 1/e. It is required "
     "together with `roughness_sq_nm`."}};

constexpr Row kThickLayerRows[] = {
    {"refractive_index", Number{{.low = 1.0, .high = 4.0}}, kRequired,
     "Refractive index of the layer relative to air."},
    {"thickness_um", Number{kThickUm}, kRequired,
     "Thickness of the layer, much larger than the coherence length of the light; it affects only the absorption."},
    {"absorption_per_mm", Number{{.low = 0.0}}, 0.0, "Napierian absorption coefficient of the layer, for power."}};

}  // namespace

std::span<const Row> entrance_face_rows() {
  return kEntranceFaceRows;
}
std::span<const Row> thick_layer_rows() {
  return kThickLayerRows;
}

}  // namespace retrace::design
