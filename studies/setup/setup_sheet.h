#pragma once

// Collects the data for setting up a machine for a job, in the order of the work: blank, tool, zero, axes, control,
// programs, measurements, and the effect of errors in each step.

#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "studies/fabrication/fabricate.h"
#include "studies/setup/sensitivity.h"
#include "studies/setup/setup_light.h"

namespace retrace::studies {

/// Range of positions of an axis in all programs of a plan, in mm or degrees.
struct AxisTravel {
  char axis = 'X';
  double low = 0.0;
  double high = 0.0;
  fabrication::Interval limits;
};

/// Set-up of the blank. The zero point is the center of the array on the face of the blank.
struct BlankSetup {
  geometry::Vec2 array_mm = geometry::Vec2::Zero();  ///< size of the array along X and Y at A = 0 and C = 0
  double deepest_mm = 0.0;                           ///< maximum depth of roots or apexes below the face
  /// For parts on a substrate: thickness of the material above the tops of the elements (rims).
  double stock_mm = 0.0;
  /// Description of the shape of a face that is not flat; empty if the face is flat.
  std::string base;
  std::vector<std::string> zones;  ///< for each zone: description of its elements
  /// Height of blank and fixture together, from the machine's bodies below the workpiece to the zero point. Empty if
  /// the machine file has no such bodies.
  std::optional<double> fixture_height_mm;
  /// Maximum radius about C of a face that can be rotated and tilted below the retracted tool.
  double free_radius_mm = 0.0;
};

/// Set-up of the tool.
struct ToolSetup {
  /// Distance from the cutting edge up to the holder; empty if the machine file has no holder.
  std::optional<double> free_length_mm;
  double plunge_rake_deg = 0.0;
  std::optional<double> plough_rake_deg;  ///< empty for V-shaped tools
};

/// Expected measurements after a stage (group of cuts in one pose). The programs do not check them.
struct StageCheck {
  std::string stage;
  std::size_t program = 0;     ///< index of the program in which the stage ends
  double ends_s = 0.0;         ///< time from the start of the first program to the end of the stage
  double remaining_um = 0.0;   ///< thickness of the material that remains on the cut facets
  double root_depth_mm = 0.0;  ///< depth of the root below the tops of the elements (rims)
};

struct SetupSheet {
  BlankSetup blank;
  ToolSetup tool;
  std::vector<AxisTravel> travel;
  std::vector<std::string> control_needs;
  std::vector<int> optional_stops;  ///< number of optional stops in each program
  std::vector<StageCheck> checks;
  Sensitivities sensitivities;
  std::optional<SetupLight> light;
  std::string why_no_light;
  Warnings warnings;

  /// Returns the change of the light per unit of a quantity, or null if the light is not computed.
  const PartLight* change_of_light(const fabrication::SetupQuantity& quantity, fabrication::Tilt tilt) const;
};

/// Collects the data for setting up a machine.
/// \param light true: the effect of errors on the light is also computed, which takes about a second
SetupSheet setup_sheet(const FabricationResult& result, bool light = true);

}  // namespace retrace::studies
