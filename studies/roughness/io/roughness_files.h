#pragma once

// Documents and tables of `retrace roughness`.

#include <string>

#include "studies/roughness/roughness.h"

namespace retrace::studies {

/// The result as JSON, schema retrace.roughness/1.
std::string roughness_json(const RoughnessResult& result);

/// One line a point: those of the curves, then the measured facets.
std::string roughness_csv(const RoughnessResult& result);

/// For people at a terminal.
std::string roughness_table(const RoughnessResult& result);

}  // namespace retrace::studies
