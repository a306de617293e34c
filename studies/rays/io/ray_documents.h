#pragma once

// Output of traced rays as a JSON document and as a table.

#include <string>

#include "studies/rays/ray_study.h"

namespace retrace::studies {

/// Returns the result as JSON in the format retrace.rays/1.
std::string rays_json(const RayResult& result);
/// Returns the result as a table for the terminal.
std::string rays_table(const RayResult& result);

}  // namespace retrace::studies
