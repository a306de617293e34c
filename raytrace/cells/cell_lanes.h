#pragma once

// The inner loops of the cell engine over many rays at once in SIMD lanes: distances to planes, refraction, branching,
// sums.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "raytrace/light/stokes.h"

/// Loops over many rays at once, in as many lanes as the processor has: the instruction set is chosen when the program
/// runs (Highway). Sums and roundings may differ from one instruction set to another, never with the number of threads.
/// Arrays are read and written up to kPadding values beyond the last.
namespace retrace::raytrace::lanes {

inline constexpr std::size_t kPadding = 16;

/// The arrays of rays: place (mm), direction, Stokes parameters (as in Light) and their first axis, of any length; in
/// finite parts also where on the part the period stands in which the place is given; of rays that are told apart also
/// the number of their owner.
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
  std::size_t numbers = kNumbersOfEndless;  ///< that there are; else kNumbersOfFinite or kRayNumbers

  double* operator[](std::size_t number) const { return at[number]; }
  bool have_periods() const { return numbers >= kNumbersOfFinite; }
};

struct Plane {
  geometry::Vec3 normal = geometry::Vec3::Zero();  ///< unit
  double offset_mm = 0.0;
};

/// c + x px + y py.
struct LinearForm {
  double x = 0.0, y = 0.0, c = 0.0;
};

/// What rays have met, in `which`: 0 a facet, with its normal; 1 the top of the surface (inside) or nothing (outside,
/// below everything); 2 + k border k.
struct Met {
  double* which = nullptr;
  std::array<double*, 3> normal{};
};

/// Rays above the surface of a column to the nearest of its facets, its top and its borders. Returns the power that the
/// material absorbs on the way.
double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const Met& met);

/// Rays below the surface of a column to its facets, its borders, or down to -depth_mm. \param facets none for rays
/// that have just left this surface: over one column it is convex
void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const Met& met);

/// A border of a column behind which the surface may stand at another height.
struct Border {
  struct Stretch {
    bool is_level = true;
    geometry::Vec2 shift = geometry::Vec2::Zero();
    std::span<const LinearForm> heights;  ///< of the surface beyond: the highest of them
  };
  LinearForm along;
  std::vector<double> limits;  ///< ends of all stretches but the last, ascending
  std::vector<Stretch> stretches;
  bool inside = true;  ///< rays go on above the surface beyond; else below it
};

/// Rays at the border numbered `number` get `to` + 2 k if they go on beyond stretch k, one more if they meet the wall
/// there.
void refine(const Rays& rays, std::size_t count, const Border& border, double number, double to, double* which);

/// Copies those rays whose `which` is `wanted` and tells how many they are. \param to may be `from`
std::size_t select(const double* which, double wanted, std::size_t count, const Rays& from, const Rays& to);

/// `which` = number of the first polygon of which no form is negative; count of the polygons if there is none.
/// \param first_form of each polygon, and one more
void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, double* which);

/// `which` = 1 where power is less than `limit`, else 0; tells how many.
std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, double* which);

/// Places by another period's coordinates.
void shift(const Rays& rays, std::size_t count, const geometry::Vec2& shift);

/// `which` = `number` for those rays that, moved on to a height, lie outside a rectangle on the part; the rest stays.
/// Only rays whose `which` is `of` are asked. Tells how many. \pre rays.have_periods()
struct Reach {
  double height_mm = 0.0;  ///< of the goal above the rays, along their way; 0: where they are
  geometry::Vec2 lower = geometry::Vec2::Zero();
  geometry::Vec2 upper = geometry::Vec2::Zero();
};
std::size_t mark_beyond(const Rays& rays, std::size_t count, const Reach& reach, double of, double number,
                        double* which);

/// Those rays that have met the same, and how they take the two branches of a face: both, where each has at least
/// `split_power`; else one by its share of the power, which it gets whole. Choices are spread evenly over the order of
/// the rays, each with its probability for `start` uniform in [0, 1).
struct Meeting {
  Met met;
  double number = 0.0;         ///< of those concerned
  double towards_light = 1.0;  ///< times the normals: against the light
  double split_power = 0.0;
  double start = 0.0;
};
struct Branches {
  std::size_t count = 0;  ///< of rays that met the faces
  std::size_t reflected = 0;
  std::size_t transmitted = 0;
};

/// Both branches of rays at faces, one after the other into `reflected` and `transmitted`.
/// \param index_ratio before over after
Branches meet_faces(const Rays& rays, std::size_t count, const Meeting& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted);

/// Perfect mirrors. Returns how many rays meet them.
std::size_t meet_mirrors(const Rays& rays, std::size_t count, const Meeting& meeting, const Rays& reflected);

/// The entrance face from below, at a height above rays that rise: what leaves is added by the narrowest cone that
/// holds it, along source_axis().
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
  double absorbed = 0.0;  ///< power, on the way up
};
/// \param reflected at the entrance \param returned one for each cone, and one for outside all
/// \param left gets what leaves through the entrance; null: it is not kept
Arrivals meet_entrance(const Rays& rays, std::size_t count, const Meeting& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left);

/// Rays down by a height, back into the period that starts at the origin, to z = `top_mm`. \return the power absorbed
double fall(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
            double absorption_per_mm);

/// Power of all rays.
double sum(const Rays& rays, std::size_t count);

/// Power of those whose `which` is `wanted`, and how many they are.
struct Share {
  double power = 0.0;
  std::size_t count = 0;
};
Share sum_of(const double* which, double wanted, const Rays& rays, std::size_t count);

/// Points first..first + count - 1 of SobolSquare(key_x, key_y), bit for bit, times `size`.
void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y);

}  // namespace retrace::raytrace::lanes
