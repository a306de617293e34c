#pragma once

// Keys of the tables [element] and [array] that design files and job files have in common. Each format adds the members
// of its objects or the conditions under which a key applies (core/schema/conditions.h).

#include <string_view>

#include "core/schema/conditions.h"
#include "geometry/elements/array_layout.h"

namespace retrace::geometry {

/// Values of `element.kind`, in the order of the alternatives of Element. Round cube corners and balls are allowed only
/// in designs.
inline constexpr schema::Words kElementKinds = {"rtp", "hexagonal_icc", "triangular_icc", "round_icc", "ruled", "ball"};
inline constexpr auto kCubeKinds = schema::only(kElementKinds, "hexagonal_icc", "triangular_icc");

inline constexpr auto kRoundCube = schema::only(kElementKinds, "round_icc");
inline constexpr auto kRuled = schema::only(kElementKinds, "ruled");
/// Values of `element.kind` for cube corners, including kinds that only designs may contain.
inline constexpr auto kCubeKindsOfDesigns = schema::only(kElementKinds, "hexagonal_icc", "round_icc");

/// Words of `array.arrangement`, in the order of the enumerators of Arrangement.
inline constexpr schema::Words kArrangementWords = {"single",    "aligned",    "offset", "checker",
                                                    "honeycomb", "triangular", "ruled"};
inline constexpr auto kPrismArrangements = schema::only(kArrangementWords, "single", "checker");
/// Words of `array.arrangement` for hexagonal cube corners. In designs, a honeycomb can also consist of the ends of
/// pins.
inline constexpr schema::Words kHexagonalArrangements = {"single", "honeycomb", "pins"};
inline constexpr schema::Words kTriangularArrangements = {"single", "triangular"};
inline constexpr std::string_view kArrangementMeaning = "Arrangement of the elements.";
/// Words of `array.shifted_rows`, in the order of the enumerators of RowParity.
inline constexpr schema::Words kRowParityWords = {"even", "odd"};

/// Keys whose values are lengths. The allowed ranges of sizes and gaps depend on the file format.
struct SizeKeys {
  constexpr SizeKeys(schema::Kind size, schema::Kind gap)
      : base_mm("base_mm", size, schema::kRequired, "Length of a prism in plan, across its roof edge."),
        width_mm("width_mm", size, schema::kRequired, "Length of a prism in plan, along its roof edge."),
        aperture_mm("aperture_mm", size, schema::kRequired, "Diameter of the circumscribed circle of the aperture."),
        x_length_mm("x_length_mm", size, schema::kRequired,
                    "Length of the part along x. At least one element must fit."),
        y_length_mm("y_length_mm", size, schema::kRequired,
                    "Length of the part along y. At least one element must fit."),
        x_gap_mm("x_gap_mm", gap, 0.0, "Width of the flat land between elements that are neighbours along x."),
        y_gap_mm("y_gap_mm", gap, 0.0, "Width of the flat land between elements that are neighbours along y."),
        x_offset_mm("x_offset_mm", gap, 0.0, "Width of the flat margin at both ends of the part in x."),
        y_offset_mm("y_offset_mm", gap, 0.0, "Width of the flat margin at both ends of the part in y.") {}

  schema::Row base_mm, width_mm, aperture_mm;
  schema::Row x_length_mm, y_length_mm, x_gap_mm, y_gap_mm, x_offset_mm, y_offset_mm;
};

inline constexpr schema::Row kApexAngleKey = {"apex_angle_deg", schema::Number{{.low = 60.0, .high = 120.0}}, 90.0,
                                              "Included angle of the two facets of a prism."};
inline constexpr schema::Row kShiftedRowsKey = {
    "shifted_rows", schema::Word{kRowParityWords}, "even",
    "Rows that are shifted: those with even or with odd numbers. Rows are counted from 1 at the smallest y."};
inline constexpr schema::Row kOverlapKey = {"overlap_percent",
                                            schema::Number{{.low = 0.0, .high = 100.0, .high_included = false}}, 50.0,
                                            "Displacement of the shifted rows along x, in percent of `base_mm`."};

}  // namespace retrace::geometry
