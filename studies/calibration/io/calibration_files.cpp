#include "studies/calibration/io/calibration_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

std::string_view word_of(FacetQuantity what) {
  return kFacetQuantityWords[static_cast<std::size_t>(what)];
}

std::string place_of(const MeasuredParts& parts, const Measurement& m) {
  return fmt::format("{}{} of element {}, facet {} of {}", m.line > 0 ? fmt::format("line {}: ", m.line) : "",
                     word_of(m.what), m.at.element, m.at.facet + 1, parts.jobs[m.part]);
}

/// Returns the scatter of the residuals divided by the expected scatter, or 1 if there are no degrees of freedom.
double scatter(const Calibration& result) {
  return result.degrees_of_freedom == 0 ? 1.0
                                        : std::sqrt(result.chi_square / static_cast<double>(result.degrees_of_freedom));
}

void put(Json& json, const Calibration& result) {
  json["machine"] = result.machine.name;
  json["used"] = result.parts.measurements.size();
  json["empty"] = result.parts.empty_rows;
  json["degrees_of_freedom"] = result.degrees_of_freedom;
  json["scatter"] = scatter(result);
  json["quantities"] = Json::array();
  for (const CalibratedQuantity& q : result.quantities)
    json["quantities"].push_back({{"quantity", q.quantity->key},
                                  {"description", q.quantity->description},
                                  {"unit", q.quantity->unit()},
                                  {"observable", q.is_observable},
                                  {"value", q.value},
                                  {"uncertainty", q.uncertainty}});
  json["covariance"] = Json::array();
  for (Eigen::Index k = 0; k < result.covariance.rows(); ++k) {
    Json row = Json::array();
    for (Eigen::Index l = 0; l < result.covariance.cols(); ++l) row.push_back(result.covariance(k, l));
    json["covariance"].push_back(std::move(row));
  }
  json["unobservable"] = result.unobservable;
  json["outliers"] = Json::array();
  for (const Outlier& outlier : result.outliers)
    json["outliers"].push_back({{"line", outlier.measurement.line},
                                {"part", result.parts.jobs[outlier.measurement.part]},
                                {"element", outlier.measurement.at.element},
                                {"facet", outlier.measurement.at.facet + 1},
                                {"what", word_of(outlier.measurement.what)},
                                {"deviations", outlier.deviations}});
}

std::string rows_of(const Calibration& result) {
  std::string text;
  for (const CalibratedQuantity& q : result.quantities)
    text += fmt::format(
        "  {:<38} {}\n", fmt::format("{}, {}", q.quantity->description, q.quantity->unit()),
        q.is_observable ? fmt::format("{:>12} +- {}", fixed(q.value, 3), fixed(q.uncertainty, 3)) : "unobservable");
  for (const std::string& combination : result.unobservable) text += fmt::format("  unobservable: {}\n", combination);
  if (result.degrees_of_freedom > 0)
    text += fmt::format("  scatter of residuals {} times their uncertainties, {} degrees of freedom\n",
                        fixed(scatter(result), 2), result.degrees_of_freedom);
  for (const Outlier& outlier : result.outliers)
    text += fmt::format("  omitted, {} standard uncertainties from the fit: {}\n", fixed(outlier.deviations, 1),
                        place_of(result.parts, outlier.measurement));
  return text;
}

Json facets_of(const std::vector<FacetId>& facets) {
  Json json = Json::array();
  for (const FacetId& at : facets) json.push_back({{"element", at.element}, {"facet", at.facet + 1}});
  return json;
}

void put_rests(Json& json, const Correction& result) {
  json["facets"] = result.facets;
  json["waves"] = Json::array();
  for (const FacetWave& wave : result.waves) {
    Json of_wave = {{"direction", wave.is_along_edge ? "edge" : "cut"},
                    {"length_um", wave.length_um},
                    {"amplitude_nm", wave.amplitude_nm}};
    if (wave.frequency_hz) of_wave["frequency_hz"] = *wave.frequency_hz;
    of_wave["facets"] = facets_of(wave.facets);
    json["waves"].push_back(std::move(of_wave));
  }
  json["marks"] = Json::array();
  for (const FacetMark& mark : result.marks)
    json["marks"].push_back({{"direction", mark.is_along_cut ? "cut" : "edge"},
                             {"of_edge", mark.is_of_edge},
                             {"position_um", mark.position_um},
                             {"height_nm", mark.height_nm},
                             {"width_um", mark.width_um},
                             {"shown", mark.facets_covering},
                             {"facets", facets_of(mark.facets)}});
}

}  // namespace

std::string calibration_json(const Calibration& result) {
  Json json;
  json["measurements"] = result.parts.file;
  json["jobs"] = result.parts.jobs;
  put(json, result);
  return result_text("retrace.calibration/2", std::move(json), result.warnings);
}

std::string calibration_table(const Calibration& result) {
  return fmt::format("{} on machine {}: {} measurements\n", printable(result.parts.file, std::string::npos),
                     printable(result.machine.name), result.parts.measurements.size()) +
         rows_of(result);
}

std::string correction_json(const Correction& result) {
  Json json;
  json["job"] = result.calibration.parts.file;
  json["maps"] = Json::array();
  for (std::size_t k = 0; k < result.maps.size(); ++k) {
    const RegisteredMap& map = result.registered[k];
    const geometry::Vec3& at = map.part_from_map.translation_mm;
    json["maps"].push_back({{"file", result.maps[k].file},
                            {"centre_mm", {at.x(), at.y(), at.z()}},
                            {"rms_nm", map.rms_nm},
                            {"facets", map.figures.size() / 3},
                            {"face", map.face.has_value()}});
  }
  put(json, result.calibration);
  const auto outlook = [](const DeviationPrediction& o) -> Json {
    return {{"distance_nm", o.distance_nm}, {"tilt_arcsec", o.tilt_arcsec}};
  };
  json["before"] = outlook(result.before);
  json["after"] = outlook(result.after);
  put_rests(json, result);
  return result_text("retrace.correction/2", std::move(json), result.calibration.warnings);
}

std::string correction_table(const Correction& result) {
  const Calibration& found = result.calibration;
  std::string text = fmt::format("{} on machine {}: {} height maps\n", printable(found.parts.file, std::string::npos),
                                 printable(found.machine.name), result.maps.size());
  for (std::size_t k = 0; k < result.maps.size(); ++k) {
    const RegisteredMap& map = result.registered[k];
    text += fmt::format("  {:<24} centre at X {} Y {} mm, {} facets{}, rms deviation from the design {} nm\n",
                        printable(result.maps[k].file, std::string::npos),
                        fixed(map.part_from_map.translation_mm.x(), 4), fixed(map.part_from_map.translation_mm.y(), 4),
                        map.figures.size() / 3, map.face ? " and the face" : "", fixed(map.rms_nm, 1));
  }
  text += rows_of(found);
  text += fmt::format("  largest errors of facets               {} nm, {} arcsec\n",
                      fixed(result.before.distance_nm, 1), fixed(result.before.tilt_arcsec, 2));
  text += fmt::format("  largest errors after correction        {} nm, {} arcsec\n", fixed(result.after.distance_nm, 1),
                      fixed(result.after.tilt_arcsec, 2));
  for (const FacetWave& wave : result.waves)
    text += fmt::format("  not corrected: {}\n", description_of(wave, result.facets));
  for (const FacetMark& mark : result.marks) text += fmt::format("  not corrected: {}\n", description_of(mark));
  if (result.waves.empty() && result.marks.empty())
    text += fmt::format("  no other waves or marks on {} facets\n", result.facets);
  return text;
}

std::string residuals_csv(const Calibration& result) {
  CsvWriter table("line,job,element,facet,what,value,uncertainty,residual");
  for (std::size_t k = 0; k < result.residuals.size(); ++k) {
    const Measurement& m = result.parts.measurements[k];
    table.row(m.line, result.parts.jobs[m.part], m.at.element, m.at.facet + 1, word_of(m.what), m.value, m.uncertainty,
              result.residuals[k]);
  }
  return table.text();
}

std::string test_cuts_csv(const TestCuts& cuts) {
  CsvWriter table("job,element,facet,what,value,uncertainty,from_element,from_facet,at,positive");
  std::vector<CutPart> parts;
  for (const FabricationResult& plan : cuts.parts.plans) parts.emplace_back(plan, std::vector<std::size_t>());
  const std::optional<double> none;
  for (const Measurement& m : cuts.parts.measurements)
    table.row(cuts.parts.jobs[m.part], m.at.element, m.at.facet + 1, word_of(m.what), none, m.uncertainty, none, none,
              m.what == FacetQuantity::cut_end ? std::optional(m.along_edge) : none, parts[m.part].positive_sense(m));
  return table.text();
}

std::string test_cuts_json(const TestCuts& cuts) {
  Json json;
  json["machine"] = cuts.parts.plans.front().machine.name;
  json["jobs"] = Json::array();
  for (std::size_t k = 0; k < cuts.jobs.size(); ++k)
    json["jobs"].push_back({{"job", cuts.parts.jobs[k]},
                            {"elements", cuts.jobs[k].elements},
                            {"time_s", cuts.parts.plans[k].plan.time.total_s()}});
  json["measurement_count"] = cuts.parts.measurements.size();
  json["quantities"] = Json::array();
  for (const PlannedQuantity& q : cuts.quantities) {
    Json needs = Json::array();
    for (const std::size_t part : q.needs) needs.push_back(cuts.parts.jobs[part]);
    json["quantities"].push_back({{"quantity", q.quantity->key},
                                  {"description", q.quantity->description},
                                  {"unit", q.quantity->unit()},
                                  {"observable", q.is_observable},
                                  {"uncertainty", q.uncertainty},
                                  {"needs", std::move(needs)}});
  }
  json["unobservable"] = cuts.unobservable;
  return result_text("retrace.test_cuts/2", std::move(json), {});
}

std::string test_cuts_table(const TestCuts& cuts) {
  std::string text = fmt::format("Test cuts for machine {}: {} values to be measured\n",
                                 printable(cuts.parts.plans.front().machine.name), cuts.parts.measurements.size());
  for (std::size_t k = 0; k < cuts.jobs.size(); ++k)
    text += fmt::format("  {:<24} {} prisms, {} s\n", cuts.parts.jobs[k], cuts.jobs[k].elements,
                        fixed(cuts.parts.plans[k].plan.time.total_s(), 0));
  for (const PlannedQuantity& q : cuts.quantities) {
    std::string line = q.is_observable ? fmt::format("{:>10}", "+- " + fixed(q.uncertainty, 3)) : "unobservable";
    for (std::size_t k = 0; k < q.needs.size(); ++k)
      line += fmt::format("{}{}", k == 0 ? "  needs " : ", ", cuts.parts.jobs[q.needs[k]]);
    text += fmt::format("  {:<38} {}\n", fmt::format("{}, {}", q.quantity->description, q.quantity->unit()), line);
  }
  for (const std::string& combination : cuts.unobservable) text += fmt::format("  unobservable: {}\n", combination);
  return text;
}

}  // namespace retrace::studies
