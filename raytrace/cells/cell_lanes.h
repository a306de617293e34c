#pragma once

// Inner loops of the cell engine for many rays at a time with SIMD: distances to planes, refraction, branching and
// sums.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "raytrace/light/stokes.h"

/// SIMD loops over many rays. Highway selects the instruction set when the program runs. Rounding errors may differ
/// between instruction sets. They do not depend on the number of threads. The loops read and write up to kPadding
/// values beyond the last ray of an array.
namespace retrace::raytrace::lanes {

inline constexpr std::size_t kPadding = 16;

/// Indices of the arrays that store rays: position in mm (kX to kZ), unit direction (kDx to kDz), Stokes parameters (kI
/// to kV, see Light) and their first axis (kAx to kAz), which may have any length. In finite parts, the position is
/// relative to the origin of a period. The coordinates of this origin in mm are kOx and kOy. If rays belong to numbered
/// paths (CellRay::owner), kOwner is the number of the path.
enum RayComponent : std::size_t {
  kX,
  kY,
  kZ,
  kDx,
  kDy,
  kDz,
  kI,
  kQ,
  kU,
  kV,
  kAx,
  kAy,
  kAz,
  kOx,
  kOy,
  kOwner,
  kRayComponents
};
inline constexpr std::size_t kComponentsOfInfinite = kOx;
inline constexpr std::size_t kComponentsOfFinite = kOwner;

struct Rays {
  std::array<double*, kRayComponents> at{};
  std::size_t component_count =
      kComponentsOfInfinite;  ///< number of arrays: kComponentsOfInfinite, kComponentsOfFinite or kRayComponents

  double* operator[](std::size_t number) const { return at[number]; }
  bool have_periods() const { return component_count >= kComponentsOfFinite; }
};

struct Plane {
  geometry::Vec3 normal = geometry::Vec3::Zero();  ///< unit normal
  double offset_mm = 0.0;
};

/// The linear form c + x px + y py of a point p.
struct LinearForm {
  double x = 0.0, y = 0.0, c = 0.0;
};

/// Label of a ray, such as the face that it meets. The loops select rays by their labels. A label is as wide as a
/// double. A SIMD mask from a comparison of labels can therefore be applied to the values of rays.
using Label = std::int64_t;

/// Kinds of faces that rays meet.
enum class Hit : Label {
  facet,     ///< a facet of the column
  end,       ///< rays inside: top of the back surface; rays outside: plane below all facets
  border,    ///< a border of the column
  crossing,  ///< an interval of a border where rays continue in the neighbouring column
  wall,      ///< an interval of a border where rays meet the wall between surfaces of different height
  limit      ///< the boundary of the region in which the cell engine traces rays
};
inline constexpr Label kLabelStep = 8;  ///< difference between the labels of consecutive faces of one kind

/// Returns the label of rays that meet a face of this kind.
/// \param index Hit::border: index of the border; Hit::crossing and Hit::wall: index of the interval among all
/// intervals of the column's borders
constexpr Label label_of(Hit hit, std::size_t index = 0) {
  return static_cast<Label>(hit) + kLabelStep * static_cast<Label>(index);
}

/// Labels of rays that are kept and of rays that are removed.
inline constexpr Label kKept = 0;
inline constexpr Label kRemoved = 1;

/// Faces that rays have met: one label per ray, and the normal of the facet for rays whose label is Hit::facet.
struct FaceHits {
  Label* labels = nullptr;
  std::array<double*, 3> normal{};
};

/// Moves rays that are inside the part, above the surface of a column. Each ray moves to its nearest face: a facet or a
/// border of the column, or the plane z = `top_mm`.
/// \return the power that the material absorbs on the path
double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const FaceHits& met);

/// Moves rays that are below the surface of a column. Each ray moves to its nearest face: a facet or a border of the
/// column, or the plane z = -depth_mm.
/// \param facets facets of the column; empty for rays that have left the part through these facets, because a ray
///        cannot meet the convex surface of the column again
void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const FaceHits& met);

/// Border of a column. The surface of the neighbouring column may have a different height at the border.
struct Border {
  /// The neighbouring column along one interval of the border.
  struct Interval {
    bool is_flush = true;
    geometry::Vec2 shift = geometry::Vec2::Zero();
    std::span<const LinearForm> heights;  ///< linear forms whose maximum is the height of the neighbouring surface
  };
  std::size_t index = 0;           ///< index of the border among the borders of the column
  std::size_t first_interval = 0;  ///< index of its first interval among all intervals of the column's borders
  LinearForm along;
  std::vector<double> limits;  ///< ends of all intervals except the last, as values of `along`, ascending
  std::vector<Interval> intervals;
  bool inside = true;  ///< true for rays inside the part, false for rays below the surface
};

/// Determines whether rays at a border continue in the neighbouring column or meet a wall. The labels of these rays
/// change from Hit::border to Hit::crossing or Hit::wall.
void refine(const Rays& rays, std::size_t count, const Border& border, Label* labels);

/// Copies the rays with the label `wanted` and returns their number.
/// \param to may be equal to `from`
std::size_t select(const Label* labels, Label wanted, std::size_t count, const Rays& from, const Rays& to);

/// Sets the label of each ray to the index of the first polygon that contains the ray in x and y. A polygon contains a
/// ray if all linear forms of the polygon are >= 0 at the position of the ray. If no polygon contains the ray, the
/// label is set to the number of polygons.
/// \param first_form index of the first form of each polygon, followed by the total number of forms
void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, Label* labels);

/// Sets the labels of rays with less power than `limit` to kRemoved, and the other labels to kKept. Returns the number
/// of rays below the limit.
std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, Label* labels);

/// Converts positions to the coordinates of another column or period. `shift` is added to the positions and subtracted
/// from the origins of their periods.
void shift(const Rays& rays, std::size_t count, const geometry::Vec2& shift);

/// Parameters of mark_beyond(): a height difference, and a rectangle in x and y on the part.
struct BoundsTest {
  double height_mm = 0.0;  ///< height difference by which rays are extrapolated along their directions
  geometry::Vec2 lower = geometry::Vec2::Zero();
  geometry::Vec2 upper = geometry::Vec2::Zero();
};
/// Marks rays that are outside of the rectangle after they are extrapolated by the height difference. Only rays with
/// the label `tested` are tested. The label of a marked ray becomes `beyond`. Returns the number of marked rays.
/// \pre rays.have_periods()
std::size_t mark_beyond(const Rays& rays, std::size_t count, const BoundsTest& reach, Label tested, Label beyond,
                        Label* labels);

/// Rays that have met faces of one kind, and the parameters for the choice of their branches (reflected and transmitted
/// light). Both branches are traced if each has at least `split_power`. Otherwise, one branch is chosen with a
/// probability proportional to its power, and it receives the power of both branches. The choices are stratified over
/// the sequence of rays. They are unbiased if `start` is a uniform random number in [0, 1).
struct FaceInteraction {
  FaceHits hits;
  Label label = 0;             ///< label of the rays that have met the faces
  double towards_light = 1.0;  ///< factor by which normals are multiplied so that they face the light
  double split_power = 0.0;
  double start = 0.0;
};
struct Branches {
  std::size_t count = 0;  ///< number of rays that met the faces
  std::size_t reflected = 0;
  std::size_t transmitted = 0;
};

/// Computes the branches of rays at interfaces between transparent media. Appends them to `reflected` and
/// `transmitted`.
/// \param index_ratio refractive index before the face divided by the index after the face
Branches meet_faces(const Rays& rays, std::size_t count, const FaceInteraction& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted);

/// Reflects rays at perfect mirrors and appends them to `reflected`. Returns the number of reflected rays.
std::size_t meet_mirrors(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Rays& reflected);

/// Parameters of meet_entrance(): the entrance face, at `height_mm` above the rays that rise to it, and the acceptance
/// cones (LightSetup::cone_chord2).
struct Entrance {
  double height_mm = 0.0;
  double index = 1.0;
  double absorption_per_mm = 0.0;
  bool is_lossless = false;
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  std::span<const double> cone_chord2;
};
struct Arrivals {
  std::size_t count = 0;
  std::size_t reflected = 0;
  std::size_t exited = 0;
  double absorbed = 0.0;  ///< power that the material absorbs on the path to the entrance face
};
/// Moves rays that rise to the entrance face up to this face, and computes their branches there. The Stokes parameters
/// of light that leaves are added to the element of `returned` for the narrowest cone that contains the light. The
/// first axis of these Stokes parameters is source_axis().
/// \param reflected receives the rays that the face reflects
/// \param returned sums for each cone; the last element is the sum for light outside of all cones
/// \param left receives the rays that leave through the entrance face; may be null
Arrivals meet_entrance(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left);

/// Moves descending rays along their directions by the height difference `height_mm` to z = `top_mm`. Their positions
/// are then wrapped into the period that starts at the origin.
/// \return the power that the material absorbs
double descend(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
               double absorption_per_mm);

/// Returns the total power of rays.
double sum(const Rays& rays, std::size_t count);

/// Power and number of the rays with the label `wanted`.
struct PowerSum {
  double power = 0.0;
  std::size_t count = 0;
};
PowerSum sum_of(const Label* labels, Label wanted, const Rays& rays, std::size_t count);

/// Computes the points `first` to `first + count - 1` of SobolSquare(key_x, key_y), multiplied by `size`. The results
/// are identical to those of SobolSquare.
void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y);

}  // namespace retrace::raytrace::lanes
