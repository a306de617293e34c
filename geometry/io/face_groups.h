#pragma once

// Names of the faces of a part in mesh files, by role.

#include <array>
#include <string_view>
#include <utility>

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

inline constexpr std::array<std::pair<FacetRole, std::string_view>, 6> kFaceGroups = {
    {{FacetRole::entrance, "entrance"},
     {FacetRole::retro_facet, "facets"},
     {FacetRole::flat_back, "flat_back"},
     {FacetRole::inner_wall, "gables"},
     {FacetRole::border_wall, "border_walls"},
     {FacetRole::side, "sides"}}};

}  // namespace retrace::geometry
