#pragma once

// Presentation of the goals of a composition: which goals to show, contributions of the zones, and cost of limits.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the quantity of a goal.
/// \param goal index of the goal in the request
const Quantity& goal_of(const Study& study, const ComposeRequest& request, std::size_t goal);

/// Returns true if all goals are margins to limits. The margin of a value is value / limit - 1.
bool are_margins(const Study& study, const ComposeRequest& request);

/// Returns the contribution of a zone to a goal. For margins, it is the contribution to value / limit, so that the sum
/// over all zones is 1 + margin.
double contribution_of(const Zone& zone, std::size_t goal, bool is_margin);

/// Returns true if a price differs from zero by more than rounding errors.
bool is_price(double price);

/// Returns the decrease of the minimum goal per unit by which the limit of a margin is raised. Returns nothing for
/// goals that are not margins.
std::optional<double> cost_of_limit(const Quantity& quantity, const Mixture& mixture, std::size_t goal);

/// Returns the goals to show. If a test point has several readings, only the minimum is shown. Names of goals from the
/// same test point differ only after the last dot.
std::vector<std::size_t> goals_to_show(const ComposeRequest& request, const Mixture& mixture);

/// Formats the value of a goal. Margins are in percent.
std::string goal_value_text(double value, bool is_margin);

/// Returns the parameter values of a cell as text.
std::string cell_text(const Study& study, const FamilyCell& cell);

}  // namespace retrace::studies
