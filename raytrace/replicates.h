#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "raytrace/monte_carlo.h"

namespace retrace::raytrace {

/// How Monte-Carlo tracers share out rays: MonteCarlo::kReplicates independent scrambles of the same points, whose mean
/// is the estimate and whose spread its error.

/// Of the scrambles of a replicate's entry points.
std::array<std::uint64_t, 2> scramble_keys(std::uint32_t seed, std::uint32_t replicate);

/// Traces rays first..last-1 of a replicate; nothing if it was cancelled.
using ReplicateTask =
    std::function<std::optional<Tally>(std::uint32_t replicate, std::uint32_t first, std::uint32_t last)>;

/// Adds rays from..until-1 of every replicate to its tally, on the threads at hand; sums do not depend on their number.
/// False if cancelled: the tallies are then of no use.
bool trace_replicates(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates,
                      const ReplicateTask& trace);

/// Adds rays from..until-1 of every replicate. False if cancelled.
using TraceRange = std::function<bool(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates)>;

/// Doubles the rays until the target error is reached, or traces as many as are asked for.
/// \throw BudgetError if power is lost: a ray missed every face from inside
MonteCarloResult trace_in_rounds(const Sampling& sampling, const std::vector<double>& cones_deg, std::size_t score_size,
                                 const TraceRange& trace_range);

}  // namespace retrace::raytrace
