#pragma once

// All that who sets up a machine for a job must know, in the order of the work: blank, tool, zero, axes, control,
// programs, what to measure, and what an error of each step costs.

#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "studies/fabrication/fabricate.h"
#include "studies/setup/sensitivity.h"
#include "studies/setup/setup_light.h"

namespace retrace::studies {

/// Where an axis goes in all programs of a plan, in mm or degrees.
struct AxisTravel {
  char axis = 'X';
  double low = 0.0;
  double high = 0.0;
  fabrication::Interval limits;
};

/// The blank, seen from the zero: the middle of the array on its face.
struct BlankSetup {
  geometry::Vec2 array_mm = geometry::Vec2::Zero();  ///< along X and Y at A0 C0
  double deepest_mm = 0.0;                           ///< root or apex below the face
  double stock_mm = 0.0;                             ///< by which the face stands over the rims, on a base
  std::string base;                                  ///< what its face is like, on a base; empty: flat
  std::vector<std::string> zones;                    ///< for each zone: description of its elements
  /// Blank and fixture together: from the top of what the machine's file has under the workpiece to the zero; none
  /// where it has nothing.
  std::optional<double> fixture_height_mm;
  double free_radius_mm = 0.0;  ///< around C, within which a face may reach and still turn under the tool
};

/// The tool as it must stand.
struct ToolSetup {
  std::optional<double> free_length_mm;  ///< from the edge up to the holder of the machine's file; none without one
  double plunge_rake_deg = 0.0;
  std::optional<double> plough_rake_deg;  ///< of chisels
};

/// What to measure when a stage has run: nothing of it is judged by the programs.
struct StageCheck {
  std::string stage;
  std::size_t program = 0;     ///< in which it ends, from 0
  double ends_s = 0.0;         ///< from the beginning of all programs
  double left_um = 0.0;        ///< then on the facets that it cuts
  double root_depth_mm = 0.0;  ///< then, below the rims
};

struct SetupSheet {
  BlankSetup blank;
  ToolSetup tool;
  std::vector<AxisTravel> travel;
  std::vector<std::string> control_needs;
  std::vector<int> optional_stops;  ///< by program
  std::vector<StageCheck> checks;
  Sensitivities sensitivities;
  std::optional<SetupLight> light;
  std::string why_no_light;
  Warnings warnings;

  /// What a unit of a quantity changes of the light; null where that is not told.
  const PartLight* change_of_light(const fabrication::SetupQuantity& quantity, fabrication::Tilt tilt) const;
};

/// \param light whether light is traced as well, which takes a second
SetupSheet setup_sheet(const FabricationResult& result, bool light = true);

}  // namespace retrace::studies
