#pragma once

// Freeform surfaces z(x, y) with exact derivatives, for surfaces turned on a lathe and for entrance surfaces.

#include <optional>
#include <vector>

#include "core/error.h"
#include "geometry/surface/boundary.h"
#include "geometry/surface/lenslet.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Continuation of the base surface outside the region in which it is defined.
struct Extrapolation {
  Boundary boundary;
  int order = 2;  ///< degree n of the polynomials along radial lines; the surface is C^n
};

/// Component of the surface that determines the height at a point.
enum class Zone { base, extrapolation, lenslet, blend };

/// Explicit surface z(x, y) of a part: a base with its extrapolation and lenslets. The material is below the surface.
class FreeformSurface {
 public:
  /// \throw InputError at `where` if the blends of lenslets overlap
  FreeformSurface(Sag base, std::optional<Extrapolation> extrapolation, std::vector<Lenslet> lenslets,
                  const InputLocation& where);

  /// Returns z in mm with all derivatives of the type T (double, jets::Gradient, jets::Jet2 or jets::Series<double>).
  /// The result is not finite where the surface is undefined.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const;

  /// Returns z of the base with its extrapolation, without lenslets.
  template <class T>
  T evaluate_base(const T& x_mm, const T& y_mm) const;

  double height_mm(double x_mm, double y_mm) const { return evaluate(x_mm, y_mm); }
  /// Returns the height and both slopes.
  jets::Gradient gradient(double x_mm, double y_mm) const {
    return evaluate(jets::Gradient(x_mm, 1.0, 0.0), jets::Gradient(y_mm, 0.0, 1.0));
  }
  Zone zone_at(double x_mm, double y_mm) const;

  const Sag& base() const { return base_; }
  const std::optional<Extrapolation>& extrapolation() const { return extrapolation_; }
  const std::vector<Lenslet>& lenslets() const { return lenslets_; }
  /// Returns true if the surface is a single polynomial everywhere.
  bool is_polynomial_everywhere() const { return lenslets_.empty() && !extrapolation_ && is_polynomial(base_); }

 private:
  template <class T>
  T extrapolated(const T& x_mm, const T& y_mm) const;
  template <class T>
  T evaluate_blend(const Lenslet& lenslet, const T& x_mm, const T& y_mm) const;
  /// Returns the lenslet whose outer boundary contains the point, or null.
  const Lenslet* lenslet_at(double x_mm, double y_mm) const;
  void sort_into_grid(const InputLocation& where);

  Sag base_;
  std::optional<Extrapolation> extrapolation_;
  std::vector<Lenslet> lenslets_;
  // Grid of square cells. Each cell lists the lenslets that overlap it.
  Vec2 grid_low_ = Vec2::Zero();
  double cell_mm_ = 1.0;
  long columns_ = 0;
  long rows_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;
};

/// Places a lenslet on the base at (x, y). The origin of its frame is `height_mm` above the base along the normal of
/// the base. If `tilted` is true, the z axis of the frame is this normal.
/// \throw InputError if the base has no finite slope there
void place_on_base(Lenslet& lenslet, const FreeformSurface& base, double x_mm, double y_mm, double height_mm,
                   bool tilted, const InputLocation& where);

/// Slope above which a surface counts as vertical: the tangent of 89 degrees.
inline constexpr double kMaxSlope = 57.28996163075943;

/// Checks the surface within `radius_mm` of the origin at samples on circles.
/// \throw InputError with the position at which the height is not finite or the slope is vertical
void check_surface(const FreeformSurface& surface, double radius_mm, const InputLocation& where);

}  // namespace retrace::geometry
