#include "studies/calibration/correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/calibration/linear_model.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Eigen::Index;

void take(FacetOutlook& outlook, FacetQuantity what, double value) {
  double& most = what == FacetQuantity::distance ? outlook.distance_nm : outlook.tilt_arcsec;
  most = std::max(most, std::abs(value));
}

/// How far facets are off at most, and how uncertain that is.
void tell_outlooks(Correction& result) {
  const MeasuredParts& measured = result.calibration.parts;
  const std::vector<CutPart> parts = cut_parts(measured);
  const Machine& machine = result.calibration.machine;
  const LinearModel model = linear_model(parts, measured.measurements, machine, measured.map_faces);
  const Eigen::MatrixXd spread = model.of_setup * result.calibration.covariance * model.of_setup.transpose();
  for (std::size_t k = 0; k < measured.measurements.size(); ++k) {
    const Measurement& m = measured.measurements[k];
    const auto at = static_cast<Index>(k);
    take(result.before, m.what, parts[m.part].predicted(m, machine, {}));
    take(result.after, m.what, 2.0 * std::sqrt(std::max(0.0, spread(at, at))) * m.uncertainty);
  }
}

}  // namespace

Correction correct(const FabricationResult& plan, std::vector<FacetMap> maps) {
  const std::vector<Groove> grooves = designed_grooves(plan.job);
  Correction result;
  MeasuredParts measured;
  measured.file = plan.job.source;
  measured.plans = {plan};
  for (std::size_t k = 0; k < maps.size(); ++k) {
    result.registered.push_back(registered(maps[k], grooves));
    measured.map_faces.push_back(result.registered.back().face);
    measured.jobs.push_back(maps[k].file);
    for (Measurement m : result.registered.back().figures) {
      m.part = k;
      measured.measurements.push_back(m);
    }
  }
  result.maps = std::move(maps);
  result.calibration = calibrate(std::move(measured));
  for (std::size_t k = 0; k < result.maps.size(); ++k)
    if (!result.registered[k].face)
      result.calibration.warnings.push_back(
          fmt::format("{} shows too little of the blank's face: what shifts all that it shows alike is not told by it",
                      result.maps[k].file));
  tell_outlooks(result);
  return result;
}

}  // namespace retrace::studies
