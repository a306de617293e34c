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

/// SIMD loops over many rays. Highway selects the instruction set when the program runs. Sums and rounding may differ
/// between instruction sets, but not with the number of threads. Arrays are read and written up to kPadding values
/// beyond the last ray.
namespace retrace::raytrace::lanes {

inline constexpr std::size_t kPadding = 16;

/// Arrays of rays: position (mm), direction, Stokes parameters (see Light) and the first axis of the Stokes parameters,
/// which may have any length. For finite parts, there is also the origin of the period to which the position is
/// relative. If rays have owners (see CellWalker), the last array contains the numbers of the owners.
enum RayNumber : std::size_t {
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
  kRayNumbers
};
inline constexpr std::size_t kNumbersOfEndless = kOx;
inline constexpr std::size_t kNumbersOfFinite = kOwner;

struct Rays {
  std::array<double*, kRayNumbers> at{};
  std::size_t numbers = kNumbersOfEndless;  ///< number of arrays: kNumbersOfEndless, kNumbersOfFinite or kRayNumbers

  double* operator[](std::size_t number) const { return at[number]; }
  bool have_periods() const { return numbers >= kNumbersOfFinite; }
};

struct Plane {
  geometry::Vec3 normal = geometry::Vec3::Zero();  ///< unit normal
  double offset_mm = 0.0;
};

/// The linear form c + x px + y py of a point p.
struct LinearForm {
  double x = 0.0, y = 0.0, c = 0.0;
};

/// Label of a ray, by which the loops select rays. Labels are as wide as doubles, so that a mask from a comparison of
/// labels can be applied to the values of rays.
using Label = std::int64_t;

/// Kinds of faces that rays meet.
enum class Hit : Label {
  facet,     ///< a facet of the column
  end,       ///< inside: the top of the surface; outside: the plane below all facets, where a ray has met nothing
  border,    ///< a border of the column
  crossing,  ///< an interval of a border, at which the ray continues in the neighbouring column
  wall,      ///< an interval of a border, at which the ray meets the wall between surfaces of different height
  limit      ///< the limit of the region in which the cell engine traces rays
};
inline constexpr Label kLabelStep = 8;  ///< difference between the labels of consecutive faces of one kind

/// Returns the label of rays that meet a face of this kind.
/// \param index number of the border, or of the interval among all intervals of the column's borders
constexpr Label label_of(Hit hit, std::size_t index = 0) {
  return static_cast<Label>(hit) + kLabelStep * static_cast<Label>(index);
}

/// Labels that mark rays for removal.
inline constexpr Label kKept = 0;
inline constexpr Label kRemoved = 1;

/// Faces that rays have met: one label per ray, and the normal of the facet for rays whose label is Hit::facet.
struct Met {
  Label* labels = nullptr;
  std::array<double*, 3> normal{};
};

/// Moves each ray above the surface of a column to the nearest of the column's facets, its top and its borders.
/// \return the power that the material absorbs on the path
double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const Met& met);

/// Moves each ray below the surface of a column to the nearest of the column's facets, its borders and the plane z =
/// -depth_mm.
/// \param facets facets of the column; empty for rays that have just left these facets, because a ray cannot meet a
///        convex surface again after leaving it
void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const Met& met);

/// A border of a column behind which the surface may have a different height.
struct Border {
  struct Stretch {
    bool is_level = true;
    geometry::Vec2 shift = geometry::Vec2::Zero();
    std::span<const LinearForm> heights;  ///< the height of the surface behind the border is their maximum
  };
  std::size_t index = 0;           ///< index of the border among the borders of the column
  std::size_t first_interval = 0;  ///< index of its first interval among all intervals of the column's borders
  LinearForm along;
  std::vector<double> limits;  ///< ends of all intervals along the border except the last, ascending
  std::vector<Stretch> stretches;
  bool inside = true;  ///< true if rays continue above the surface, false if below
};

/// Determines what rays meet at a border. Their labels change from Hit::border to Hit::crossing or Hit::wall.
void refine(const Rays& rays, std::size_t count, const Border& border, Label* labels);

/// Copies the rays with the label `wanted` and returns their number.
/// \param to may be equal to `from`
std::size_t select(const Label* labels, Label wanted, std::size_t count, const Rays& from, const Rays& to);

/// Sets the label of each ray to the index of the first polygon that contains the ray, which means that all of its
/// linear forms are at least 0 at the position of the ray. If there is no such polygon, the label becomes the number of
/// polygons.
/// \param first_form index of the first form of each polygon, followed by the total number of forms
void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, Label* labels);

/// Sets the labels of rays with less power than `limit` to kRemoved, and the other labels to kKept. Returns the number
/// of rays below the limit.
std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, Label* labels);

/// Converts positions to the coordinates of another period.
void shift(const Rays& rays, std::size_t count, const geometry::Vec2& shift);

/// Parameters of mark_beyond(). That function extrapolates rays to a height and tests whether they are then outside of
/// a rectangle on the part. If so, their label becomes `beyond`. Only rays with the label `tested` are tested. The
/// function returns the number of marked rays.
/// \pre rays.have_periods()
struct Reach {
  double height_mm = 0.0;  ///< height difference by which rays are extrapolated along their direction; 0 for none
  geometry::Vec2 lower = geometry::Vec2::Zero();
  geometry::Vec2 upper = geometry::Vec2::Zero();
};
std::size_t mark_beyond(const Rays& rays, std::size_t count, const Reach& reach, Label tested, Label beyond,
                        Label* labels);

/// Rays that have met faces of one kind, and the parameters by which branches are chosen. Both branches are traced if
/// each has at least `split_power`. Otherwise, one branch is chosen in proportion to its power and receives the power
/// of both. The choices are stratified over the sequence of rays. They are unbiased if `start` is a uniform random
/// number in [0, 1).
struct Meeting {
  Met met;
  Label label = 0;             ///< label of the selected rays
  double towards_light = 1.0;  ///< factor by which normals are multiplied so that they face the light
  double split_power = 0.0;
  double start = 0.0;
};
struct Branches {
  std::size_t count = 0;  ///< number of rays that met the faces
  std::size_t reflected = 0;
  std::size_t transmitted = 0;
};

/// Appends the branches of rays at faces to `reflected` and `transmitted`.
/// \param index_ratio refractive index before the face divided by the index after the face
Branches meet_faces(const Rays& rays, std::size_t count, const Meeting& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted);

/// Reflects rays at perfect mirrors. Returns the number of rays that meet them.
std::size_t meet_mirrors(const Rays& rays, std::size_t count, const Meeting& meeting, const Rays& reflected);

/// The entrance face, at a given height above the rays that rise to it. The Stokes parameters of light that leaves are
/// added to the sums of the narrowest cone that contains the light. Their first axis is source_axis().
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
  std::size_t left = 0;
  double absorbed = 0.0;  ///< power that the material absorbs on the path to the entrance face
};
/// Processes rays that rise to the entrance face.
/// \param reflected receives the rays that the face reflects
/// \param returned sums for each cone, and for light outside of all cones
/// \param left receives the rays that leave through the entrance face; may be null
Arrivals meet_entrance(const Rays& rays, std::size_t count, const Meeting& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left);

/// Moves descending rays along their directions by the height difference `height_mm` to z = `top_mm`. Their positions
/// are then wrapped into the period that starts at the origin.
/// \return the power that the material absorbs
double fall(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
            double absorption_per_mm);

/// Returns the total power of rays.
double sum(const Rays& rays, std::size_t count);

/// Power and number of the rays with the label `wanted`.
struct Share {
  double power = 0.0;
  std::size_t count = 0;
};
Share sum_of(const Label* labels, Label wanted, const Rays& rays, std::size_t count);

/// Computes the points `first` to `first + count - 1` of SobolSquare(key_x, key_y), multiplied by `size`. The results
/// are identical to those of SobolSquare.
void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y);

}  // namespace retrace::raytrace::lanes
