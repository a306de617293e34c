#pragma once

// Reference model of a cube corner at normal incidence. For each pixel of the aperture, the model follows a ray and its
// field vectors through three reflections. It shares no code with the engine.

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::testing {

/// Wavelength in tests that compare far fields with the pixel model, in nm.
inline constexpr double kPixelCubeWaveNm = 550.0;

/// Parameters of the pixel model.
struct PixelCubeSpec {
  double aperture_mm = 0.5;  ///< diameter of the circle around the hexagonal aperture
  double wavelength_mm = 550e-6;
  bool mirrors = true;  ///< perfect mirrors; otherwise total reflection
  int pixels = 400;     ///< number of pixels across the aperture
  /// Inward normals of the facets, whose planes meet at the apex. The default values are the normals of a perfect cube
  /// corner.
  std::optional<std::array<geometry::Vec3, 3>> normals = {};
  /// Height of the surface above the plane of a facet, positive out of the body, in mm. The two arguments are
  /// coordinates from the centre of the facet, in mm: horizontally along the facet, and down the facet. The function is
  /// null for plane facets.
  std::function<double(double, double)> height = {};
};

/// Far field of one cube corner as a sum over the pixels of its aperture. Each pixel contributes a plane wave in the
/// direction of its outgoing ray, with the phase that this wave has at the apex. The exit pixel and the entry pixel are
/// symmetric about the apex. The model uses this symmetry even for facets with angle errors.
class PixelCube {
 public:
  using Vec2 = geometry::Vec2;
  using Vec3 = geometry::Vec3;
  using Field = Eigen::Matrix<std::complex<double>, 3, 2>;  ///< columns: result for a unit incident field along x and y

  explicit PixelCube(const PixelCubeSpec& spec) : spec_(spec), edge_(spec.aperture_mm / (2.0 * std::sqrt(2.0 / 3.0))) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = 120.0 * static_cast<double>(k) * kDeg;
      edges_[k] = {std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), 1.0 / std::sqrt(3.0)};
    }
    normals_ = spec.normals.value_or(edges_);
    step_mm_ = spec.aperture_mm / spec.pixels;
    for (int j = 0; j < spec.pixels; ++j)
      for (int i = 0; i < spec.pixels; ++i) {
        const Vec2 p = step_mm_ * Vec2(i + 0.5 - 0.5 * spec.pixels, j + 0.5 - 0.5 * spec.pixels);
        if (is_in_aperture(p)) trace(p);
      }
  }

  /// Returns the radiant intensity in a direction, relative to the peak intensity of a perfect cube corner with
  /// mirrors.
  /// \param q direction cosines along x and y
  double at(const Vec2& q) const {
    Field sum = Field::Zero();
    for (const Pixel& pixel : pixels_)
      sum += std::polar(1.0, -wave_number() * (q - pixel.cosines).dot(pixel.leaves)) * pixel.field;
    return 0.5 * sum.squaredNorm() / std::pow(static_cast<double>(pixels_.size()), 2.0);
  }
  double area_mm2() const { return static_cast<double>(pixels_.size()) * step_mm_ * step_mm_; }

 private:
  struct Pixel {
    Vec2 leaves;
    Vec2 cosines;
    Field field;
  };

  double wave_number() const { return 2.0 * std::numbers::pi / spec_.wavelength_mm; }

  bool is_in_aperture(const Vec2& p) const {
    for (int k = 0; k < 3; ++k) {
      const double a = (60.0 * k + 30.0) * kDeg;
      if (std::abs(p.x() * std::cos(a) + p.y() * std::sin(a)) > edge_ / std::numbers::sqrt2) return false;
    }
    return true;
  }

  void trace(const Vec2& place) {
    Field field = Field::Zero();
    field(0, 0) = field(1, 1) = 1.0;
    Vec3 p(place.x(), place.y(), 10.0);
    Vec3 d = -Vec3::UnitZ();
    double path_mm = 0.0;  // geometric path length in the material
    std::array<bool, 3> met{};
    for (int bounce = 0; bounce < 3; ++bounce) {
      double nearest = 1e9;
      std::size_t facet = 3;
      for (std::size_t k = 0; k < 3; ++k) {
        if (met[k] || normals_[k].dot(d) >= -1e-12) continue;
        const double t = -normals_[k].dot(p) / normals_[k].dot(d);
        if (t >= nearest) continue;
        nearest = t;
        facet = k;
      }
      if (facet == 3) return;
      met[facet] = true;
      p += nearest * d;
      path_mm += nearest;
      const double c = -normals_[facet].dot(d);
      if (spec_.height) path_mm += 2.0 * c * height_at(p, facet);
      reflect(normals_[facet], c, d, field);
    }
    // Compute the phase that the wave has at the apex, which is the origin.
    const double at_apex_mm = kPmma * (path_mm - d.dot(p));
    pixels_.push_back({-place, kPmma * d.head<2>(), std::polar(1.0, wave_number() * at_apex_mm) * field});
  }

  double height_at(const Vec3& p, std::size_t facet) const {
    const Vec3& first = edges_[(facet + 1) % 3];
    const Vec3& second = edges_[(facet + 2) % 3];
    const Vec3 from_center = p - 0.5 * edge_ * (first + second);
    return spec_.height((first - second).dot(from_center) / std::numbers::sqrt2,
                        -(first + second).dot(from_center) / std::numbers::sqrt2);
  }

  void reflect(const Vec3& normal, double c, Vec3& d, Field& field) const {
    std::complex<double> rs = -1.0;
    std::complex<double> rp = 1.0;
    if (!spec_.mirrors) {
      // Fresnel's formulae: Born and Wolf, 1.5.2 (20). In total reflection, the sign of the imaginary root is that
      // for the time dependence exp(-i w t).
      const double m = 1.0 / (kPmma * kPmma);
      const std::complex<double> root = std::sqrt(std::complex<double>(m - (1.0 - c * c)));
      rs = (c - root) / (c + root);
      rp = (m * c - root) / (m * c + root);
    }
    const Vec3 s = d.cross(-normal).normalized();
    const Vec3 p_in = d.cross(s);
    d += 2.0 * c * normal;
    const auto along_s = (s.transpose().cast<std::complex<double>>() * field).eval();
    const auto along_p = (p_in.transpose().cast<std::complex<double>>() * field).eval();
    field = rs * s.cast<std::complex<double>>() * along_s + rp * d.cross(s).cast<std::complex<double>>() * along_p;
  }

  PixelCubeSpec spec_;
  double edge_;
  double step_mm_ = 0.0;
  std::array<Vec3, 3> edges_;  ///< unit vectors along the dihedral edges of the perfect cube
  std::array<Vec3, 3> normals_;
  std::vector<Pixel> pixels_;
};

}  // namespace retrace::testing
