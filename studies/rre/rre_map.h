#pragma once

// Polar maps: RRE over a grid of incidences and azimuths.

#include <cstddef>
#include <span>
#include <vector>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// RRE of one design and acceptance cone at all combinations of incidences and azimuths.
struct RreMap {
  std::size_t design = 0;
  double acceptance_half_angle_deg = 0.0;
  std::vector<double> incidence_deg;  ///< at least 2, ascending, each >= 0 and < 90
  std::vector<double> azimuth_deg;    ///< at least 3, ascending, each >= 0 and < 360
  std::vector<double> rre;            ///< fractions; all incidences of the first azimuth, then of the next one
  std::vector<double> std_error;      ///< as `rre`

  std::size_t index(std::size_t incidence, std::size_t azimuth) const {
    return azimuth * incidence_deg.size() + incidence;
  }
  /// Returns the values of one azimuth, with one value for each incidence.
  /// \param values `rre` or `std_error`
  std::span<const double> row(const std::vector<double>& values, std::size_t azimuth) const {
    return std::span(values).subspan(index(0, azimuth), incidence_deg.size());
  }
  /// Returns values with the indices [azimuth][incidence].
  /// \param values `rre` or `std_error`
  std::vector<std::vector<double>> rows(const std::vector<double>& values) const;
  /// Returns RRE at any direction, by linear interpolation between the four surrounding directions of the grid. NaN if
  /// the incidence is outside the grid.
  double at(double incidence, double azimuth) const;
  /// Returns the mean of RRE over all azimuths at an incidence of the grid.
  double mean_at(std::size_t incidence) const;
  /// Returns the mean of RRE over all directions between the first and the last incidence, by solid angle. Between
  /// incidences, RRE is interpolated linearly.
  double mean() const;
};

/// Replaces empty lists of angles by the default grid of a polar map, and checks other lists. Azimuths are reduced to
/// [0, 360) degrees. Both lists are sorted, and repeated values are removed.
/// \throw InputError at `incidence_deg` or `azimuth_deg` if the list is not suitable for a map
void resolve_grid(RreSettings& settings);

/// Returns the maps of a result: for each design, one for each acceptance cone. Empty unless has_complete_maps().
std::vector<RreMap> rre_maps(const RreResult& result);

/// Returns the map with the differences b - a. Its standard errors are those of the differences.
/// \pre both maps have the same grid
RreMap difference(const RreMap& a, const RreMap& b);

}  // namespace retrace::studies
