#pragma once

// Faces of a STEP file: selection, placement, sewing and borders. Part of the program that reads STEP files.

#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/outline/outline.h"
#include "geometry/surface/step_face.h"
#include "geometry/surface/step_surface.h"

namespace retrace::geometry {

/// Maximum number of faces of a STEP file.
inline constexpr std::size_t kMaxStepFaces = 100000;
/// Maximum distance between a curve and the arcs that replace it in an outline.
inline constexpr double kArcToleranceMm = 1e-5;

/// Faces that a design selects, in the rotated frame of the file, in mm.
struct ChosenFaces {
  std::vector<TopoDS_Face> faces;
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;  ///< the faces at each edge
  std::string unit;                                         ///< unit of length of the file
  double gap_mm = 0.0;                                      ///< maximum width of a gap that was closed
};

/// Checks the text of a STEP file before OpenCASCADE reads it, because OpenCASCADE accepts truncated files.
/// \throw std::runtime_error if the file is truncated, is no STEP file, or has no faces or too many faces
void check_step_text(const std::filesystem::path& file);

/// Reads a STEP file, selects faces and joins them. Several faces are sewn together.
/// \throw std::runtime_error, with a text that begins with "must", "is" or "has", if the file is damaged or has no such
///     faces
ChosenFaces choose_faces(const StepChoice& choice);

/// Returns the borders of the faces in plan as closed loops of lines and arcs.
/// \throw std::runtime_error if they are not closed
std::vector<OutlineLoop> loops_around(const ChosenFaces& chosen, double sew_mm);

/// Returns the border of each face in plan as polygons.
/// \param tolerance_mm maximum distance between a curve and the polygon
std::vector<FaceBorder> borders_of(const ChosenFaces& chosen, double tolerance_mm);

/// Returns the edges between faces whose normals differ by more than 0.01 degrees, sorted by descending angle.
/// Positions are in the frame of the file.
std::vector<TangentBreak> tangent_breaks(const ChosenFaces& chosen, const StepChoice& choice);

/// Returns the rotation from the frame of the file to the rotated frame.
Eigen::Matrix3d rotation_of(const StepChoice& choice);

}  // namespace retrace::geometry
