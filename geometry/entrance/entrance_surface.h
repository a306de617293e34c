#pragma once

// Curved faces through which light enters a part, and what they are like over its outline.

#include <array>
#include <limits>
#include <memory>
#include <variant>

#include "geometry/part/surface_patch.h"
#include "geometry/polygon.h"
#include "geometry/surface/freeform_surface.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// A curved face through which light enters a part, in the part's frame: a freeform surface whose origin has a place
/// there; the material lies below it.
class EntranceSurface {
 public:
  struct Place {
    double height_mm = 0.0;
    Vec2 slope = Vec2::Zero();  ///< of the height along x and y; it does not jump
  };
  /// \param finest_mm size of features that are known beside its lenslets
  EntranceSurface(FreeformSurface surface, const Vec3& origin_mm,
                  double finest_mm = std::numeric_limits<double>::infinity());

  /// Not finite where there is no surface. Safe to call from many threads.
  Place at(const Vec2& point_mm) const;
  /// Size of its finest features, such as lenslets; infinite where none is known.
  double finest_mm() const { return finest_mm_; }

 private:
  Vec2 slope_across(const Vec2& place) const;

  FreeformSurface surface_;
  Vec3 origin_mm_;
  double finest_mm_;
};

/// The front of a part: an exact surface, or the triangles of a mesh that all look towards +z.
using Entrance = std::variant<std::shared_ptr<const EntranceSurface>, std::shared_ptr<const SurfacePatch>>;

/// What an entrance surface is like over the outline of a part.
struct EntranceRange {
  double lowest_mm = 0.0;
  double highest_mm = 0.0;
  Vec2 lowest_at_mm = Vec2::Zero();
  Vec2 highest_at_mm = Vec2::Zero();
  double steepest_slope = 0.0;  ///< sampled
};

/// Lowest and highest place of an entrance surface, to rounding, found from samples as near as its finest features ask
/// for. \throw InputError for a surface that has no finite height somewhere over the outline
EntranceRange entrance_range(const Entrance& entrance, const Polygon& outline);

/// How many cells across the longer side of an outline's box show all features of a surface: where none is known, so
/// many that twice and four times as many see the same bends. \throw InputError, whose text begins with "must", if
/// there are features that kMostEntranceCells do not show
int cells_to_show(const EntranceSurface& surface, const Polygon& outline);

inline constexpr int kMostEntranceCells = 1024;

/// Where between its corners a cell is looked at once more, as shares of its sides: at no fraction of a period that
/// corners could share.
inline constexpr std::array<double, 2> kWithinEntranceCell = {0.3819660113, 0.6180339887};

}  // namespace retrace::geometry
