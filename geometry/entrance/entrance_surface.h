#pragma once

// Curved faces through which light enters a part, and their range of heights and slopes over the part's outline.

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <variant>

#include "geometry/part/surface_patch.h"
#include "geometry/polygon.h"
#include "geometry/surface/freeform_surface.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Curved face through which light enters a part, in the part frame. It is a freeform surface at a given origin. The
/// material is below it.
class EntranceSurface {
 public:
  struct SurfaceSample {
    double height_mm = 0.0;
    Vec2 slope = Vec2::Zero();  ///< slope of the height along x and y; continuous
  };
  /// \param finest_mm size of the smallest known features other than its lenslets
  EntranceSurface(FreeformSurface surface, const Vec3& origin_mm,
                  double finest_mm = std::numeric_limits<double>::infinity());

  /// Returns height and slope at a point. They are not finite where there is no surface. May be called from several
  /// threads.
  SurfaceSample at(const Vec2& point_mm) const;
  /// Returns the size of the smallest features, such as lenslets, or infinity if no features are known.
  double finest_mm() const { return finest_mm_; }

 private:
  Vec2 slope_across(const Vec2& place) const;

  FreeformSurface surface_;
  Vec3 origin_mm_;
  double finest_mm_;
};

/// Entrance of a part: an exact surface, or a mesh whose triangles all face +z.
using Entrance = std::variant<std::shared_ptr<const EntranceSurface>, std::shared_ptr<const SurfacePatch>>;

/// Function that returns the height in mm of a curved entrance face at a point of the part frame, or NaN where there is
/// no face.
using EntranceHeights = std::function<double(const Vec2& point_mm)>;

/// Returns the height of an entrance surface at a point of the part frame, or NaN where there is no surface.
double height_mm(const Entrance& entrance, const Vec2& point_mm);

/// Range of heights and slopes of an entrance surface over the outline of a part.
struct EntranceRange {
  double lowest_mm = 0.0;
  double highest_mm = 0.0;
  Vec2 lowest_at_mm = Vec2::Zero();
  Vec2 highest_at_mm = Vec2::Zero();
  double steepest_slope = 0.0;  ///< maximum slope of all samples
};

/// Returns the lowest and highest point of an entrance surface within rounding errors. The density of the samples
/// follows from the size of the smallest features.
/// \throw InputError if the surface has no finite height somewhere over the outline
EntranceRange entrance_range(const Entrance& entrance, const Polygon& outline);

/// Returns the number of cells along the longer side of the outline's bounding box that resolves all features of a
/// surface. If no feature size is known, the number is increased until grids with two and four times as many cells find
/// the same curvatures.
/// \throw InputError, with a text that begins with "must", if kMaxEntranceCells cells do not resolve the features
int cells_to_resolve(const EntranceSurface& surface, const Polygon& outline);

inline constexpr int kMaxEntranceCells = 1024;

/// Relative positions within a cell at which the surface is sampled in addition to the cell's corners. The values are
/// irrational, so that a periodic structure that matches the grid is not missed.
inline constexpr std::array<double, 2> kWithinEntranceCell = {0.3819660113, 0.6180339887};

}  // namespace retrace::geometry
