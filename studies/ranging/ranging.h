#pragma once

// Cross sections and range corrections of single cube corners and of arrays of cube corners, for laser ranging.
// `retrace ranging` runs this study.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/design.h"
#include "requests/ranging.h"
#include "studies/ranging/aberration.h"
#include "studies/ranging/array_response.h"
#include "studies/ranging/cube_array.h"
#include "studies/ranging/cube_corner.h"

namespace retrace::studies {

/// Cross sections in m2, separately for each polarisation of the returned light. `parallel` is the component with the
/// polarisation of the transmitted light, and `crossed` is the component with the orthogonal polarisation. Both are
/// empty if the transmitted light is unpolarised.
template <class Value>
struct ByPolarisation {
  Value total = {};
  std::optional<Value> parallel = {};
  std::optional<Value> crossed = {};
};

/// Mean and spread of the cross sections and centroids of single shots.
struct ShotSummary {
  double mean_m2 = 0.0;
  double deviation_m2 = 0.0;  ///< standard deviation of the cross sections
  double min_m2 = 0.0;
  double max_m2 = 0.0;
  double centroid_mean_mm = 0.0;       ///< mean of the centroids of all shots
  double centroid_deviation_mm = 0.0;  ///< standard deviation of the centroids
};
ShotSummary summary_of(const std::vector<Shot>& shots);

/// Result for one wavelength and one direction of light.
struct RangingPoint {
  CubeIndex index;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  /// Cross section of a plane mirror that reflects the whole incident beam to the source. It is 4 pi A^2 /
  /// wavelength^2, where A is the cross-sectional area of the beam. For an array, the sum over all illuminated cubes.
  double mirror_m2 = 0.0;
  ByPolarisation<double> centre;  ///< in the direction exactly towards the source
  std::optional<ByPolarisation<AnnulusStatistics>>
      annulus;                    ///< statistics of the cross section over the annulus of velocity aberration
  double diffracted_power = 0.0;  ///< fraction of the incident power that returns in diffracted beams
  /// Range correction of a single cube, and its usual approximation. Both are empty for arrays.
  std::optional<double> range_correction_mm;
  std::optional<double> usual_range_correction_mm;
  std::size_t lit_cubes = 0;
  std::size_t traced_cubes = 0;  ///< number of traces (LitCubes::traced())
  // The following members are set only for arrays.
  std::vector<CubeEcho> echoes;  ///< light of each illuminated cube towards the receiver
  RangeDistribution ranges;
  PulseResponse response;  ///< response to a pulse; empty for continuous light
  std::vector<Shot> shots;
};

/// Map of the far field of the first point, and cross sections on rings.
struct RangingMap {
  double half_width_rad = 0.0;
  std::size_t points = 0;  ///< number of rows, which is also the number of columns
  /// Cross sections in rows, from the bottom row to the top row. Each row goes from left to right.
  std::vector<ByPolarisation<double>> values;
  std::vector<double> ring_rad;            ///< radii of rings around the direction to the source
  std::vector<AnnulusStatistics> ring_m2;  ///< statistics of the total cross section on each ring
  /// Returns the angle from the direction to the source that belongs to a column or a row of the map.
  double angle_rad(std::size_t number) const;
};

/// Settings of a ranging study, derived from a request.
struct RangingSettings {
  RangingRequest request;
  raytrace::Stokes sent = raytrace::kUnpolarised;
  std::optional<Annulus> annulus;
  /// direction to the receiver for the members `echoes` and `shots` of RangingPoint
  geometry::Vec2 observation_rad = geometry::Vec2::Zero();
  std::vector<ArrayCube> cubes;  ///< empty for a single cube

  bool is_array() const { return !cubes.empty(); }
};

struct RangingResult {
  design::Design design;
  RangingSettings settings;
  double depth_mm = 0.0;  ///< distance from the entrance face to the apex
  double entrance_mm2 = 0.0;
  std::vector<RangingPoint> points;  ///< sorted by wavelength, then by incidence, then by azimuth
  RangingMap map;
  Warnings warnings;
  bool complete = true;
  double elapsed_s = 0.0;
};

/// Ranging study of a design. The constructor checks the design and the request, and run() computes the points.
class RangingStudy {
 public:
  /// \param cubes contents of the file RangingRequest::cubes; empty if the request names no file
  /// \throw InputError if the design is not a single cube corner, or if the request is not allowed
  RangingStudy(design::Design design, const RangingRequest& request, std::vector<ArrayCube> cubes = {});

  RangingResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

 private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

}  // namespace retrace::studies
