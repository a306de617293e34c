#pragma once

// Writes design files: one for the cells of each zone, and one for the whole part with all zones.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the maximum number of zones for which design files are written. The largest zones come first.
std::size_t max_zone_designs(const ComposeRequest& request);

/// Returns the text of a design file with the cells of a single zone. A comment in the file gives the zone's fraction
/// of the area and its rotation.
/// \param zone index in `zones`
/// \throw InputError under the same conditions as make_candidate()
std::string zone_design_text(const Study& study, const std::vector<Zone>& zones, std::size_t zone);

/// Arrangement of the zones in a part.
enum class ZoneLayout {
  stripes,  ///< side by side, each over the whole height
  blocks,   ///< rectangles that are as square as the areas allow
  rows      ///< many rows over the whole width, which are assigned to the zones in turn
};
inline constexpr std::string_view kZoneLayouts[] = {"stripes", "blocks", "rows"};
/// Reads the name of an arrangement.
/// \throw InputError at --layout
ZoneLayout read_zone_layout(const std::string& word);

/// Arrangement of the zones of a part, and size of the part.
struct ZonedDesignRequest {
  ZoneLayout layout = ZoneLayout::stripes;
  std::optional<geometry::Vec2> size_mm;  ///< size of the part; if empty, the size in the study's design
};

/// Checks that a part with zones can be written as one design.
/// \throw InputError if the size is missing, or if a parameter may not differ between the zones of a part
void check_zoned_design(const Study& study, const ZonedDesignRequest& request);

/// Returns the text of the design file of the whole part.
/// \throw InputError under the same conditions as check_zoned_design(), and if a zone is smaller than one element
std::string zoned_design_text(const Study& study, const std::vector<Zone>& zones, const ZonedDesignRequest& request);

}  // namespace retrace::studies
