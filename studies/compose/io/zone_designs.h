#pragma once

// The cells of zones as design files.

#include <cstddef>
#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Of how many zones, the largest, designs are written at most.
std::size_t most_zone_designs(const ComposeRequest& request);

/// The design whose part is all of a zone's cells; its comment says the zone's share and turn. \pre a zone of the part
/// \throw InputError as make_candidate()
std::string zone_design_text(const Study& study, const PartOfZones& part, std::size_t zone);

}  // namespace retrace::studies
