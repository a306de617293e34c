#pragma once

// Plots of a part that is mixed of zones: its plan beside the matrix of what each zone gives to each goal.

#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A zone: its share of the plan and a column of the matrix.
struct MixtureZone {
  std::string label;  ///< what its cells are
  double share = 0.0;
};

/// A goal: a row of the matrix.
struct MixtureGoal {
  std::string label;
  std::vector<double> given;  ///< by each zone
  std::string total;          ///< what the part has there
  double price = 0.0;         ///< 0: it does not bind
};

/// Zones are stripes of the plan, in their order from below. Texts are UTF-8; what does not fit is shortened.
struct MixturePlot {
  std::string title;
  std::string total_label;  ///< of the column of totals: "margin %"
  std::vector<MixtureZone> zones;
  std::vector<MixtureGoal> goals;
};

/// What render_svg() and render_png() call.
std::string render(const MixturePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
