#pragma once

#include "core/schema/document.h"
#include "geometry/part_spec.h"

namespace retrace::studies {

/// Elements, array, base, errors of angle, edges and scratches of a design without a mesh, plate or balls, checked
/// against each other; thickness_mm is the caller's. \throw InputError
geometry::PartSpec read_part(const schema::Document& document);

}  // namespace retrace::studies
