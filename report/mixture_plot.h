#pragma once

// Plots of a part that consists of zones: the plan of the part, and a matrix that shows how much each zone contributes
// to each goal.

#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A zone: a stripe of the plan and a column of the matrix.
struct MixtureZone {
  std::string label;  ///< description of the cells of the zone
  double area_fraction = 0.0;
};

/// A goal: a row of the matrix.
struct MixtureGoal {
  std::string label;
  std::vector<double> contributions;  ///< contribution of each zone
  std::string total;                  ///< value of the whole part
  double price = 0.0;                 ///< shadow price of the goal; 0 if the goal is not an active constraint
};

/// Plot of a part with zones. Zones are stripes of the plan, from bottom to top. Texts are UTF-8; texts that are too
/// long are shortened.
struct MixturePlot {
  std::string title;
  std::string total_label;  ///< title of the column of totals, such as "margin %"
  std::vector<MixtureZone> zones;
  std::vector<MixtureGoal> goals;
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const MixturePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
