#pragma once

// Checks of designs of cube corners with a circular face (`element.kind = "round_icc"`).

#include <cstddef>
#include <string_view>

#include "core/schema/document.h"
#include "geometry/elements/part_spec.h"

namespace retrace::design {

/// Keys that check_length_of_round_cube() checks.
inline constexpr std::string_view kRoundLengthKeys[] = {"element.length_mm", "element.edge_length_mm"};
/// Keys that check_face_of_round_cube() checks.
inline constexpr std::string_view kRoundFaceKeys[] = {"element.chamfer_mm",
                                                      "element.recess_mm",
                                                      "element.mount_diameter_mm",
                                                      "surface.rim_radius_um",
                                                      "surface.rim_chamfer_um",
                                                      "part.facets",
                                                      "outline.margin_mm",
                                                      "outline.holes_mm",
                                                      "outline.polygon_mm",
                                                      "outline.dxf",
                                                      "outline.file"};
/// Keys that check_hollow() checks. The first key marks a hollow cube corner. The next kRefusedKeysOfHollow keys
/// are not allowed for hollow cube corners.
inline constexpr std::string_view kHollowKeys[] = {
    "element.hollow",      "body.material",          "body.catalogue",   "body.refractive_index",
    "body.temperature_c",  "body.absorption_per_mm", "coating.entrance", "entrance.film_coverage",
    "idealisation.facets", "body.facet_coating",     "coating.facets"};
inline constexpr std::size_t kRefusedKeysOfHollow = 7;
static_assert(kHollowKeys[kRefusedKeysOfHollow] == "entrance.film_coverage");

/// Checks the length of a round cube corner: the facets must reach the rim of the entrance face but must not cut the
/// face.
/// \throw InputError that names file, line and key
void check_length_of_round_cube(const schema::Document& document, const geometry::PartSpec& part);

/// Checks the mount, the chamfer and the outline of a round cube corner.
/// \throw InputError that names file, line and key
void check_face_of_round_cube(const schema::Document& document, const geometry::PartSpec& part);

/// Checks a hollow cube corner. It has neither a body nor an entrance face, so keys that describe them are not allowed.
/// \throw InputError that names file, line and key
void check_hollow(const schema::Document& document);

}  // namespace retrace::design
