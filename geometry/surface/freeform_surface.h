#pragma once

// Freeform surfaces z(x, y) with exact derivatives: what is turned on a lathe, and what light enters through.

#include <optional>
#include <vector>

#include "core/error.h"
#include "geometry/surface/boundary.h"
#include "geometry/surface/lenslet.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// How the base goes on outside of the region in which it is defined.
struct Extrapolation {
  Boundary boundary;
  int order = 2;  ///< degree n of the polynomials along radial lines: C^n
};

/// What defines the surface at a place.
enum class Zone { base, extrapolation, lenslet, blend };

/// The explicit surface z(x, y) of a part, material below it: a base with its extrapolation and lenslets.
class FreeformSurface {
 public:
  /// \throw InputError at `where` for lenslets whose blends overlap
  FreeformSurface(Sag base, std::optional<Extrapolation> extrapolation, std::vector<Lenslet> lenslets,
                  const InputLocation& where);

  /// z in mm with all derivatives that T carries (double, jets::Gradient, jets::Jet2 or jets::Series<double>); not
  /// finite where there is no value.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const;

  /// The base alone, with its extrapolation.
  template <class T>
  T evaluate_base(const T& x_mm, const T& y_mm) const;

  double height_mm(double x_mm, double y_mm) const { return evaluate(x_mm, y_mm); }
  /// Height and both slopes.
  jets::Gradient gradient(double x_mm, double y_mm) const {
    return evaluate(jets::Gradient(x_mm, 1.0, 0.0), jets::Gradient(y_mm, 0.0, 1.0));
  }
  Zone zone_at(double x_mm, double y_mm) const;

  const Sag& base() const { return base_; }
  const std::optional<Extrapolation>& extrapolation() const { return extrapolation_; }
  const std::vector<Lenslet>& lenslets() const { return lenslets_; }
  /// Nothing but a polynomial, everywhere.
  bool is_polynomial_everywhere() const { return lenslets_.empty() && !extrapolation_ && is_polynomial(base_); }

 private:
  template <class T>
  T extrapolated(const T& x_mm, const T& y_mm) const;
  template <class T>
  T evaluate_blend(const Lenslet& lenslet, const T& x_mm, const T& y_mm) const;
  /// The lenslet whose outer boundary holds the point; null if none does.
  const Lenslet* lenslet_at(double x_mm, double y_mm) const;
  void sort_into_grid(const InputLocation& where);

  Sag base_;
  std::optional<Extrapolation> extrapolation_;
  std::vector<Lenslet> lenslets_;
  // Square cells, each with the lenslets that reach into it.
  Vec2 grid_low_ = Vec2::Zero();
  double cell_mm_ = 1.0;
  long columns_ = 0;
  long rows_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;
};

/// Puts the lenslet's frame on the base at (x, y): its origin `height_mm` above the base along its normal, its z axis
/// the normal if `tilted`. \throw InputError where the base has no finite slope
void place_on_base(Lenslet& lenslet, const FreeformSurface& base, double x_mm, double y_mm, double height_mm,
                   bool tilted, const InputLocation& where);

/// Slopes above this are taken for vertical: 89 degrees.
inline constexpr double kSteepestSlope = 57.28996163075943;

/// \throw InputError naming the place within `radius_mm` of the origin where the surface has no finite height or a
/// vertical slope, sampled on circles
void check_surface(const FreeformSurface& surface, double radius_mm, const InputLocation& where);

}  // namespace retrace::geometry
