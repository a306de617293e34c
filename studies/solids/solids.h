#pragma once

// Elements, parts and moulds as closed solids that CAD and other programs read. The study behind `retrace export`.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Which solid of a design.
enum class SolidKind {
  element,  ///< one element on its plate, as `arrangement = "single"` has it
  array,    ///< the part
  mould     ///< the block behind the part's back surface that the part is moulded in
};

/// \throw InputError unless `word` is "element", "array" or "mould"
SolidKind read_solid_kind(const std::string& word);
std::string name_of(SolidKind kind);

/// Most elements of a solid that is written: its boundary is one mesh in memory.
inline constexpr std::int64_t kMostSolidElements = 200'000;

struct SolidRequest {
  SolidKind what = SolidKind::array;
  std::optional<double> block_mm;  ///< of a mould, below its deepest point, > 0; none: as thick as the plate
};

/// A closed boundary and its figures.
struct Solid {
  Design design;
  SolidKind what = SolidKind::array;
  double block_mm = 0.0;  ///< moulds only
  geometry::BoundaryMesh mesh;
  std::int64_t elements_full = 0;
  std::int64_t elements_partial = 0;
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
  geometry::Vec3 lower_mm = geometry::Vec3::Zero();
  geometry::Vec3 upper_mm = geometry::Vec3::Zero();
  bool is_manifold = true;  ///< it touches itself along no edge
  std::vector<std::string> warnings;
};

/// Builds the boundary of a solid of a design. Facets are plane and smooth: texture and everything else that
/// `[surface]` says but for angles and edges is left out.
/// \throw InputError for an infinite array (an element of it is allowed), a mask that cannot be read, more than
/// kMostSolidElements, or a block that is not thicker than 0
Solid make_solid(const Design& design, const SolidRequest& request);

}  // namespace retrace::studies
