#pragma once

// Keys that select and place faces of STEP files, for the tables [entrance_surface], [substrate] and [outline] of
// designs.

#include "core/schema/conditions.h"

namespace retrace::geometry {

inline constexpr NumberRange kStepCoordinateMm{.low = -1e6, .high = 1e6};
inline constexpr NumberRange kStepRotationDeg{.low = -360.0, .high = 360.0};
inline constexpr double kNoStepRotation[] = {0.0, 0.0, 0.0};

inline constexpr schema::Row kStepFileRow = {
    "file", schema::File{"a STEP file"}, schema::kRequired,
    "STEP file (AP203, AP214 or AP242). Its unit of length is read from the file."};
inline constexpr schema::Row kStepFaceRow = {
    "face", schema::Text{"a name, a colour such as \"#ff0000\", a number, \"largest\" or \"towards +z\""}, "largest",
    "Face of the STEP file: its name, its colour (`\"#rrggbb\"`), its number in the order of the file (`\"1\"` is the "
    "first), `\"largest\"`, or `\"towards +z\"` for all faces whose normals point upwards. All faces with the name or "
    "colour are used. Faces of solids that face downwards are not candidates for `\"largest\"`."};
inline constexpr schema::Row kStepSewRow = {"sew_mm", schema::Number{{.low = 0.0, .low_included = false, .high = 1.0}},
                                            0.01, "Maximum width of gaps between faces that are joined."};
inline constexpr schema::Row kStepOriginRow = {
    "origin_mm", schema::Numbers{3, kStepCoordinateMm, "coordinates, x, y and z"},
    schema::Computed{"the point of the surface at the centre of its bounding box in plan"},
    "`[x, y, z]`: point of the STEP file that becomes the origin of the surface. In the frame of the file, before the "
    "rotation."};
inline constexpr schema::Row kStepRotationRow = {
    "rotation_deg", schema::Numbers{3, kStepRotationDeg, "angles, about x, y and z"},
    std::span<const double>(kNoStepRotation),
    "`[x, y, z]`: rotations of the STEP file, first about its x axis, then about y, then about z. After them, +z must "
    "point to the light."};

}  // namespace retrace::geometry
