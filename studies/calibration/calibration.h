#pragma once

// From what was measured of parts that a machine cut to what the machine is like. The study behind `retrace calibrate`.

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/file_texts.h"
#include "core/warning.h"
#include "fabrication/machine/setup.h"
#include "studies/calibration/estimate.h"
#include "studies/calibration/measured_facets.h"

namespace retrace::studies {

/// A measurement that the others contradict.
struct Outlier {
  Measurement measurement;
  double deviations = 0.0;  ///< by which it misses what the others say, in the standard deviations of that
};

/// Parts that a machine cut, and what was measured of them.
struct MeasuredParts {
  std::string file;               ///< of the measurements, for messages
  std::vector<std::string> jobs;  ///< as the file has them
  std::vector<FabricationResult> plans;
  /// Of parts that are maps of one part, all of the first plan: what each shows of the blank's face. Empty: parts are
  /// measured against that face.
  std::vector<std::optional<FaceFigures>> map_faces;
  std::vector<Measurement> measurements;
  std::size_t empty_rows = 0;  ///< that have no value yet

  std::size_t parts() const { return map_faces.empty() ? plans.size() : map_faces.size(); }
  const FabricationResult& plan_of(std::size_t part) const { return map_faces.empty() ? plans[part] : plans.front(); }
};

/// What a quantity of the set-up is.
struct CalibratedQuantity {
  const fabrication::SetupQuantity* quantity = nullptr;
  bool is_told = false;
  double value = 0.0;        ///< um or arcsec, from what the job's machine has; of one that is not told: one of many
  double uncertainty = 0.0;  ///< standard; of one that is not told: of what is told of it
};

struct Calibration {
  MeasuredParts parts;           ///< without outliers
  fabrication::Machine machine;  ///< the calibrated one
  std::vector<CalibratedQuantity> quantities;
  Eigen::MatrixXd covariance;       ///< in their order
  std::vector<std::string> untold;  ///< combinations that the measurements do not tell apart, in words
  std::vector<double> residuals;    ///< in standard uncertainties
  std::vector<Outlier> outliers;    ///< left out, the worst first
  double chi_square = 0.0;
  std::size_t freedom = 0;  ///< measurements less what is estimated
  Warnings warnings;
};

/// A combination of the set-up that is less certain than this, in um or arcsec, counts as untold: one sees as much with
/// a dial gauge.
inline constexpr double kSetUpByEye = 100.0;

/// The combinations of the set-up that an estimate leaves untold, in words: "-0.707 c_lean_x_arcsec + a_lean_y_arcsec".
std::vector<std::string> untold_words(const Estimate& estimate, fabrication::Tilt tilt);

/// The parts of measurements, as Measurement::part counts them, each with the elements that are measured.
std::vector<CutPart> cut_parts(const MeasuredParts& measured);

/// Estimates the set-up by Gauss-Newton steps. Outliers are removed one by one: measurements that deviate from the fit
/// by more than chance explains (data snooping: W. Baarda, A testing procedure for use in geodetic networks, 1968).
/// \throw InputError, which names the lines, if too many measurements contradict each other. It is also thrown if all
///        measurements of one quantity of a facet are outliers, because their sign is then probably wrong
Calibration calibrate(MeasuredParts parts);

}  // namespace retrace::studies
