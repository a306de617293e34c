#include "fabrication/verify/verify.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

constexpr double kNmPerMm = 1e6;
constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

bool has_poses_of(const Machine& machine, const Workpiece3d& workpiece, const std::vector<RotaryPose>& words) {
  // Poses are written with seven digits; between the shipped machines they differ by far more.
  constexpr double same_deg = 1e-5;
  const auto is_solved = [&](const RotaryPose& word) {
    for (const auto& prediction : workpiece.predictions) {
      if (!prediction) continue;
      for (const PlungePose& p : prediction->poses) {
        const double c = word.c_deg - p.pose.c_deg;
        if (std::abs(word.a_deg - p.pose.a_deg) < same_deg && std::abs(c - 360.0 * std::round(c / 360.0)) < same_deg)
          return true;
      }
    }
    return false;
  };
  static_cast<void>(machine);
  return !words.empty() && std::all_of(words.begin(), words.end(), is_solved);
}

/// Refuses a program whose poses are those that another measured machine needs.
void refuse_other_machine(const Job& job, const Machine& machine, const std::vector<Machine>& others,
                          const VerifyOptions& options, const Workpiece3d& workpiece,
                          const std::vector<RotaryPose>& words, const std::string& file) {
  if (has_poses_of(machine, workpiece, words)) return;
  for (const Machine& other : others) {
    if (other.name == machine.name || other.a.direction.basis != Basis::measured) continue;
    if (has_poses_of(other, workpiece_of(job, other, options), words))
      throw InputError({file, 0, ""}, fmt::format("is a program for machine {}, the job is for {}: its poses are those "
                                                  "of the other machine's axes",
                                                  other.name, machine.name));
  }
}

ElementResult result_of(const ElementFigures& figures, const Prediction& prediction) {
  ElementResult result;
  result.figures = figures;
  for (std::size_t f = 0; f < 2; ++f) {
    const FacetFigures& facet = figures.facets[f];
    const double along = facet.slope_along - (facet.is_ploughed ? prediction.plough_slope[f] : 0.0);
    result.facet_angle_arcmin[f] = std::atan(std::hypot(facet.slope_up, along)) * kArcminPerRad;
    // A facet that rises above the design up its slope leans into the groove.
    result.apex_error_arcmin -= std::atan(facet.slope_up) * kArcminPerRad;
  }
  return result;
}

class Judge {
 public:
  Judge(const Workpiece3d& workpiece, FindingList& findings, Verification& verification)
      : workpiece_(workpiece), findings_(findings), result_(verification) {}

  void element(std::size_t index, const std::string& program) {
    const ElementResult& element = result_.elements[index];
    const auto number = static_cast<std::int64_t>(index);
    if (!element.figures.is_cut) {
      findings_.add({"element_missing", program, 0, number, fmt::format("element {} is not cut", number), 0, 0, 1});
      return;
    }
    ++result_.elements_cut;
    for (std::size_t f = 0; f < 2; ++f) facet(element.figures.facets[f], f, number, program);
    const double angle = std::max(element.facet_angle_arcmin[0], element.facet_angle_arcmin[1]);
    result_.facet_angle_arcmin_max = std::max(result_.facet_angle_arcmin_max, angle);
    if (std::abs(element.apex_error_arcmin) > std::abs(result_.apex_error_arcmin_max))
      result_.apex_error_arcmin_max = element.apex_error_arcmin;
  }

 private:
  void facet(const FacetFigures& facet, std::size_t f, std::int64_t number, const std::string& program) {
    const double tolerance_nm = workpiece_.tolerance_mm * kNmPerMm;
    const double root_nm = workpiece_.prediction(static_cast<std::size_t>(number)).root_mm * kNmPerMm;
    result_.facet_distance_nm_max = std::max(result_.facet_distance_nm_max, facet.distance_nm);
    result_.root_residual_nm_max = std::max(result_.root_residual_nm_max, facet.root.nm);
    const auto add = [&](const char* kind, const FacetDeviation& deviation, const char* what, double limit) {
      findings_.add(
          {kind, program, deviation.line, number,
           fmt::format("facet {} of element {}: {} nm {}", f + 1, number, fixed(std::abs(deviation.nm), 1), what),
           deviation.nm, limit, 1});
    };
    if (facet.highest.nm > tolerance_nm) add("excess", facet.highest, "of material are left above it", tolerance_nm);
    if (facet.deepest.nm < -tolerance_nm) add("gouge", facet.deepest, "too much are removed below it", tolerance_nm);
    if (facet.root.nm > root_nm + tolerance_nm)
      add("root_residual", facet.root, "are left at the root", root_nm + tolerance_nm);
  }

  const Workpiece3d& workpiece_;
  FindingList& findings_;
  Verification& result_;
};

double design_volume_mm3(const Groove& groove) {
  return groove.half_base_mm * -groove.root_mm.z() * 2.0 * groove.half_width_mm;
}

}  // namespace

Workpiece3d workpiece_of(const Job& job, const Machine& machine, const VerifyOptions& options) {
  Workpiece3d workpiece;
  workpiece.job = &job;
  workpiece.machine = &machine;
  workpiece.tolerance_mm = options.tolerance_nm / kNmPerMm;
  const geometry::RtpElement size = blank_prism(job);
  for (const CutElement& element : cut_elements(job)) {
    workpiece.grooves.push_back(groove_of(element, size));
    auto& prediction = workpiece.predictions[element.turned ? 1 : 0];
    if (!prediction) prediction = predict(machine, workpiece.grooves.back(), job.tool.width_mm);
  }
  return workpiece;
}

Verification verify_programs(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                             const VerifyOptions& options, const std::vector<Machine>& others,
                             const Cancellation* cancellation) {
  const Workpiece3d workpiece = workpiece_of(job, machine, options);
  FindingList findings;
  ProgramCheck check(workpiece, findings);
  for (const NcProgram& program : programs) {
    check.begin(program.file);
    check.end(run_nc(program, check));
  }
  const std::string first = programs.empty() ? std::string() : programs.front().file;
  Verification result;
  result.tolerance_nm = options.tolerance_nm;
  const std::vector<RigidMotion> poses = check.poses();
  std::vector<bool> cuts(poses.size());
  for (const std::vector<Sweep>& sweeps : check.sweeps())
    for (const Sweep& sweep : sweeps) cuts[sweep.pose] = true;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (cuts[i]) result.poses.push_back(check.pose_words()[i]);
  refuse_other_machine(job, machine, others, options, workpiece, result.poses, first);

  const bool ploughs = job.strategy == Strategy::unidirectional;
  result.elements.resize(workpiece.grooves.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.elements.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (cancellation != nullptr && cancellation->requested()) return;
      const Prediction& prediction = workpiece.prediction(i);
      result.elements[i] =
          result_of(element_figures(workpiece.grooves[i], check.sweeps()[i], poses, check.wedge(), prediction, ploughs),
                    prediction);
    }
  });

  Judge judge(workpiece, findings, result);
  for (std::size_t i = 0; i < result.elements.size(); ++i) {
    judge.element(i, first);
    if (!result.elements[i].figures.is_cut) continue;
    result.removed_volume_mm3 += design_volume_mm3(workpiece.grooves[i]);
    for (const FacetFigures& facet : result.elements[i].figures.facets) result.removed_volume_mm3 -= facet.residual_mm3;
  }
  for (const auto& prediction : workpiece.predictions) {
    if (!prediction) continue;
    result.root_residual_nm_predicted = std::max(result.root_residual_nm_predicted, prediction->root_mm * kNmPerMm);
    result.wall_overcut_nm_predicted = std::max(result.wall_overcut_nm_predicted, prediction->wall_mm * kNmPerMm);
  }
  result.wall_overcut_nm_max = check.deepest_wall_mm() * kNmPerMm;
  result.root_radius_um = job.tool.edge_radius_um;
  result.free_tool_length_mm = check.least_free_tool_mm();
  result.time = check.time();
  result.findings = findings.take();
  return result;
}

}  // namespace retrace::fabrication
