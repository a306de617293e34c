#pragma once

// Verification of the NC programs of a chisel job: simulates the cuts and compares the machined surface with the
// design.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "fabrication/check/findings.h"
#include "fabrication/check/program_time.h"
#include "fabrication/chisel/check/simulation/facet_figures.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Returns the default tolerance for facet planes, in nm. It is 10 nm, or the maximum effect of rounded positions if
/// that is larger. Rounding displaces the cuts of each facet by up to half the diagonal of a cube whose edge is one
/// increment. The displacements of two facets add up at the root. Only the increments of Fanuc programs are larger than
/// 1 nm.
double default_tolerance_nm(const Machine& machine, const std::vector<NcProgram>& programs);

struct VerifyOptions {
  std::optional<double> tolerance_nm;  ///< tolerance for facet planes, > 0; empty: default_tolerance_nm()
  /// Number of programs, at the beginning of the list, that are simulated but not checked.
  std::size_t unchecked_programs = 0;
};

/// Result for one element.
struct ElementResult {
  ElementFigures figures;
  /// Angle between the normals of each facet as cut and as designed; empty if the element is not cut.
  std::vector<double> facet_angle_arcmin;
  /// Error of the angle between the facets, positive if the groove is too wide. Cube corner: the largest of three
  /// errors.
  double apex_error_arcmin = 0.0;
};

/// Result of the verification of programs.
struct Verification {
  std::vector<Finding> findings;
  std::vector<ElementResult> elements;
  double tolerance_nm = 0.0;
  double facet_distance_nm_max = 0.0;
  double facet_angle_arcmin_max = 0.0;
  double facet_angle_arcmin_predicted = 0.0;  ///< unavoidable tilt along the root, due to ploughing with a tilted edge
  double apex_error_arcmin_max = 0.0;         ///< error with the largest absolute value, with its sign
  double root_residual_nm_max = 0.0;
  double root_residual_nm_predicted = 0.0;
  double wall_overcut_nm_max = 0.0;
  double wall_overcut_nm_predicted = 0.0;
  double chip_um_max = 0.0;     ///< maximum chip thickness, perpendicular to the plane that the edge sweeps
  double chip_ratio_max = 0.0;  ///< maximum chip thickness divided by its limit; values above 1 give a finding
  double root_radius_um = 0.0;  ///< radius of the root due to the radius of the tool's edge
  /// Total width of the strips that the nose of a V-shaped tool leaves along a dihedral edge.
  double root_chamfer_um = 0.0;
  double root_ridge_um = 0.0;  ///< height of the ridge between the strips of two facets, above the dihedral edge
  /// Volume that is unavoidably removed outside of the apertures of hexagonal cube corners. Their cavities are
  /// triangular. The outermost cavities therefore extend beyond the array.
  double border_overcut_mm3 = 0.0;
  /// Maximum depth by which cuts of neighbouring elements unavoidably go below the rims of an element. This happens
  /// where the rims have different heights.
  double rim_overcut_um_max = 0.0;
  /// Overcut in a job with zones. Cavities unavoidably remove material from elements of other zones. The values are the
  /// area of this material (seen along Z), its maximum depth, and the number of the elements that lose material.
  double zone_overcut_mm2 = 0.0;
  double zone_overcut_um_max = 0.0;
  std::int64_t elements_overcut = 0;
  double removed_volume_mm3 = 0.0;
  /// Minimum free length of the tool between edge and holder with which the holder keeps clear of the blank.
  double free_tool_length_mm = 0.0;
  ProgramTime time;
  std::int64_t elements_cut = 0;
  std::vector<RotaryPose> poses;  ///< rotary poses of the cuts, in the order of the programs

  bool passes() const { return findings.empty(); }
  /// Returns "pass" if there are no findings. Returns "incomplete" if all findings are about remaining material, which
  /// later programs can cut. Otherwise returns "fail".
  std::string_view verdict() const;
};

/// Simulates the programs in their order and compares the machined surface with the design. It shares no code with the
/// planner and the writers of programs. All predictions are computed from the job and the machine.
/// \param others machines for which a program may have been made by mistake
/// \throw InputError for a program that cannot be simulated, and for a program that was made for another machine
Verification verify_programs(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                             const VerifyOptions& options, const std::vector<Machine>& others,
                             const Cancellation* cancellation = nullptr);

}  // namespace retrace::fabrication
