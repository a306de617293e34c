#pragma once

#include <memory>
#include <variant>

#include "geometry/polygon.h"
#include "geometry/surface_patch.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// A curved face through which light enters a part, in the part's frame: one height over every place, with a slope that
/// does not jump; the material lies below it.
class FrontSurface {
 public:
  struct Place {
    double height_mm = 0.0;
    Vec2 slope = Vec2::Zero();  ///< of the height along x and y
  };
  FrontSurface() = default;
  FrontSurface(const FrontSurface&) = delete;
  FrontSurface& operator=(const FrontSurface&) = delete;
  virtual ~FrontSurface() = default;

  /// Not finite where there is no surface. Safe to call from many threads.
  virtual Place at(const Vec2& point_mm) const = 0;
  /// Size of its finest features, such as lenslets; infinite where it has none.
  virtual double finest_mm() const = 0;
};

/// The front of a part: an exact surface, or the triangles of a mesh that all look towards +z.
using Front = std::variant<std::shared_ptr<const FrontSurface>, std::shared_ptr<const SurfacePatch>>;

/// What a front is like over the outline of a part.
struct FrontRange {
  double lowest_mm = 0.0;
  double highest_mm = 0.0;
  Vec2 lowest_at_mm = Vec2::Zero();
  Vec2 highest_at_mm = Vec2::Zero();
  double steepest_slope = 0.0;  ///< sampled
};

/// Lowest and highest place of a front, to rounding, found from samples as near as its finest features ask for.
/// \throw InputError for a surface that has no finite height somewhere over the outline
FrontRange front_range(const Front& front, const Polygon& outline);

/// How many cells along an axis show all features of a surface over a box of this size.
int cells_to_show(const FrontSurface& surface, double size_mm);

}  // namespace retrace::geometry
