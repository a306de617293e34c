#pragma once

#include "raytrace/beads/ball_layer.h"
#include "studies/design/design_document.h"

namespace retrace::studies {

/// Whether a design's elements are balls: element.kind = "ball".
bool has_balls(const DesignDocument& document);

/// The balls of a design, from [element], [array] and [surface]. \pre has_balls() \throw InputError
raytrace::BallLayer read_balls(const DesignDocument& document);

}  // namespace retrace::studies
