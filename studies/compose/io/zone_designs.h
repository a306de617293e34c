#pragma once

// The cells of zones, and the part of all zones, as design files.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "studies/compose/compose.h"

namespace retrace::studies {

/// Of how many zones, the largest, designs are written at most.
std::size_t most_zone_designs(const ComposeRequest& request);

/// Returns the text of a design file with the cells of a single zone. A comment in the file gives the zone's fraction
/// of the area and its rotation.
/// \param zone index in `zones`
/// \throw InputError as make_candidate()
std::string zone_design_text(const Study& study, const std::vector<Zone>& zones, std::size_t zone);

/// How zones lie in a part.
enum class ZoneLayout {
  stripes,  ///< each over the whole height, side by side
  blocks,   ///< rectangles as nearly square as shares allow
  rows      ///< each in many rows over the whole width, one zone's after another's
};
inline constexpr std::string_view kZoneLayouts[] = {"stripes", "blocks", "rows"};
/// \throw InputError naming --layout
ZoneLayout read_zone_layout(const std::string& word);

/// Where the part of zones lies and how large it is.
struct ZonedDesignRequest {
  ZoneLayout layout = ZoneLayout::stripes;
  std::optional<geometry::Vec2> size_mm;  ///< none: that of the study's design
};

/// Whether a part of zones can be written. \throw InputError for a size that is missing, and for parameters that make
/// zones differ in what is the same all over a part
void check_zoned_design(const Study& study, const ZonedDesignRequest& request);

/// The design of the whole part. \throw InputError as check_zoned_design(), and where a zone is smaller than one
/// element
std::string zoned_design_text(const Study& study, const std::vector<Zone>& zones, const ZonedDesignRequest& request);

}  // namespace retrace::studies
