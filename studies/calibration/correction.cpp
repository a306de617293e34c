#include "studies/calibration/correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "studies/calibration/linear_model.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Eigen::Index;

/// Sets the maximum deviation in `outlook` to the absolute value of `value` if the latter is larger.
void take(DeviationPrediction& outlook, FacetQuantity what, double value) {
  double& most = what == FacetQuantity::distance ? outlook.distance_nm : outlook.tilt_arcsec;
  most = std::max(most, std::abs(value));
}

/// Sets the maximum deviations of the facets before and after correction.
void tell_outlooks(Correction& result) {
  const MeasuredParts& measured = result.calibration.parts;
  const std::vector<CutPart> parts = cut_parts(measured);
  const Machine& machine = result.calibration.machine;
  const LinearModel model = linear_model(parts, measured.measurements, machine, measured.map_faces);
  const Eigen::MatrixXd spread =
      model.setup_jacobian * result.calibration.covariance * model.setup_jacobian.transpose();
  for (std::size_t k = 0; k < measured.measurements.size(); ++k) {
    const Measurement& m = measured.measurements[k];
    const auto at = static_cast<Index>(k);
    take(result.before, m.what, parts[m.part].predicted(m, machine, {}));
    take(result.after, m.what, 2.0 * std::sqrt(std::max(0.0, spread(at, at))) * m.uncertainty);
  }
}

/// Sets the waves and marks that facets of all maps have in common, and adds warnings about them.
void tell_rests(Correction& result, double feed_mm_per_min) {
  std::vector<FacetResiduals> rests;
  for (const RegisteredMap& map : result.registered)
    rests.insert(rests.end(), map.residuals.begin(), map.residuals.end());
  result.facets = rests.size();
  result.waves = common_waves(rests, feed_mm_per_min);
  result.marks = common_marks(rests);
  for (const FacetWave& wave : result.waves)
    result.calibration.warnings.push_back(
        {"waves_not_corrected",
         fmt::format("{}: waves are not corrected. {}", description_of(wave, result.facets),
                     wave.is_along_edge ? "They come from the tool's edge"
                                        : "Look for a drive or a spindle that runs at their frequency")});
  for (const FacetMark& mark : result.marks)
    result.calibration.warnings.push_back(
        {"marks_not_corrected",
         fmt::format("{}: marks are not corrected. {}", description_of(mark),
                     mark.is_of_edge ? "Most facets with this position have the mark, so the tool's edge causes it"
                                     : "The facets are measured next to the mark")});
}

}  // namespace

std::string description_of(const FacetWave& wave, std::size_t facets) {
  return fmt::format(
      "waves {}, {} um long, amplitude {} nm{}, on {} of {} facets",
      wave.is_along_edge ? "along the edge" : "up the facets", fixed(wave.length_um, 1), fixed(wave.amplitude_nm, 1),
      wave.frequency_hz ? fmt::format(", {} Hz", fixed(*wave.frequency_hz, 2)) : "", wave.facets.size(), facets);
}

std::string description_of(const FacetMark& mark) {
  return fmt::format("{}{} {} nm {}, {} um wide, {} um {}, on {} of {} facets measured at this position",
                     mark.is_of_edge ? (mark.height_nm > 0.0 ? "a chip of the edge: " : "a bulge of the edge: ") : "",
                     mark.height_nm > 0.0 ? "a ridge" : "a groove", fixed(std::abs(mark.height_nm), 1),
                     mark.height_nm > 0.0 ? "high" : "deep", fixed(mark.width_um, 1), fixed(mark.position_um, 1),
                     mark.is_along_cut ? "along the edge from its centre" : "up the facet", mark.facets.size(),
                     mark.facets_covering);
}

Correction correct(const FabricationResult& plan, std::vector<FacetMap> maps) {
  Correction result;
  MeasuredParts measured;
  measured.file = plan.job.source;
  measured.plans = {plan};
  for (std::size_t k = 0; k < maps.size(); ++k) {
    result.registered.push_back(registered(maps[k], plan));
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
          {"blank_face_not_visible",
           fmt::format(
               "the map {} contains too little of the blank's face to determine errors that shift all facets equally",
               result.maps[k].file)});
  tell_outlooks(result);
  tell_rests(result, plan.job.process.finishing_feed_mm_per_min);
  return result;
}

}  // namespace retrace::studies
