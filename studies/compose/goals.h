#pragma once

// What the goals of a composition are for people: which of them to show, what zones give to them, and what they cost.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// The quantity of a goal. \param goal its number in the request
const Quantity& goal_of(const Study& study, const ComposeRequest& request, std::size_t goal);

/// Whether all goals are margins to limits.
bool are_margins(const Study& study, const ComposeRequest& request);

/// What a zone gives to a goal: of a margin its part of value over limit, so that all zones together give 1 + margin.
double given_by(const Zone& zone, std::size_t goal, bool is_margin);

/// Whether a price is one, and not what rounding leaves of none.
bool is_price(double price);

/// What one more of the limit of a margin that binds costs of the least one. Nothing for other goals.
std::optional<double> cost_of_limit(const Quantity& quantity, const Mixture& mixture, std::size_t goal);

/// Of several readings of one point - goals whose names are alike up to the last dot - the one that is least; all
/// others.
std::vector<std::size_t> goals_to_show(const ComposeRequest& request, const Mixture& mixture);

/// Margins in percent, as tables of photometry have them.
std::string goal_value_text(double value, bool is_margin);

/// The parameters of a cell.
std::string cell_text(const Study& study, const FamilyCell& cell);

}  // namespace retrace::studies
