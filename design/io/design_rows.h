#pragma once

// Descriptions (schema::Row) of the keys in the tables of design files, and allowed words and ranges that several
// tables share. Internal to design/.

#include <span>
#include <string_view>

#include "core/schema/conditions.h"
#include "geometry/io/element_keys.h"

namespace retrace::design {

std::span<const schema::Row> element_rows();
std::span<const schema::Row> array_rows();
std::span<const schema::Row> outline_rows();
std::span<const schema::Row> part_rows();
std::span<const schema::Row> entrance_rows();
std::span<const schema::Row> zone_rows();
std::span<const schema::Row> body_rows();
std::span<const schema::Row> shell_rows();
std::span<const schema::Row> wet_back_rows();
std::span<const schema::Row> layer_rows();
std::span<const schema::Row> entrance_face_rows();
std::span<const schema::Row> thick_layer_rows();
std::span<const schema::Row> light_rows();
std::span<const schema::Row> detector_rows();
std::span<const schema::Row> surface_rows();
std::span<const schema::Row> scratch_rows();
std::span<const schema::Row> form_rows();
std::span<const schema::Row> form_term_rows();
std::span<const schema::Row> idealisation_rows();

inline constexpr auto kRtp = schema::only(geometry::kElementKinds, "rtp");
inline constexpr auto kBall = schema::only(geometry::kElementKinds, "ball");
inline constexpr schema::Words kAxes = {"x", "y"};

inline constexpr NumberRange kAboveZero{.low = 0.0, .low_included = false};
/// Range of sizes, from one nanometre to one kilometre. Outside of it, differences of coordinates have too few digits.
inline constexpr NumberRange kPlausibleSize{.low = 1e-6, .high = 1e6};
inline constexpr NumberRange kAzimuth{.low = -360.0, .high = 360.0};
inline constexpr schema::Kind kSize = schema::Number{kAboveZero, kPlausibleSize};

inline constexpr std::string_view kKind = "element.kind";
inline constexpr std::string_view kArrangement = "array.arrangement";
inline constexpr std::string_view kExtent = "array.extent";
inline constexpr schema::Words kSingle = {"single"};
inline constexpr schema::Words kInfinite = {"infinite"};

inline constexpr std::string_view kScaleMeaning =
    "Factor that converts the unit of the mesh to mm: 1 for mm, 1000 for metres, 25.4 for inches, 0.001 for "
    "micrometres.";
inline constexpr std::string_view kNotWithMesh =
    "not allowed together with a mesh, solid or plate in [part], which determines all angles and edges";

}  // namespace retrace::design
