#pragma once

#include "core/schema/document.h"
#include "raytrace/beads/ball_layer.h"

namespace retrace::studies {

/// The balls of a design whose element.kind is "ball". \throw InputError
raytrace::BallLayer read_balls(const schema::Document& document);

}  // namespace retrace::studies
