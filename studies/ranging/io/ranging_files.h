#pragma once

// Result of `retrace ranging` as JSON, CSV and text.

#include <string>

#include "studies/ranging/ranging.h"

namespace retrace::studies {

/// Returns the result as JSON of the format `retrace.ranging/1`.
std::string ranging_json(const RangingResult& result);
/// Returns a CSV table with one line for each point.
std::string ranging_csv(const RangingResult& result);
/// Returns the map of the first point as CSV, one line per direction. The text is empty if there is no map.
std::string ranging_map_csv(const RangingResult& result);
/// Returns the illuminated cubes of the first point as CSV, with their ranges and cross sections. The text is empty for
/// a single cube.
std::string cubes_csv(const RangingResult& result);
/// Returns the pulse response of the first point as CSV. The text is empty for continuous light.
std::string response_csv(const RangingResult& result);
/// Returns the single shots of the first point as CSV. The text is empty if no shots were requested.
std::string shots_csv(const RangingResult& result);
/// Returns a summary of the result for the terminal.
std::string ranging_table(const RangingResult& result);

}  // namespace retrace::studies
