#include "fabrication/chisel/check/verify.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/length_units.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/threads.h"
#include "fabrication/chisel/check/chip_check.h"
#include "fabrication/chisel/check/cut_assignment.h"
#include "fabrication/chisel/check/program_check.h"
#include "fabrication/chisel/check/rim_overcut.h"
#include "fabrication/chisel/check/simulation/nose.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/zone_overcut.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/job/substrate_cells.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

bool has_poses_of(const VerificationModel& workpiece, const std::vector<RotaryPose>& words) {
  // Programs contain rotary positions with seven decimals. The poses of different shipped machines differ by much more.
  constexpr double same_deg = 1e-5;
  const auto is_solved = [&](const RotaryPose& word) {
    for (const Prediction& prediction : workpiece.predictions)
      for (const PlungePose& p : prediction.poses) {
        const double c = word.c_deg - p.pose.c_deg;
        if (std::abs(word.a_deg - p.pose.a_deg) < same_deg && std::abs(c - 360.0 * std::round(c / 360.0)) < same_deg)
          return true;
      }
    return false;
  };
  return !words.empty() && std::all_of(words.begin(), words.end(), is_solved);
}

/// Refuses a program if its rotary poses do not match this machine, but match another machine whose axes were measured.
void refuse_other_machine(const Job& job, const Machine& machine, const std::vector<Machine>& others,
                          const VerificationModel& workpiece, const std::vector<RotaryPose>& words,
                          const std::string& file) {
  if (has_poses_of(workpiece, words)) return;
  for (const Machine& other : others) {
    if (other.name == machine.name || other.tilt != machine.tilt || other.a.direction.basis != Basis::measured)
      continue;
    if (has_poses_of(verification_model_of(job, other), words))
      throw InputError({file, 0, ""}, fmt::format("the program was made for machine {}, but the job is for machine {}: "
                                                  "the positions of the rotary axes do not fit the job's machine",
                                                  other.name, machine.name));
  }
}

/// Returns the error of the apex angle of a prism, in arc minutes. It is positive if the angle is too large. A facet
/// with a positive slope is inclined into the groove, which reduces this angle.
double apex_error_arcmin(const PrismGroove&, const ElementFigures& figures) {
  double error_arcmin = 0.0;
  for (const FacetFigures& facet : figures.facets) error_arcmin -= std::atan(facet.slope_up) * kArcminPerRad;
  return error_arcmin;
}

/// Returns the largest error of the three dihedral angles of a cube corner, relative to the design, in arc minutes. The
/// result is positive if the angle is too large.
double apex_error_arcmin(const CubeCavity& cavity, const ElementFigures& figures) {
  std::vector<Vec3> normals;
  for (std::size_t f = 0; f < figures.facets.size(); ++f) {
    const DesignFacet& design = cavity.facets[f];
    normals.push_back(
        (design.normal - figures.facets[f].slope_up * design.up_slope - figures.facets[f].slope_along * design.along)
            .normalized());
  }
  double largest = 0.0;
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const std::size_t next = (f + 1) % normals.size();
    const double error = (std::asin(normals[f].dot(normals[next])) -
                          std::asin(cavity.facets[f].normal.dot(cavity.facets[next].normal))) *
                         kArcminPerRad;
    if (std::abs(error) > std::abs(largest)) largest = error;
  }
  return largest;
}

ElementResult result_of(const Cavity& groove, const ElementFigures& figures) {
  ElementResult result;
  result.figures = figures;
  result.facet_angle_arcmin.resize(figures.facets.size());
  for (std::size_t f = 0; f < figures.facets.size(); ++f) {
    const FacetFigures& facet = figures.facets[f];
    result.facet_angle_arcmin[f] = std::atan(std::hypot(facet.slope_up, facet.slope_along)) * kArcminPerRad;
  }
  result.apex_error_arcmin =
      std::visit([&](const auto& element) { return apex_error_arcmin(element, figures); }, groove);
  return result;
}

class Judge {
 public:
  Judge(const VerificationModel& workpiece, FindingList& findings, Verification& verification)
      : workpiece_(workpiece), findings_(findings), result_(verification) {}

  void element(std::size_t index, const std::string& program) {
    const ElementResult& element = result_.elements[index];
    const auto number = static_cast<std::int64_t>(index);
    if (!element.figures.is_cut) {
      findings_.add({"element_missing", program, 0, number, fmt::format("element {} is not cut", number), 0, 0, 1});
      return;
    }
    ++result_.elements_cut;
    for (std::size_t f = 0; f < element.figures.facets.size(); ++f)
      facet(element.figures.facets[f], f, number, program);
    predict_angles(element.figures, workpiece_.prediction(index));
    for (const double angle : element.facet_angle_arcmin)
      result_.facet_angle_arcmin_max = std::max(result_.facet_angle_arcmin_max, angle);
    if (std::abs(element.apex_error_arcmin) > std::abs(result_.apex_error_arcmin_max))
      result_.apex_error_arcmin_max = element.apex_error_arcmin;
  }

 private:
  /// Returns the predicted residual material at the root of a facet. The plunges along the other facet leave this
  /// material. For a unidirectional job, returns the larger of the values of both facets, because only one facet is
  /// plunged.
  double root_limit_mm(const Prediction& prediction, std::size_t facet) const {
    if (!cuts_prisms(*workpiece_.job)) return prediction.fin_mm;
    return workpiece_.job->strategy == Strategy::unidirectional ? prediction.root_mm : prediction.root_of_mm[1 - facet];
  }

  void predict_angles(const ElementFigures& figures, const Prediction& prediction) {
    for (std::size_t f = 0; f < figures.facets.size(); ++f)
      if (figures.facets[f].is_ploughed)
        result_.facet_angle_arcmin_predicted = std::max(
            result_.facet_angle_arcmin_predicted, std::atan(std::abs(prediction.ploughed[f].slope)) * kArcminPerRad);
  }

  void facet(const FacetFigures& facet, std::size_t f, std::int64_t number, const std::string& program) {
    const double tolerance_nm = workpiece_.tolerance_mm * kNmPerMm;
    const double root_nm = root_limit_mm(workpiece_.prediction(static_cast<std::size_t>(number)), f) * kNmPerMm;
    result_.facet_distance_nm_max = std::max(result_.facet_distance_nm_max, facet.distance_nm);
    result_.root_residual_nm_max = std::max(result_.root_residual_nm_max, facet.root.nm);
    const auto add = [&](const char* kind, const FacetDeviation& deviation, const char* what, double limit) {
      findings_.add(
          {kind, program, deviation.line, number,
           fmt::format("facet {} of element {}: {} nm {}", f + 1, number, fixed(std::abs(deviation.nm), 1), what),
           deviation.nm, limit, 1});
    };
    if (facet.highest.nm > tolerance_nm) add("excess", facet.highest, "of material remain above it", tolerance_nm);
    if (facet.deepest.nm < -tolerance_nm) add("gouge", facet.deepest, "of material are removed below it", tolerance_nm);
    if (facet.root.nm > root_nm + tolerance_nm)
      add("root_residual", facet.root, "of material remain at the root", root_nm + tolerance_nm);
  }

  const VerificationModel& workpiece_;
  FindingList& findings_;
  Verification& result_;
};

/// Returns the designed volume of one element of a zone, below the plane of its rims. For a hexagonal element, it is
/// the volume inside of the hexagon. It does not include the corners of the triangular cavity, which are outside of the
/// hexagon.
double design_volume_mm3(const Job& job, std::size_t zone) {
  const geometry::Cell cell = geometry::element_cell(blank_element(job, zone), angle_errors_of(job, zone));
  double volume_mm3 = 0.0;
  for (const geometry::CellFacet& facet : cell.facets)
    volume_mm3 -= geometry::area(facet.outline) * facet.plane.at(geometry::centroid(facet.outline));
  return volume_mm3;
}

/// Returns the volume that triangular cavities remove outside of the hexagons of their elements. It is (M - N) a^3 / 6
/// (docs/theory/micro_chiseling.md). Here, a is the edge length of the cubes, and N is the number of cut elements. M is
/// the number of distinct hexagon corners at which dihedral edges end. On a substrate, the formula applies to the
/// unrolled array.
double border_overcut_mm3(const VerificationModel& workpiece, const std::vector<ElementResult>& elements) {
  std::set<std::pair<std::int64_t, std::int64_t>> corners;
  std::int64_t cut = 0;
  double edge_mm = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].figures.is_cut) continue;
    const auto& cavity = std::get<CubeCavity>(workpiece.cavities[i]);
    ++cut;
    edge_mm = 0.5 * cavity.facet_length_mm;
    for (int k = 0; k < 3; ++k) {
      // The dihedral edges have the azimuths -90, 30 and 150 degrees, because hexagonal elements are not rotated.
      const double azimuth = 2.0 * std::numbers::pi / 3.0 * k - 0.5 * std::numbers::pi;
      const geometry::Vec2 outwards(std::cos(azimuth), std::sin(azimuth));
      const geometry::Vec2 from_first =
          workpiece.elements[i].centre_mm - workpiece.elements.front().centre_mm + cavity.radius_mm * outwards;
      // The corners are points of a grid with the steps half width (in x) and half radius (in y) of the hexagons.
      const double half_radius_mm = 0.5 * cavity.radius_mm;
      corners.emplace(std::llround(from_first.x() / (std::numbers::sqrt3 * half_radius_mm)),
                      std::llround(from_first.y() / half_radius_mm));
    }
  }
  return edge_mm * edge_mm * edge_mm * static_cast<double>(static_cast<std::int64_t>(corners.size()) - cut) / 6.0;
}

bool has_errors(const Job& job) {
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    if (angle_errors_of(job, zone) != geometry::AngleErrors{}) return true;
  return false;
}

/// Computes the material that the triangular cavities of hexagonal elements remove outside of their hexagons.
void find_cavity_overcut(const VerificationModel& workpiece, Verification& result) {
  if (!std::holds_alternative<geometry::HexagonalCube>(workpiece.job->element)) return;
  if (workpiece.job->zones.empty()) {
    result.border_overcut_mm3 = border_overcut_mm3(workpiece, result.elements);
    return;
  }
  std::vector<bool> is_cut;
  for (const ElementResult& element : result.elements) is_cut.push_back(element.figures.is_cut);
  const ZoneOvercut overcut = zone_overcut(workpiece, is_cut);
  result.border_overcut_mm3 = overcut.volume_mm3;
  result.zone_overcut_mm2 = overcut.area_mm2;
  result.zone_overcut_um_max = 1e3 * overcut.deepest_mm;
  result.elements_overcut = overcut.elements;
}

/// Finds the element to which each run of cutting moves belongs (see CutAssignment). Returns an empty list for jobs
/// without a substrate, where the runs are not needed.
std::vector<std::optional<std::size_t>> visits_of(const VerificationModel& workpiece,
                                                  const std::vector<NcProgram>& programs) {
  if (!workpiece.job->substrate) return {};
  const Machine& machine = *workpiece.machine;
  CutAssignment finder(machine, workpiece.cavities, wedge_of(*workpiece.job, machine).tip_mm);
  for (const NcProgram& program : programs) {
    run_nc(program, finder);
    finder.end();
  }
  return finder.elements();
}

/// Computes the residual material that the rounded nose of the tool leaves along the dihedral edges of all elements.
void cut_with_nose(const VerificationModel& workpiece, const ProgramCheck& check, const std::vector<RigidMotion>& poses,
                   Verification& result) {
  const Tool& tool = workpiece.job->tool;
  if (tool.edge_radius_um <= 0.0) return;
  const ToolWedge nosed = nosed_wedge(tool, *workpiece.machine);
  std::vector<NoseResidue> residues(workpiece.cavities.size());
  for_each_in_parallel(residues.size(), [&](std::size_t i) {
    if (result.elements[i].figures.is_cut)
      residues[i] = nose_residue(std::get<CubeCavity>(workpiece.cavities[i]), 1e-3 * tool.edge_radius_um,
                                 check.sweeps()[i], poses, nosed);
  });
  for (const NoseResidue& residue : residues) {
    result.root_chamfer_um = std::max(result.root_chamfer_um, 1e3 * std::numbers::sqrt2 * residue.strip_mm);
    result.root_ridge_um = std::max(result.root_ridge_um, 1e3 * residue.ridge_mm);
  }
}

/// Computes the chips of all cuts of an element, in the order of cutting.
ChipFigures chips_of(const VerificationModel& workpiece, const BlankFace& face, std::size_t element,
                     std::span<const SweptVolume> sweeps, std::span<const RigidMotion> poses, const ToolWedge& wedge) {
  const Job& job = *workpiece.job;
  const double wander_mm = workpiece.prediction(element).wall_mm + workpiece.tolerance_mm;
  RemainingStock material(workpiece.cavities[element], face, wander_mm, job.tool.width_mm,
                          1e-3 * job.process.roughing_depth_um);
  ChipCheck check(workpiece, element, material, wedge, poses);
  for (const SweptVolume& sweep : sweeps) check.cut(sweep);
  return check.finish();
}

/// Simulates the programs.
/// \param unchecked_programs number of programs, at the beginning of the list, whose findings are discarded
/// \return run time of these programs
ProgramTime simulate(const std::vector<NcProgram>& programs, std::size_t unchecked_programs, ProgramCheck& check,
                     FindingList& findings) {
  ProgramTime unchecked_time;
  for (std::size_t k = 0; k < programs.size(); ++k) {
    check.begin(programs[k]);
    check.end(run_nc(programs[k], check));
    if (k + 1 != unchecked_programs) continue;
    findings.take();
    unchecked_time = check.time();
  }
  check.finish();
  return unchecked_time;
}

/// Returns the rotary poses of all cuts, in the order of the programs.
std::vector<RotaryPose> poses_of_cuts(const ProgramCheck& check) {
  std::vector<bool> cuts(check.rounded_poses().size());
  for (const std::vector<SweptVolume>& sweeps : check.sweeps())
    for (const SweptVolume& sweep : sweeps) cuts[sweep.pose] = true;
  std::vector<RotaryPose> poses;
  for (std::size_t i = 0; i < cuts.size(); ++i)
    if (cuts[i]) poses.push_back(check.rounded_poses()[i]);
  return poses;
}

/// Measures the facets of an element.
ElementFigures figures_of(const VerificationModel& workpiece, std::size_t element, const ProgramCheck& check,
                          std::span<const RigidMotion> poses) {
  const Job& job = *workpiece.job;
  const Prediction& prediction = workpiece.prediction(element);
  const std::vector<SweptVolume>& sweeps = check.sweeps()[element];
  return std::visit(
      Overloaded{[&](const PrismGroove& groove) {
                   return element_figures(groove, sweeps, poses, check.wedge(), prediction,
                                          job.strategy == Strategy::unidirectional, workpiece.tolerance_mm);
                 },
                 [&](const CubeCavity& cavity) {
                   return cavity_figures(cavity, sweeps, poses, check.wedge(), job.tool.nose_angle_deg, prediction);
                 }},
      workpiece.cavities[element]);
}

/// Facets and chips of all elements.
struct MeasuredElements {
  std::vector<ElementResult> elements;
  std::vector<ChipFigures> chips;
};

MeasuredElements measured(const VerificationModel& workpiece, const ProgramCheck& check,
                          std::span<const RigidMotion> poses, const Cancellation* cancellation) {
  const BlankFace face(*workpiece.job);
  MeasuredElements all;
  all.elements.resize(workpiece.cavities.size());
  all.chips.resize(workpiece.cavities.size());
  for_each_in_parallel(workpiece.cavities.size(), [&](std::size_t i) {
    if (cancellation != nullptr && cancellation->requested()) return;
    all.elements[i] = result_of(workpiece.cavities[i], figures_of(workpiece, i, check, poses));
    all.chips[i] = chips_of(workpiece, face, i, check.sweeps()[i], poses, check.wedge());
  });
  return all;
}

/// Adds the maximum chip thicknesses to the result. Also adds the findings about chips, except for findings of the
/// first `unchecked_programs` programs.
void add_chips(const std::vector<ChipFigures>& chips, const std::vector<NcProgram>& programs,
               std::size_t unchecked_programs, FindingList& findings, Verification& result) {
  for (const ChipFigures& figures : chips) {
    result.chip_um_max = std::max(result.chip_um_max, 1e3 * figures.thickest_mm);
    result.chip_ratio_max = std::max(result.chip_ratio_max, figures.max_thickness_ratio);
    for (std::size_t k = 0; k < figures.findings.size(); ++k) {
      if (figures.programs[k] < unchecked_programs) continue;
      Finding finding = figures.findings[k];
      finding.program = programs[figures.programs[k]].file;
      findings.add(std::move(finding));
    }
  }
}

/// Returns the volume of the material that is removed inside of the elements.
double removed_volume_mm3(const VerificationModel& workpiece, const std::vector<ElementResult>& elements) {
  std::vector<double> volumes_mm3;
  for (std::size_t zone = 0; zone < zone_count(*workpiece.job); ++zone)
    volumes_mm3.push_back(design_volume_mm3(*workpiece.job, zone));
  double removed_mm3 = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].figures.is_cut) continue;
    removed_mm3 += volumes_mm3[workpiece.elements[i].zone];
    for (const FacetFigures& facet : elements[i].figures.facets) removed_mm3 -= facet.residual_mm3;
  }
  return removed_mm3;
}

/// Adds the unavoidable errors of all elements to the result.
void add_predictions(const std::vector<Prediction>& predictions, Verification& result) {
  for (const Prediction& prediction : predictions) {
    result.root_residual_nm_predicted = std::max(result.root_residual_nm_predicted, prediction.root_mm * kNmPerMm);
    result.wall_overcut_nm_predicted = std::max(result.wall_overcut_nm_predicted, prediction.wall_mm * kNmPerMm);
  }
}

/// Returns the increments to which the control rounds the positions of the programs.
Increments increments_in(const Machine& machine, const std::vector<NcProgram>& programs) {
  const auto is_fanuc = [](const NcProgram& program) { return program.dialect == NcDialect::fanuc; };
  return std::any_of(programs.begin(), programs.end(), is_fanuc) ? increments_of(machine.control.increment_system)
                                                                 : Increments{};
}

}  // namespace

std::string_view Verification::verdict() const {
  if (passes()) return "pass";
  // Kinds of findings that only report remaining material.
  constexpr std::array<std::string_view, 4> kUnfinished = {"excess", "element_missing", "root_residual",
                                                           "layer_unfinished"};
  const bool is_unfinished = std::all_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return std::find(kUnfinished.begin(), kUnfinished.end(), finding.kind) != kUnfinished.end();
  });
  return is_unfinished ? "incomplete" : "fail";
}

double default_tolerance_nm(const Machine& machine, const std::vector<NcProgram>& programs) {
  constexpr double kUsualNm = 10.0;
  const auto step_nm = static_cast<double>(increments_in(machine, programs).linear_nm);
  return std::max(kUsualNm, std::ceil(std::numbers::sqrt3 * step_nm));
}

Verification verify_programs(const Job& job, const Machine& given_machine, const std::vector<NcProgram>& programs,
                             const VerifyOptions& options, const std::vector<Machine>& others,
                             const Cancellation* cancellation) {
  Machine machine = given_machine;
  machine.increments = increments_in(given_machine, programs);
  check_on_machine(job, cuts_prisms(job) ? given_machine : machine);
  const VerificationModel workpiece =
      verification_model_of(job, machine, options.tolerance_nm.value_or(default_tolerance_nm(machine, programs)));
  FindingList findings;
  ProgramCheck check(workpiece, findings, visits_of(workpiece, programs));
  const ProgramTime unchecked_time = simulate(programs, options.unchecked_programs, check, findings);
  const std::string first =
      programs.size() <= options.unchecked_programs ? std::string() : programs[options.unchecked_programs].file;
  Verification result;
  result.tolerance_nm = workpiece.tolerance_mm * kNmPerMm;
  result.poses = poses_of_cuts(check);
  refuse_other_machine(job, machine, others, workpiece, result.poses, first);

  const std::vector<RigidMotion> poses = check.poses();
  MeasuredElements all = measured(workpiece, check, poses, cancellation);
  result.elements = std::move(all.elements);
  add_chips(all.chips, programs, options.unchecked_programs, findings, result);
  Judge judge(workpiece, findings, result);
  for (std::size_t i = 0; i < result.elements.size(); ++i) judge.element(i, first);
  add_predictions(workpiece.predictions, result);
  result.wall_overcut_nm_max = check.deepest_wall_mm() * kNmPerMm;
  find_cavity_overcut(workpiece, result);
  if (job.substrate || has_errors(job)) result.rim_overcut_um_max = 1e3 * rim_overcut_mm(workpiece.cavities);
  result.removed_volume_mm3 = removed_volume_mm3(workpiece, result.elements) + result.border_overcut_mm3;
  if (cuts_prisms(job))
    result.root_radius_um = job.tool.edge_radius_um;
  else
    cut_with_nose(workpiece, check, poses, result);
  result.free_tool_length_mm = check.required_free_tool_mm();
  result.time = check.time() - unchecked_time;
  result.findings = findings.take();
  return result;
}

}  // namespace retrace::fabrication
