#pragma once

// Searches for the smallest change of a design that makes it pass its photometric standard.

#include <functional>
#include <optional>
#include <vector>

#include "studies/photometry/photometry.h"

namespace retrace::studies {

/// The table of a changed design, with two wavelengths for each of `parts` spans of the lamp: the whole, or as much of
/// it as shows that least_ratio() is below `enough`. Nothing if it was cancelled. May throw InputError for a design
/// that cannot be made.
using TableOfDesign =
    std::function<std::optional<std::vector<PhotometricPoint>>(const Design& design, std::size_t parts, double enough)>;

/// The least of value over limit, where an undetermined point is no more than 1; infinite if there are none.
double least_ratio(const std::vector<PhotometricPoint>& points);

/// Looks for what makes a failing design pass, one parameter at a time: first the error of the angles between facets,
/// then the size of the elements. The first that passes ends the search, at the least change that does; if none does,
/// the best of all that was tried is told. Found with few wavelengths, told with all. Nothing if no other part can be
/// made, or it was cancelled.
std::optional<PhotometricChange> change_that_passes(const Design& design, const TestProgramme& programme,
                                                    const TableOfDesign& table);

}  // namespace retrace::studies
