#include "studies/appearance/colour_photometer.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>

#include "materials/chromaticity.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/observers/coefficients.h"
#include "studies/photometry/colour.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

/// Returns the matrix that converts X, Y, Z to linear red, green, blue. It is the inverse of the matrix whose columns
/// are the primaries of IEC 61966-2-1 (ITU-R BT.709). The primaries are scaled so that the colour of the light becomes
/// 1, 1, 1.
Eigen::Matrix3d rgb_from_xyz(const materials::Tristimulus& white) {
  Eigen::Matrix3d primaries;
  primaries << 0.64, 0.30, 0.15, 0.33, 0.60, 0.06, 0.03, 0.10, 0.79;
  const Eigen::Vector3d brightness = primaries.inverse() * Eigen::Vector3d(white[0], white[1], white[2]) / white[1];
  return (primaries * brightness.asDiagonal()).inverse();
}

}  // namespace

raytrace::PhotometricApertures apertures_of(const MaterialRequest& request) {
  return {Angle::from_deg(request.source_arcmin / 60.0), Angle::from_deg(request.receiver_arcmin / 60.0)};
}

PhotometrySettings photometry_of(const MaterialRequest& request, const Vec2& back) {
  PhotometrySettings photometry;
  photometry.apertures = apertures_of(request);
  // The window is a disc about the direction to the source that contains the corners of the square range of views. The
  // cosine accounts for oblique incidence.
  photometry.window_deg =
      std::numbers::sqrt2 * request.window_deg / std::cos(Angle::from_deg(request.entrance_deg).rad());
  if (back != Vec2::Ones()) photometry.window_deg += 2.0 * request.entrance_deg;
  photometry.light = PhotometricLight::illuminant_d65;
  photometry.engine = raytrace::Engine::exact;
  return photometry;
}

Photometer photometer_of(const design::Design& design, const PhotometrySettings& request, std::size_t response,
                         std::size_t parts) {
  Photometer photometer(design, request_of_response(request, response), parts,
                        static_cast<PhotometricResponse>(response));
  photometer.ignore_mirror_image();
  return photometer;
}

ColourPhotometer::ColourPhotometer(const design::Design& design, const PhotometrySettings& photometry) {
  for (std::size_t response = 0; response < instruments_.size(); ++response)
    instruments_[response] =
        std::make_unique<Instrument>(photometer_of(design, photometry, response, kIntervalsPerFunction));
  const materials::SpectralCurve lamp = lamp_power(photometry.light);
  const materials::Tristimulus sent = materials::tristimulus(lamp, materials::shipped_colour_matching());
  // Readings of a photometer are relative to its response to the incident light, which is `sent`. The matrix therefore
  // multiplies the readings by `sent`.
  rgb_of_fractions_ = rgb_from_xyz(sent) * Eigen::Vector3d(sent[0], sent[1], sent[2]).asDiagonal() / sent[1];
}

std::optional<ColourFields> ColourPhotometer::fields(const Vec3& to_source, const Cancellation* cancel) const {
  ColourFields fields;
  const Angle entrance = Angle::from_rad(std::acos(to_source.z()));
  for (std::size_t response = 0; response < instruments_.size(); ++response) {
    const Instrument& with = *instruments_[response];
    auto found = with.photometer.far_fields(to_source, with.tracer, cancel);
    if (!found) return std::nullopt;
    fields.by_response[response] = *std::move(found);
    for (const Photometer::WeightedField& one : fields.by_response[response]) {
      raytrace::BandedField& weighed = fields.weighted.emplace_back();
      weighed.field = &one.field;
      for (std::size_t band = 0; band < weighed.weights.size(); ++band)
        weighed.weights[band] =
            rgb_of_fractions_(static_cast<Eigen::Index>(band), static_cast<Eigen::Index>(response)) *
            raytrace::coefficient_of_retroreflection(one.weight, entrance);
    }
  }
  return fields;
}

}  // namespace retrace::studies
