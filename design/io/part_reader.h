#pragma once

// Reads the shape of a design from its document: elements with their array, or balls.

#include <string_view>

#include "core/schema/document.h"
#include "geometry/elements/part_spec.h"
#include "raytrace/balls/ball_layer.h"

namespace retrace::design {

/// Returns true if the design is an array of elements, and not a mesh, a plate or balls.
bool has_elements(const schema::Document& document);

/// Keys that specify the errors of the dihedral angles. A design may contain only one of them.
inline constexpr std::string_view kDihedralErrorArcmin = "surface.dihedral_error_arcmin";
inline constexpr std::string_view kDihedralErrorArcsec = "surface.dihedral_error_arcsec";

/// Returns the minimum thickness of the plate above z = 0. With this thickness, the entrance face is above the highest
/// points of all elements.
double min_thickness_mm(const geometry::PartSpec& part);

/// Reads the elements and the array of a design, without errors, edges and base.
geometry::PartSpec read_array(const schema::Document& document);

/// Reads the elements and the array of a design with all errors, edges and the base. Only the limits of each key are
/// checked; see design_rules() for further checks.
/// \throw InputError for an invalid formula
geometry::PartSpec read_part(const schema::Document& document);

/// Reads the balls of a design with element.kind = "ball".
raytrace::BallLayer read_balls(const schema::Document& document);

}  // namespace retrace::design
