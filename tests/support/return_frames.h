#pragma once

#include "raytrace/light/light_setup.h"
#include "raytrace/light/return_frame.h"

namespace retrace::testing {

/// Returns the frame for directions of returned light. The normal of the frame is the direction to the source. Its
/// first axis is source_axis().
inline raytrace::ReturnFrame frame_at(const raytrace::Illumination& light) {
  raytrace::ReturnFrame frame;
  frame.to_source = raytrace::direction_to_source(light);
  frame.right = raytrace::source_axis(frame.to_source);
  frame.up = frame.to_source.cross(frame.right);
  return frame;
}

}  // namespace retrace::testing
