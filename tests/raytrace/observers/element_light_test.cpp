// Tests of light that is traced through tangent planes of curved entrance surfaces. The results are compared with
// transforms of the wavefront, plane faces, rays, and the mirror image in a sphere.
#include "raytrace/observers/element_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "raytrace/observers/far_field.h"
#include "raytrace/observers/photometric_geometry.h"
#include "raytrace/observers/surface_reflection.h"
#include "raytrace/observers/tangent_error.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/return_frames.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::element_light_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using Surface = std::shared_ptr<const EntranceSurface>;

constexpr double kArcmin = kDeg / 60.0;
constexpr double kWaveNm = 550.0;
constexpr double kWave = 1e-6 * kWaveNm;

Surface surface_of(const Entrance& entrance) {
  return std::get<Surface>(entrance);
}

BeamPolicy beams(double cutoff = 1e-6) {
  BeamPolicy policy;
  policy.cutoff = cutoff;
  policy.separate_cells = true;
  return policy;
}

ApertureKernel ten_minutes() {
  return ApertureKernel({Angle::from_deg(1.0 / 6.0), Angle::from_deg(1.0 / 6.0)});
}

Vec3 at_angles(double incidence_deg, double azimuth_deg) {
  const double t = incidence_deg * kDeg, p = azimuth_deg * kDeg;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

bool is_near(const Vec3& direction, const Vec3& to_source) {
  return (direction - to_source).norm() < 0.02;
}

/// Light that returns from all elements of a part.
struct Returned {
  std::vector<double> per_sr;  ///< one intensity for each direction
  double fraction = 0.0;       ///< fraction of the incident light that falls on the portions of elements
  double power = 0.0;          ///< power that returns near the source
  TangentError error;
};

Returned returned_light(const Part& part, const Surface& surface, const Optics& optics, const Vec3& to_source,
                        const std::vector<Vec3>& directions) {
  const ElementLight light(part, surface);
  Returned all;
  all.per_sr.assign(directions.size(), 0.0);
  for (const ElementPortion& portion : light.portions(to_source, optics.index)) all.fraction += portion.fraction;
  for (std::size_t k = 0; k < light.element_count(); ++k) {
    const auto scene = light.scene(k, to_source, optics.index);
    if (!scene || !scene->is_lit) continue;
    FarFieldPolicy policy;
    policy.wavelength_nm = kWaveNm;
    const Illumination illumination = illumination_of(*scene, to_source, kUnpolarised);
    FarFieldCollector collector(scene->excerpt.part, illumination, policy);
    trace_element(*scene, optics, illumination, {0.5}, beams(), nullptr, [&](const ReturnedBeam& beam) {
      collector.add(beam);
      if (is_near(beam.direction, scene->to_source)) all.power += scene->power_factor * beam.stokes.i;
      if (is_near(beam.direction, scene->to_source) && beam.stokes.i > 1e-3) all.error.add(*surface, *scene, beam);
    });
    const FarField field = collector.finish();
    for (std::size_t d = 0; d < directions.size(); ++d)
      all.per_sr[d] += scene->power_factor * field.intensity(scene->direction(directions[d]), ten_minutes()).per_sr;
  }
  return all;
}

/// Far field of a plane wave through a convex polygon with a wavefront error, by a discrete transform on a grid of
/// pixels. The total power is 1.
class WavefrontField {
 public:
  WavefrontField(const Polygon& outline, const std::function<double(const Vec2&)>& path_mm) {
    const Rectangle box = bounding_box(outline);
    step_ = box.size() / kPixels;
    first_ = box.lower + 0.5 * step_;
    for (int j = 0; j < kPixels; ++j)
      for (int i = 0; i < kPixels; ++i) {
        const Vec2 p = first_ + Vec2(i, j).cwiseProduct(step_);
        const bool is_inside = contains(outline, p);
        field_.push_back(is_inside ? std::polar(1.0, 2.0 * pi / kWave * path_mm(p)) : 0.0);
        area_mm2_ += is_inside ? step_.prod() : 0.0;
      }
  }

  /// Returns the intensity averaged over the discs of source and receiver, which have the same radius.
  double mean(const Vec2& centre, double radius) const {
    std::vector<Vec2> offsets;
    std::vector<std::vector<std::complex<double>>> rows;
    double sum = 0.0, weights = 0.0;
    constexpr int kHalf = 36;
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double x = centre.x() + 2.0 * radius * i / kHalf;
      const std::vector<std::complex<double>> column = along_x(x);
      for (int j = -kHalf; j <= kHalf; ++j) {
        const Vec2 offset = 2.0 * radius / kHalf * Vec2(i, j);
        const double weight = overlap(offset.norm() / (2.0 * radius));
        if (weight <= 0.0) continue;
        weights += weight;
        sum += weight * std::norm(along_y(column, centre.y() + offset.y()));
      }
    }
    return sum / weights * std::pow(step_.prod(), 2.0) / (kWave * kWave * area_mm2_);
  }

 private:
  static constexpr int kPixels = 360;

  /// Returns the common area of two equal discs, as a fraction of the area of one disc. `distance` is in diameters.
  static double overlap(double distance) {
    if (distance >= 1.0) return 0.0;
    return 2.0 / pi * (std::acos(distance) - distance * std::sqrt(1.0 - distance * distance));
  }
  std::vector<std::complex<double>> along_x(double cosine) const {
    std::vector<std::complex<double>> waves, sums(kPixels);
    for (int i = 0; i < kPixels; ++i)
      waves.push_back(std::polar(1.0, -2.0 * pi / kWave * cosine * (first_.x() + i * step_.x())));
    for (int j = 0; j < kPixels; ++j)
      for (int i = 0; i < kPixels; ++i)
        sums[static_cast<std::size_t>(j)] +=
            waves[static_cast<std::size_t>(i)] * field_[static_cast<std::size_t>(j * kPixels + i)];
    return sums;
  }
  std::complex<double> along_y(const std::vector<std::complex<double>>& sums, double cosine) const {
    std::complex<double> sum = 0.0;
    for (int j = 0; j < kPixels; ++j)
      sum += std::polar(1.0, -2.0 * pi / kWave * cosine * (first_.y() + j * step_.y())) *
             sums[static_cast<std::size_t>(j)];
    return sum;
  }

  Vec2 first_;
  Vec2 step_;
  double area_mm2_ = 0.0;
  std::vector<std::complex<double>> field_;
};

Optics ideal_mirrors() {
  Optics optics = pmma();
  optics.mirror_facets = true;
  optics.lossless_entrance = true;
  return optics;
}

// The part is a cube corner of mirrors behind a sphere of radius R. Light that enters at the position r relative to the
// apex leaves at -r. Across the hexagonal aperture, the returned wave therefore has the additional optical path (n - 1)
// r^2 / R.
//
// The wave also converges on its path of length L in the part. With c = L (n - 1) / (n R), the aperture of the returned
// wave shrinks by the fraction c. The additional optical path increases by the fraction c / 2.
TEST(ElementLight, SphereAgreesWithTheTransformOfItsWavefront) {
  const Part part = build_part(single(HexagonalCube{3.0}, 0.3));
  const Vec2 middle = bounding_box(part.outline).centre();
  const Polygon hexagon = moved(part.outline, -middle);
  for (const double radius_mm : {200.0, 400.0, 1000.0, 1e6}) {
    const double converged = 2.0 * (0.3 + part.element_depth_mm) * (kPmma - 1.0) / (kPmma * radius_mm);
    Polygon exit = hexagon;
    for (Vec2& p : exit) p *= 1.0 - converged;
    const WavefrontField expected(
        exit, [&](const Vec2& p) { return (1.0 + 0.5 * converged) * (kPmma - 1.0) * p.squaredNorm() / radius_mm; });
    std::vector<Vec3> directions;
    std::vector<double> means;
    for (const double minutes : {0.0, 8.0, 15.0, 20.0, 30.0})
      for (const double azimuth_deg : {10.0, 95.0}) {
        directions.push_back(at_angles(minutes / 60.0, azimuth_deg));
        means.push_back(expected.mean(directions.back().head<2>(), 5.0 * kArcmin));
      }
    const Returned found = returned_light(part, surface_of(sphere_entrance(radius_mm, 0.3, middle)), ideal_mirrors(),
                                          Vec3::UnitZ(), directions);
    const double peak = *std::max_element(means.begin(), means.end());
    for (std::size_t k = 0; k < directions.size(); ++k)
      EXPECT_NEAR(found.per_sr[k], means[k], 5e-3 * peak) << radius_mm << " " << k;
    EXPECT_NEAR(found.fraction, 1.0, 1e-6) << radius_mm;
    EXPECT_NEAR(found.power, 1.0, 3e-3) << radius_mm;
  }
}

PartSpec small_honeycomb(double error_arcmin, double thickness_mm = 0.2) {
  PartSpec spec = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 8.0, 6.0, thickness_mm);
  spec.angle_errors.dihedral_error_arcmin.fill(error_arcmin);
  return spec;
}

// The two entrance surfaces are a sphere with a very large radius and an exactly plane surface. Both must give the
// results of the plane entrance face. In the thicker parts, much light meets a side first, or is reflected from one
// element to another.
TEST(ElementLight, PlaneSurfacesEqualThePlaneEntranceFace) {
  struct Case {
    double thickness_mm, incidence_deg;
  };
  for (const auto& [thickness_mm, incidence_deg] :
       {Case{0.2, 0.0}, Case{0.2, 12.0}, Case{1.0, 12.0}, Case{1.0, 40.0}}) {
    const Part part = build_part(small_honeycomb(1.5, thickness_mm));
    const Vec2 middle = bounding_box(part.outline).centre();
    const Vec3 to_source = at_angles(incidence_deg, 40.0);
    FarFieldPolicy policy;
    policy.wavelength_nm = kWaveNm;
    const SourceAngles source = source_angles(to_source);
    const Illumination light{source.incidence, source.azimuth, kUnpolarised};
    const ReturnFrame frame = frame_at(light);
    std::vector<Vec3> directions;
    for (const double minutes : {0.0, 6.0, 12.0, 20.0, 40.0})
      directions.push_back(frame.direction({0.0, minutes * kArcmin}));
    FarFieldCollector collector(part, light, policy);
    double power = 0.0;
    // The cut-off is a fraction of the light on the whole part, and not of the light on a single element.
    BeamTracer(part).trace(pmma(), light, {0.5}, beams(1e-8), nullptr, [&](const ReturnedBeam& beam) {
      if (beam.depth == 0) return;
      collector.add(beam);
      if (is_near(beam.direction, to_source)) power += beam.stokes.i;
    });
    const FarField flat = collector.finish();
    const double peak = flat.intensity(to_source, ten_minutes()).per_sr;
    for (const Entrance& entrance : {plane_entrance(thickness_mm), sphere_entrance(1e6, thickness_mm, middle)}) {
      const Returned found = returned_light(part, surface_of(entrance), pmma(), to_source, directions);
      for (std::size_t k = 0; k < directions.size(); ++k)
        EXPECT_NEAR(found.per_sr[k], flat.intensity(directions[k], ten_minutes()).per_sr, 3e-4 * peak)
            << thickness_mm << " " << incidence_deg << " " << k;
      EXPECT_NEAR(found.power, power, 2e-4) << thickness_mm << " " << incidence_deg;
      EXPECT_NEAR(found.fraction, 1.0, 1e-5) << thickness_mm << " " << incidence_deg;
      EXPECT_LT(found.error.max_angle_rad(), 1e-5) << thickness_mm << " " << incidence_deg;
    }
  }
}

// Behind an inclined plane, a perfect cube corner returns light to its source.
TEST(ElementLight, InclinedPlaneSteersNothing) {
  const Part part = build_part(small_honeycomb(0.0));
  const Surface surface = surface_of(plane_entrance(1.5, 0.12, -0.07));
  const ElementLight light(part, surface);
  for (const Vec3& to_source : {at_angles(0.0, 0.0), at_angles(15.0, 70.0)}) {
    double power = 0.0;
    for (std::size_t k = 0; k < light.element_count(); ++k) {
      const auto scene = light.scene(k, to_source, kPmma);
      if (!scene || !scene->is_lit) continue;
      const Illumination illumination = illumination_of(*scene, to_source, kUnpolarised);
      trace_element(*scene, pmma(), illumination, {0.5}, beams(), nullptr, [&](const ReturnedBeam& beam) {
        for (const DirectionSample& sample : spread_directions(beam))
          if ((sample.direction - scene->to_source).norm() < 1e-9)
            power += scene->power_factor * sample.power_fraction * beam.stokes.i;
      });
    }
    EXPECT_GT(power, 0.4);
  }
}

// The model contains the terms of second order in the curvature, so that the error of the direction is of third order.
// Twice the curvature must give about eight times the error.
TEST(ElementLight, ErrorsAreCubicInTheCurvature) {
  const Part part = build_part(single(HexagonalCube{3.0}, 2.0));
  const Vec2 middle = bounding_box(part.outline).centre();
  std::vector<double> angles;
  for (const double radius_mm : {400.0, 200.0, 100.0}) {
    const Returned found =
        returned_light(part, surface_of(sphere_entrance(radius_mm, 2.0, middle)), ideal_mirrors(), Vec3::UnitZ(), {});
    EXPECT_GT(found.error.rays(), 20U);
    angles.push_back(found.error.max_angle_rad());
  }
  EXPECT_LT(angles[0], 0.05 * kArcmin);
  EXPECT_NEAR(angles[1] / angles[0], 8.0, 2.0);
  EXPECT_NEAR(angles[2] / angles[1], 8.0, 3.0);
}

// A sphere of radius R with the reflectance rho in the illuminance E reflects the intensity rho E R^2 / 4 in every
// direction.
TEST(SurfaceReflection, SphereHasTheIntensityOfItsClosedForm) {
  const Polygon outline = to_polygon({Vec2(0.0, 0.0), Vec2(40.0, 30.0)});
  const double radius_mm = 300.0;
  const Entrance sphere = sphere_entrance(radius_mm, 3.0, {20.0, 15.0});
  const EntranceSurface& surface = *surface_of(sphere);
  for (const double incidence_deg : {0.0, 2.0}) {
    const Vec3 to_source = at_angles(incidence_deg, 30.0);
    const Vec3 receiver = at_angles(incidence_deg + 1.0 / 3.0, 30.0);
    const double per_sr = reflected_per_sr(surface, outline, {3.0, Vec2::Zero()}, to_source, receiver, ten_minutes(),
                                           [](const Vec3&) { return 0.04; });
    const double intensity = per_sr * area(outline) * to_source.z();
    EXPECT_NEAR(intensity, 0.04 * radius_mm * radius_mm / 4.0, 3e-3 * 0.04 * radius_mm * radius_mm / 4.0);
  }
  double power = 0.0;
  visit_reflected(
      surface, outline, {3.0, Vec2::Zero()}, Vec3::UnitZ(), 200, [](const Vec3&) { return 0.04; },
      [&](const Vec3&, double own) { power += own; });
  EXPECT_NEAR(power, 0.04, 1e-6);
}

}  // namespace
}  // namespace retrace::testing::element_light_test
