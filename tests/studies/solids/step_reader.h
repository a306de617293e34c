#pragma once

#include <string>

namespace retrace::test {

/// Data that OpenCASCADE finds in a STEP file.
struct StepFindings {
  bool is_read = false;
  int roots = 0;  ///< number of shapes at the top level
  int solids = 0;
  int shells = 0;
  int faces = 0;
  int planes = 0;         ///< number of faces on planes
  int cylinders = 0;      ///< number of faces on circular cylinders
  int spheres = 0;        ///< number of faces on spheres
  int splines = 0;        ///< number of faces on B-spline surfaces
  bool is_valid = false;  ///< result of BRepCheck
  int free_edges = 0;     ///< number of edges that do not belong to two faces
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
};

StepFindings read_step(const std::string& file);

}  // namespace retrace::test
