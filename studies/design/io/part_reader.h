#pragma once

// Reads the shape of a design - elements with their array, or balls - from its document.

#include "core/schema/document.h"
#include "geometry/elements/part_spec.h"
#include "raytrace/balls/ball_layer.h"

namespace retrace::studies {

/// Whether the design is an array of elements: no mesh, no plate and no balls.
bool has_elements(const schema::Document& document);

/// Elements and array of such a design, without errors, edges and base.
geometry::PartSpec read_array(const schema::Document& document);

/// The same with all that there is. It is not checked beyond what each key allows: see design_rules().
/// \throw InputError for a formula that is none
geometry::PartSpec read_part(const schema::Document& document);

/// The balls of a design whose element.kind is "ball".
raytrace::BallLayer read_balls(const schema::Document& document);

}  // namespace retrace::studies
