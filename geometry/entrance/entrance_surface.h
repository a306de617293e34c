#pragma once

// Curved faces through which light enters a part, and their range of heights and slopes over the part's outline.

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "geometry/part/part.h"
#include "geometry/part/surface_patch.h"
#include "geometry/polygon.h"
#include "geometry/surface/freeform_surface.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Position and orientation of a surface. A point p in the frame of the surface has the position part_from_surface * p
/// + origin_mm in the part frame.
struct SurfacePose {
  Vec3 origin_mm = Vec3::Zero();
  Eigen::Matrix3d part_from_surface = Eigen::Matrix3d::Identity();  ///< rotation
};

/// Curved face through which light enters a part, in the part frame. It is a freeform surface at a given position and
/// orientation, with the material below the surface.
///
/// The height of an inclined surface above a point is found by intersecting the surface with the line through this
/// point parallel to z. Newton's method finds the intersection, starting on the tangent plane at the surface's origin.
/// The slope follows from the rotated normal and is therefore as exact as the slope of the freeform surface.
class EntranceSurface {
 public:
  struct SurfaceSample {
    double height_mm = 0.0;
    Vec2 slope = Vec2::Zero();  ///< slope of the height along x and y; continuous
  };
  /// \param finest_mm size of the smallest known features other than its lenslets
  EntranceSurface(FreeformSurface surface, const Vec3& origin_mm,
                  double finest_mm = std::numeric_limits<double>::infinity());
  EntranceSurface(FreeformSurface surface, const SurfacePose& pose,
                  double finest_mm = std::numeric_limits<double>::infinity());

  /// Returns height and slope at a point. They are not finite where there is no surface. May be called from several
  /// threads.
  SurfaceSample at(const Vec2& point_mm) const;
  /// Returns the size of the smallest features, such as lenslets, or infinity if no features are known.
  double finest_mm() const { return finest_mm_; }
  /// Returns the unit vector along the axis of the surface. It is z unless the surface is inclined.
  Vec3 axis() const { return pose_.part_from_surface.col(2); }
  bool is_inclined() const { return is_inclined_; }
  /// Returns the point of the surface above a plan position, as x and y in the frame of the surface. Returns nothing if
  /// there is no such point.
  std::optional<Vec2> surface_position(const Vec2& point_mm) const;
  /// Returns true if the angle between z and the normal of the surface at a point is less than 89 degrees.
  /// \param position_mm point in the frame of the surface, as returned by surface_position()
  bool faces_up_at(const Vec2& position_mm) const;

 private:
  /// Intersection of the surface with a line parallel to z.
  struct Crossing {
    double z_mm = 0.0;                ///< height above the origin of the surface, in the part frame
    Vec2 position_mm = Vec2::Zero();  ///< x and y in the frame of the surface
    Vec2 local_slope = Vec2::Zero();  ///< slope in the frame of the surface
  };

  jets::Gradient gradient_at(const Vec2& position_mm) const;
  Vec3 normal_of(const Vec2& slope) const;
  std::optional<Crossing> crossing_near(const Vec2& across_mm, double z_mm) const;
  std::optional<Crossing> crossing_at(const Vec2& across_mm) const;
  std::optional<Crossing> followed_crossing(const Vec2& across_mm) const;
  SurfaceSample inclined_sample(const Vec2& across_mm) const;

  FreeformSurface surface_;
  SurfacePose pose_;
  double finest_mm_;
  bool is_rotated_ = false;   ///< false: the axes of the surface are those of the part
  bool is_inclined_ = false;  ///< true: the z axis of the surface is not that of the part
};

/// Entrance of a part: an exact surface, or a mesh whose triangles all face +z.
using Entrance = std::variant<std::shared_ptr<const EntranceSurface>, std::shared_ptr<const SurfacePatch>>;

/// Function that returns the height in mm of a curved entrance face at a point of the part frame, or NaN where there is
/// no face.
using EntranceHeights = std::function<double(const Vec2& point_mm)>;

/// Returns the height of an entrance surface at a point of the part frame, or NaN where there is no surface.
double height_mm(const Entrance& entrance, const Vec2& point_mm);

/// Plane z = height_mm + slope * (x, y) in the part frame.
struct TouchingPlane {
  double height_mm = 0.0;
  Vec2 slope = Vec2::Zero();

  double at(const Vec2& point_mm) const { return height_mm + slope.dot(point_mm); }
};

/// Range of heights and slopes of an entrance surface over the outline of a part.
struct EntranceRange {
  double lowest_mm = 0.0;
  double highest_mm = 0.0;
  Vec2 lowest_at_mm = Vec2::Zero();
  Vec2 highest_at_mm = Vec2::Zero();
  double steepest_slope = 0.0;  ///< maximum slope of all samples
  /// Plane that touches an inclined surface from above and is perpendicular to the axis of this surface. For other
  /// surfaces it is empty, and the horizontal plane at `highest_mm` is used instead.
  std::optional<TouchingPlane> inclined_plane = {};

  /// Returns the height, at a given point, of the plane that touches the surface from above. The incident beam crosses
  /// this plane inside the outline of the part.
  double beam_height_mm(const Vec2& point_mm) const {
    return inclined_plane ? inclined_plane->at(point_mm) : highest_mm;
  }
};

/// Returns the lowest and highest point of an entrance surface within rounding errors. The density of the samples
/// follows from the size of the smallest features.
/// \throw InputError if the surface has no finite height somewhere over the outline
EntranceRange entrance_range(const Entrance& entrance, const Polygon& outline);

/// Point at which the back surface of a part touches the entrance surface or is above it.
struct EntranceContact {
  Vec2 position_mm = Vec2::Zero();
  double back_mm = 0.0;      ///< height of the back surface
  double entrance_mm = 0.0;  ///< height of the entrance surface
};

/// Searches for a point at which the back of a finite part is not below an exact entrance surface. Returns nothing if
/// none is found. The search covers the vertices of the back and points between them, at distances of at most 1/128 of
/// the part's size. Walls along the border of the part are not included.
std::optional<EntranceContact> find_contact(const EntranceSurface& surface, const Part& part);

/// Checks that an inclined surface does not fold over the outline of a part. Above each point of the outline, the
/// surface must have exactly one point, and the angle between its normal and z must be less than 89 degrees. The
/// surface is checked at sample points and between them.
/// \throw InputError with the position of the fold; its message begins with "must"
void check_folds(const EntranceSurface& surface, const Polygon& outline);

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
