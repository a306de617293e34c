#pragma once

// Searches for the smallest change of a design that makes it pass its photometric standard.

#include <functional>
#include <optional>
#include <vector>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// Function that measures the readings of a changed design at all test points, with two wavelengths for each of `parts`
/// spans of the lamp's spectrum. It may stop after the first readings that show that min_ratio() is below `enough`.
/// It returns nothing if the measurement was cancelled, and it may throw InputError if the design cannot be made.
using TableOfDesign = std::function<std::optional<std::vector<PhotometricPoint>>(const design::Design& design,
                                                                                 std::size_t parts, double enough)>;

/// Returns the minimum of value divided by limit over all points. The ratio of an undetermined point counts as at most
/// 1. Returns infinity if there are no points.
double min_ratio(const std::vector<PhotometricPoint>& points);

/// Searches for a change of one parameter with which a failing design passes. The first parameter tried is the error of
/// the angles between facets, the second is the size of the elements. Returns the smallest passing change of the first
/// parameter that has one. If there is none, returns the best change that was tried. The search uses few wavelengths,
/// but the returned readings use all wavelengths. Returns nothing if no changed part can be made, or if the search was
/// cancelled.
/// \param progress receives the number of measured tables as a fraction of the largest possible number; may be null
std::optional<PhotometricChange> change_that_passes(const design::Design& design, const TestPlan& test_plan,
                                                    const TableOfDesign& table, Progress* progress = nullptr);

}  // namespace retrace::studies
