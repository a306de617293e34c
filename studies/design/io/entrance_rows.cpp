#include "studies/design/io/design_rows.h"

namespace retrace::studies {
namespace {

using namespace schema;

constexpr NumberRange kShare{.low = 0.0, .high = 1.0};
constexpr NumberRange kSpreadDeg{.low = 0.01, .high = 45.0};
constexpr NumberRange kThickUm{.low = 0.0, .low_included = false, .high = 1e6};

constexpr Row kEntranceFaceRows[] = {
    {"film_coverage", Number{kShare}, 0.0, "Share of the face under an even film of water; 1: all of it."},
    {"water_index", Number{{.low = 1.0, .high = 2.0}}, 1.333, "Of film and drops, relative to air."},
    {"drop_coverage", Number{kShare}, 0.0, "Share of the face under drops, which are caps of spheres."},
    {"drop_contact_angle_deg", Number{{.low = 1.0, .high = 90.0}}, kNone,
     "Between the surface of a drop and the face, at its rim; required together with `drop_coverage`."},
    {"dust_coverage", Number{kShare}, 0.0, "Share of the face under dust."},
    {"dust_albedo", Number{kShare}, kNone,
     "Share of the light on the dust that it scatters, evenly by Lambert's law; the rest is absorbed. Required "
     "together with `dust_coverage`."},
    {"dust_forward_share", Number{kShare}, kNone,
     "Of the light that dust scatters: what goes on to its other side. Required together with `dust_coverage`."},
    {"scratch_coverage", Number{kShare}, 0.0, "Share of the face under fine scratches."},
    {"scratch_spread_deg", Number{kSpreadDeg}, kNone,
     "To where light is thrown across a scratch, in air: where the Gaussian lobe falls to 1/e. Required together with "
     "`scratch_coverage`."},
    {"scratch_azimuth_deg", Number{kAzimuth}, Computed{"all directions alike"},
     "Where scratches run to, from +x towards +y."},
    {"haze", Number{kShare}, 0.0,
     "Share of the light that passes the face along its normal and is thrown off by more than 2.5 degrees in air, as "
     "ASTM D1003 has it."},
    {"haze_spread_deg", Number{kSpreadDeg}, kNone,
     "Of that light, as `scratch_spread_deg`, all round. Required together with `haze`."},
    {"roughness_sq_nm", Number{{.low = 0.0, .high = 1e5}}, 0.0, "Rms height of the face's own roughness."},
    {"correlation_length_um", Number{{.low = 0.0, .high = 1e6}}, 0.0,
     "Where the Gaussian autocorrelation of that roughness is 1/e; required together with `roughness_sq_nm`."}};

constexpr Row kThickLayerRows[] = {
    {"refractive_index", Number{{.low = 1.0, .high = 4.0}}, kRequired, "Relative to air."},
    {"thickness_um", Number{kThickUm}, kRequired,
     "Much more than light is coherent over; matters to absorption alone."},
    {"absorption_per_mm", Number{{.low = 0.0}}, 0.0, "Napierian, for power."}};

}  // namespace

std::span<const Row> entrance_face_rows() {
  return kEntranceFaceRows;
}
std::span<const Row> thick_layer_rows() {
  return kThickLayerRows;
}

}  // namespace retrace::studies
