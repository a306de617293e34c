#pragma once

// Converts a request for a camera picture into a scene: positions and sizes of camera, lamp, surroundings and sheet.

#include <array>
#include <optional>

#include "core/field.h"
#include "design/optical_model.h"
#include "geometry/vec.h"
#include "raytrace/observers/camera.h"
#include "requests/image.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Returns width and height, in mm, of the sheet that the picture shows for an infinite part.
std::array<double, 2> film_of(const CameraRequest& request);

/// Checks the size of the sheet, and the radius of the cylinder on which the sheet is mounted. The sheet may cover at
/// most half of the cylinder's circumference. A size or a radius may be requested only for infinite parts.
/// \throw InputError at the field that is out of range or not allowed
void check_film(const CameraRequest& request, bool is_infinite);

/// Returns the scene of a request. The camera looks at the centre of the entrance face.
/// \param lamp photometric data of the lamp; empty if the request specifies the illuminance instead
/// \param reference_axis direction H = V = 0 in the part frame
raytrace::CameraScene scene_of(const CameraRequest& request, const std::optional<PhotometricLamp>& lamp,
                               const design::OpticalModel& model, const geometry::Vec3& reference_axis);

/// Returns the angle between two vectors.
double angle_deg(const geometry::Vec3& a, const geometry::Vec3& b);
/// Returns the vector from the point that the camera looks at to the eye, in mm.
geometry::Vec3 to_eye(const raytrace::CameraScene& scene);
/// Returns the vector from the point that the camera looks at to the lamp, in mm.
geometry::Vec3 to_lamp(const raytrace::CameraScene& scene);

/// Checks that the camera or the lamp is outside of the part and is not at the point that the camera looks at.
/// \param what name of the checked object in error messages
/// \throw InputError at `field` if its position is not allowed
void check_position(const design::OpticalModel& model, const raytrace::CameraScene& scene,
                    const geometry::Vec3& position, Field field, const char* what);

/// Checks that the luminances of the lamp and the surroundings are small enough for picture files.
/// \param has_file true if the intensity of the lamp is read from a file
/// \throw InputError at the field that determines the luminance, if the luminance is too large
void check_luminances(const raytrace::CameraScene& scene, bool has_file);

}  // namespace retrace::studies
