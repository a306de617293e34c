#pragma once

// Output documents and tables of `retrace roughness`.

#include <string>

#include "studies/roughness/roughness.h"

namespace retrace::studies {

/// Returns the result as JSON with the schema retrace.roughness/1.
std::string roughness_json(const RoughnessResult& result);

/// Returns the points as CSV: first those of the curves, then the measured facets.
std::string roughness_csv(const RoughnessResult& result);

/// Returns the result as a table for the terminal.
std::string roughness_table(const RoughnessResult& result);

}  // namespace retrace::studies
