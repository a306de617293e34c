#pragma once

// Photometers for the colour matching functions x, y and z. Their readings are combined to the red, green and blue of a
// reflection table.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "raytrace/observers/disc_means.h"
#include "requests/part.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

/// Number of spectral intervals into which each colour matching function is divided. Each interval is represented by
/// two wavelengths.
inline constexpr std::size_t kIntervalsPerFunction = 2;
/// Index of the response of the eye, which is y.
inline constexpr auto kEyeResponse = static_cast<std::size_t>(PhotometricResponse::y_bar);

raytrace::PhotometricApertures apertures_of(const MaterialRequest& request);

/// Returns the settings of the photometer for the table.
/// \param back value of ReflectionTable::back
PhotometrySettings photometry_of(const MaterialRequest& request, const geometry::Vec2& back);

/// Returns a photometer for the response x, y or z. The photometer ignores light that the entrance face reflects
/// specularly, because this light does not return to the source.
/// \param parts number of spectral intervals, see kIntervalsPerFunction
Photometer photometer_of(const design::Design& design, const PhotometrySettings& request, std::size_t response,
                         std::size_t parts);

/// Far fields for one direction of light.
struct ColourFields {
  std::array<std::vector<Photometer::WeightedField>, 3> by_response;  ///< far fields for the responses x, y and z
  /// All fields of `by_response`, with their weights in red, green and blue.
  std::vector<raytrace::BandedField> weighted;
};

/// Photometers for the responses x, y and z.
class ColourPhotometer {
 public:
  ColourPhotometer(const design::Design& design, const PhotometrySettings& photometry);

  const Photometer& eye() const { return instruments_[kEyeResponse]->photometer; }
  /// Computes the far fields for one direction of light. Returns nothing if the computation was cancelled.
  std::optional<ColourFields> fields(const geometry::Vec3& to_source, const Cancellation* cancel) const;

 private:
  /// Photometer for one of the responses, and its beam tracer.
  struct Instrument {
    explicit Instrument(Photometer of_response)
        : photometer(std::move(of_response)), tracer(photometer.make_tracer()) {}

    Photometer photometer;
    raytrace::BeamTracer tracer;
  };

  std::array<std::unique_ptr<Instrument>, 3> instruments_;
  Eigen::Matrix3d rgb_of_fractions_;
};

}  // namespace retrace::studies
