#pragma once

// The mesh of a design for its three-dimensional picture, cut down to a piece where the array is too large.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// A part to be looked at.
struct DesignView {
  std::string title;
  geometry::BoundaryMesh mesh;                      ///< its whole surface, not welded between pieces of the back
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< where faces of different directions meet
  std::vector<std::string> remarks;                 ///< in what it differs from the design
};

/// The surface of a finite part, piece by piece, with its edges.
DesignView view_of(const geometry::Part& part);

/// The part of a design; of an endless array, and of one whose elements would be too small to be seen, a piece.
/// \throw InputError as part_of_design()
DesignView view_of(const Design& design);

/// Elements along a side of a piece.
inline constexpr double kPieceElements = 8.0;
/// Most elements along a side of an array that is shown as a whole.
inline constexpr double kMostElementsAcross = 60.0;

}  // namespace retrace::studies
