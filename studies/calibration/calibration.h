#pragma once

// Study of the command `retrace calibrate`: estimates the errors of a machine from measurements of parts that it cut.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compute/estimation/least_squares.h"
#include "core/file_texts.h"
#include "core/warning.h"
#include "fabrication/machine/setup.h"
#include "studies/calibration/measured_facets.h"

namespace retrace::studies {

/// Measurement that contradicts the other measurements.
struct Outlier {
  Measurement measurement;
  double deviations = 0.0;  ///< deviation from the fit, in standard deviations
};

/// Parts that a machine cut, and their measurements. There are two kinds of input:
/// - A table of measurements, in which heights are relative to the face of the blank. Each part has its own plan.
/// - Height maps of one part. Each map counts as a part, because the pose of the part differs from map to map. All maps
///   have the same plan.
struct MeasuredParts {
  std::string file;                      ///< name of the table, or of the job for height maps, for messages
  std::vector<std::string> jobs;         ///< name of each job as given in the table, or name of each height map
  std::vector<FabricationResult> plans;  ///< plan of each job
  /// Height and tilts of the blank's face in each height map, where the map shows the face. Empty for a table.
  std::vector<std::optional<FaceFigures>> map_faces;
  std::vector<Measurement> measurements;
  std::size_t empty_rows = 0;  ///< number of rows without a value

  std::size_t parts() const { return map_faces.empty() ? plans.size() : map_faces.size(); }
  const FabricationResult& plan_of(std::size_t part) const { return map_faces.empty() ? plans[part] : plans.front(); }
};

/// Estimate of a quantity of the set-up: an error of an axis or of the tool.
struct CalibratedQuantity {
  const fabrication::SetupQuantity* quantity = nullptr;
  bool is_observable = false;  ///< true if the measurements determine the value of the quantity
  /// Estimated difference of the real machine from the machine file of the job, in um or arcsec. If is_observable is
  /// false, the measurements do not determine this difference.
  double value = 0.0;
  /// Standard uncertainty of `value`. If is_observable is false, it covers only the observable part of the quantity.
  double uncertainty = 0.0;
};

struct Calibration {
  MeasuredParts parts;           ///< measurements without outliers
  fabrication::Machine machine;  ///< calibrated machine: the machine of the job with the estimated errors
  std::vector<CalibratedQuantity> quantities;
  Eigen::MatrixXd covariance;             ///< covariance matrix, in the order of the quantities
  std::vector<std::string> unobservable;  ///< unobservable combinations, as text
  std::vector<double> residuals;          ///< residuals in standard uncertainties
  std::vector<Outlier> outliers;          ///< removed measurements, the worst first
  double chi_square = 0.0;
  std::size_t degrees_of_freedom =
      0;  ///< degrees of freedom: number of measurements minus number of estimated unknowns
  Warnings warnings;
};

/// Maximum uncertainty, in um or arcsec, of a combination that counts as observable. Errors of a set-up with a dial
/// gauge are smaller than this value.
inline constexpr double kMaxObservableUncertainty = 100.0;

/// Returns the unobservable combinations of an estimate as text, such as "-0.707 c_lean_x_arcsec + a_lean_y_arcsec".
std::vector<std::string> unobservable_texts(const compute::LeastSquaresEstimate& estimate, fabrication::Tilt tilt);

/// Returns the measured parts, in the order of Measurement::part, with their measured elements.
std::vector<CutPart> cut_parts(const MeasuredParts& measured);

/// Estimates the set-up by Gauss-Newton steps. Measurements that deviate significantly from the fit are removed one by
/// one as outliers (data snooping: W. Baarda, A testing procedure for use in geodetic networks, 1968).
/// \throw InputError, which names the lines, if too many measurements contradict each other. It is also thrown if all
///        measurements of one quantity of a facet are outliers, because their sign is then probably wrong
Calibration calibrate(MeasuredParts parts);

}  // namespace retrace::studies
