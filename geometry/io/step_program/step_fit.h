#pragma once

// Approximates faces of a STEP file by polynomials z(x, y). Part of the program that reads STEP files.

#include <string>

#include "geometry/io/step_message.h"
#include "geometry/io/step_program/step_shapes.h"

namespace retrace::geometry {

/// Patches of the chosen faces, with the measured deviation.
struct FittedFaces {
  StepPatches patches;            ///< relative to `origin_mm`
  Vec3 origin_mm = Vec3::Zero();  ///< in the rotated frame of the file
  Vec2 size_mm = Vec2::Zero();
  double deviation_mm = 0.0;
  double deviation_arcsec = 0.0;
};

/// Returns the chosen faces as heights z(x, y).
/// \throw std::runtime_error if a face folds, is vertical, or cannot be approximated
FittedFaces fit_faces(const ChosenFaces& chosen, const StepChoice& choice);

}  // namespace retrace::geometry
