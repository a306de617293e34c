#pragma once

// The verdict on NC programs of a chisel job: carries them out, cuts the blank, and compares it with the design.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
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

/// Tolerance of facet planes that can be kept: 10 nm, or where it is more, what rounding to the increments of a Fanuc's
/// words does at most at a root: the cuts of its two facets are off by half the diagonal of a box of them each.
double usual_tolerance_nm(const Machine& machine, const std::vector<NcProgram>& programs);

struct VerifyOptions {
  std::optional<double> tolerance_nm;  ///< of facet planes; > 0; without one usual_tolerance_nm()
  std::size_t standing = 0;  ///< so many of the programs, from the first, are not judged: they made what stands
};

/// One element that a program leaves.
struct ElementResult {
  ElementFigures figures;
  std::vector<double> facet_angle_arcmin;  ///< of each facet's normal to the design's; none if it is not cut
  double apex_error_arcmin = 0.0;  ///< of the angle between the facets, positive opens it; of a cube corner the largest
};

/// What programs do to a blank, judged against the design of the job.
struct Verification {
  std::vector<Finding> findings;
  std::vector<ElementResult> elements;
  double tolerance_nm = 0.0;
  double facet_distance_nm_max = 0.0;
  double facet_angle_arcmin_max = 0.0;
  double facet_angle_arcmin_predicted =
      0.0;                             ///< tilt along the root that ploughing with a tilted edge makes unavoidable
  double apex_error_arcmin_max = 0.0;  ///< of the largest size
  double root_residual_nm_max = 0.0;
  double root_residual_nm_predicted = 0.0;
  double wall_overcut_nm_max = 0.0;
  double wall_overcut_nm_predicted = 0.0;
  double chip_um_max = 0.0;      ///< that a cut takes along a line square to the plane that its edge sweeps
  double chip_share_max = 0.0;   ///< of what is borne there: above 1 it is found
  double root_radius_um = 0.0;   ///< that the tool's edge leaves at the root
  double root_chamfer_um = 0.0;  ///< width across the strips that the nose of a V leaves beside dihedral edges
  double root_ridge_um = 0.0;    ///< height of the ridge that stays between them, over the edge
  /// Volume that the cavities of hexagonal cube corners, which are triangular, take beyond the elements' apertures:
  /// what the outermost of them must.
  double border_overcut_mm3 = 0.0;
  /// By which cuts of neighbours go under an element's rims where these stand at different heights, as they must.
  double rim_overcut_um_max = 0.0;
  /// Job with zones: maximum depth and area (in plan) of the material that cavities unavoidably remove from elements of
  /// other zones, and the number of these elements.
  double zone_overcut_mm2 = 0.0;
  double zone_overcut_um_max = 0.0;
  std::int64_t elements_overcut = 0;
  double removed_volume_mm3 = 0.0;
  double free_tool_length_mm = 0.0;  ///< that the tool needs to keep its holder clear of the blank
  ProgramTime time;
  std::int64_t elements_cut = 0;
  std::vector<RotaryPose> poses;  ///< of the programs, in the order in which tools came down in them

  bool passes() const { return findings.empty(); }
  /// "pass"; "incomplete" if nothing is wrong but that material is left which later programs can cut; "fail"
  std::string_view verdict() const;
};

/// Carries out the programs one after the other, cuts the blank and compares. Nothing of planner or writers is used:
/// predictions come from job and machine.
/// \param others machines that a program might have been made for by mistake
/// \throw InputError for a program that cannot be carried out, or one that was made for another machine
Verification verify_programs(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                             const VerifyOptions& options, const std::vector<Machine>& others,
                             const Cancellation* cancellation = nullptr);

}  // namespace retrace::fabrication
