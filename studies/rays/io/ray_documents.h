#pragma once

// The result of traced rays as a JSON document and as a table.

#include <string>

#include "studies/rays/ray_study.h"

namespace retrace::studies {

/// retrace.rays/1
std::string rays_json(const RayResult& result);
/// For people.
std::string rays_table(const RayResult& result);

}  // namespace retrace::studies
