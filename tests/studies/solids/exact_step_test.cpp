#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "geometry/entrance/exact_boundary.h"
#include "geometry/io/step_file.h"
#include "geometry/part/welded_part.h"
#include "tests/studies/solids/solid_specs.h"
#include "tests/studies/solids/step_reader.h"
#include "tests/support/entrance_surfaces.h"

// Tests of STEP solids with an exact entrance face. OpenCASCADE reads them back. Volumes are compared with closed forms
// or with Simpson's rule.

namespace retrace::geometry::exact_step_test {
namespace {

using test::StepFindings;

constexpr double kSideMm = 3.0;
constexpr double kHeightMm = 0.9;

/// Returns a part of 36 prisms over a square of 3 mm x 3 mm.
Part prisms() {
  return build_welded_part(test::array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, kSideMm, kSideMm));
}

double volume_of_prisms_mm3() {
  return 36.0 * test::prism_volume_mm3(0.5, 0.5);
}

/// Returns a surface whose origin is above the centre of the square.
std::shared_ptr<const EntranceSurface> surface_over_centre(const Sag& sag) {
  return std::make_shared<const EntranceSurface>(FreeformSurface(sag, std::nullopt, {}, {}),
                                                 Vec3(0.5 * kSideMm, 0.5 * kSideMm, kHeightMm));
}

/// Integrates a function over the square by Simpson's rule.
double integral_over_square(const std::function<double(double, double)>& f) {
  constexpr int kCells = 200;
  const auto weight = [](int k) { return k == 0 || k == kCells ? 1.0 : k % 2 == 1 ? 4.0 : 2.0; };
  double sum = 0.0;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) sum += weight(i) * weight(j) * f(kSideMm * i / kCells, kSideMm * j / kCells);
  return sum * std::pow(kSideMm / kCells / 3.0, 2.0);
}

/// Writes and reads a solid, and compares the figures of OpenCASCADE with those of the boundary.
StepFindings expect_exact_solid(const ExactBoundary& boundary) {
  const auto file = std::filesystem::temp_directory_path() / ("retrace_exact_" + std::to_string(::getpid()) + ".step");
  std::ofstream(file, std::ios::binary) << step_text(boundary.solid, "test");
  const StepFindings found = test::read_step(file.string());
  std::filesystem::remove(file);
  EXPECT_TRUE(found.is_read);
  EXPECT_EQ(found.solids, 1);
  EXPECT_EQ(found.shells, 1);
  EXPECT_TRUE(found.is_valid);
  EXPECT_EQ(found.free_edges, 0);
  EXPECT_NEAR(found.volume_mm3, boundary.volume_mm3, 1e-6 * boundary.volume_mm3);
  EXPECT_NEAR(found.area_mm2, boundary.area_mm2, 1e-6 * boundary.area_mm2);
  return found;
}

TEST(ExactStep, SphericalFacesAreSpheres) {
  for (const double radius_mm : {8.0, -12.0}) {
    Sag sag;
    sag.asphere.curvature_per_mm = -1.0 / radius_mm;
    const ExactSphere sphere{Vec3(1.5, 1.5, kHeightMm - radius_mm), Vec3(0.0, 0.0, radius_mm > 0.0 ? 1.0 : -1.0),
                             std::abs(radius_mm), radius_mm > 0.0};
    const ExactBoundary boundary = exact_boundary(prisms(), *surface_over_centre(sag), sphere, 1e-6);
    const double volume_mm3 =
        volume_of_prisms_mm3() + integral_over_square([&](double x, double y) {
          const double r2 = std::pow(x - 1.5, 2.0) + std::pow(y - 1.5, 2.0);
          return kHeightMm - r2 / (radius_mm * (1.0 + std::sqrt(1.0 - r2 / (radius_mm * radius_mm))));
        });
    EXPECT_NEAR(boundary.volume_mm3, volume_mm3, 1e-9 * volume_mm3);
    const StepFindings found = expect_exact_solid(boundary);
    EXPECT_EQ(found.spheres, 1) << radius_mm;
    EXPECT_EQ(found.planes, found.faces - 1) << radius_mm;
    EXPECT_EQ(boundary.entrance_error_mm, 0.0);
  }
}

// The area below a circular arc of half width w is w sqrt(R^2 - w^2) + R^2 asin(w / R), above its centre.
TEST(ExactStep, CylindricalFacesAreCylinders) {
  constexpr double kHalf = 0.5 * kSideMm;
  for (const double radius_mm : {5.0, -7.0}) {
    const double size_mm = std::abs(radius_mm);
    const double sign = radius_mm > 0.0 ? 1.0 : -1.0;
    Sag sag;
    sag.asphere = {-1.0 / radius_mm, 0.0, {}, Asphere::Across::x};
    const ExactCylinder cylinder{Vec3(1.5, 1.5, kHeightMm - radius_mm), Vec3::UnitY(), sign * Vec3::UnitZ(), size_mm,
                                 radius_mm > 0.0};
    const ExactBoundary boundary = exact_boundary(prisms(), *surface_over_centre(sag), cylinder, 1e-6);
    const double arc_mm2 =
        kHalf * std::sqrt(size_mm * size_mm - kHalf * kHalf) + size_mm * size_mm * std::asin(kHalf / size_mm);
    const double below_mm2 = (kHeightMm - radius_mm) * kSideMm + sign * arc_mm2;
    const double volume_mm3 = volume_of_prisms_mm3() + kSideMm * below_mm2;
    EXPECT_NEAR(boundary.volume_mm3, volume_mm3, 1e-10 * volume_mm3);
    EXPECT_EQ(expect_exact_solid(boundary).cylinders, 1) << radius_mm;
  }
}

TEST(ExactStep, InclinedPlanesAreOneFace) {
  Sag sag;
  sag.polynomial = XyPolynomial{1.0, 1, {0.0, 0.02, 0.05}};
  const ExactPlane plane{Vec3(1.5, 1.5, kHeightMm), Vec3(-0.05, -0.02, 1.0).normalized()};
  const ExactBoundary boundary = exact_boundary(prisms(), *surface_over_centre(sag), plane, 1e-6);
  EXPECT_NEAR(boundary.volume_mm3, kSideMm * kSideMm * kHeightMm + volume_of_prisms_mm3(), 1e-10);
  const StepFindings found = expect_exact_solid(boundary);
  EXPECT_EQ(found.planes, found.faces);
}

// The outline is a hexagon, whose oblique sides cut cylinders in ellipses and spheres in circles.
TEST(ExactStep, ObliqueSidesHaveExactEdges) {
  const Part hexagon = build_welded_part(test::single_part(HexagonalCube{1.6}));
  const Vec2 centre = bounding_box(hexagon.outline).centre();
  Sag sphere;
  sphere.asphere.curvature_per_mm = -1.0 / 6.0;
  Sag cylinder;
  cylinder.asphere = {-1.0 / 6.0, 0.0, {}, Asphere::Across::x};
  const Vec3 origin(centre.x(), centre.y(), kHeightMm);
  const Vec3 middle = origin - 6.0 * Vec3::UnitZ();
  const auto made = [&](const Sag& sag, const FaceSurface& surface) {
    return exact_boundary(hexagon, EntranceSurface(FreeformSurface(sag, std::nullopt, {}, {}), origin), surface, 1e-6);
  };
  EXPECT_EQ(expect_exact_solid(made(sphere, ExactSphere{middle, Vec3::UnitZ(), 6.0, true})).spheres, 1);
  EXPECT_EQ(
      expect_exact_solid(made(cylinder, ExactCylinder{middle, Vec3::UnitY(), Vec3::UnitZ(), 6.0, true})).cylinders, 1);
}

TEST(ExactStep, OtherSurfacesAreSplinesWithinTheTolerance) {
  Sag biconic;
  biconic.biconic = Biconic{{-1.0 / 10.0, -1.0 / 25.0}, {-0.5, 0.3}};
  Sag wave;
  wave.formula = parse_formula("0.05 * cos(2 * x) * cos(3 * y)", {"x", "y"}, {});
  for (const Sag& sag : {biconic, wave})
    for (const double tolerance_mm : {1e-4, 1e-6}) {
      const auto surface = surface_over_centre(sag);
      const ExactBoundary boundary = exact_boundary(prisms(), *surface, std::nullopt, tolerance_mm);
      EXPECT_LE(boundary.entrance_error_mm, tolerance_mm);
      const auto& patch = std::get<SplinePatch>(boundary.solid.entrance->surface);
      for (int k = 0; k < 1000; ++k) {
        const Vec2 at(kSideMm * std::fmod(0.754877666 * k, 1.0), kSideMm * std::fmod(0.569840291 * k, 1.0));
        EXPECT_NEAR(patch.height_mm(at), surface->at(at).height_mm, 1.1 * tolerance_mm);
      }
      const double volume_mm3 = volume_of_prisms_mm3() + integral_over_square([&](double x, double y) {
                                  return surface->at({x, y}).height_mm;
                                });
      EXPECT_NEAR(boundary.volume_mm3, volume_mm3, 1e-8 * volume_mm3);
      const StepFindings found = expect_exact_solid(boundary);
      EXPECT_EQ(found.splines, 1);
      EXPECT_EQ(found.planes, found.faces - 1);
    }
}

// A surface that ends close to the part, such as half an ellipsoid, is continued outside the part.
TEST(ExactStep, SurfacesThatEndAtTheOutlineAreSplines) {
  const Part hexagon = build_welded_part(test::single_part(HexagonalCube{1.6}));
  const Vec2 centre = bounding_box(hexagon.outline).centre();
  Sag sag;  // defined within 1 mm of the centre; the corners of the bounding box are 1.06 mm away
  sag.formula = parse_formula("0.02 * sqrt(1 - r^2)", {"x", "y", "r"}, {});
  const EntranceSurface surface(FreeformSurface(sag, std::nullopt, {}, {}), Vec3(centre.x(), centre.y(), kHeightMm),
                                0.4);
  const ExactBoundary boundary = exact_boundary(hexagon, surface, std::nullopt, 1e-5);
  EXPECT_LE(boundary.entrance_error_mm, 1e-5);
  EXPECT_EQ(expect_exact_solid(boundary).splines, 1);
}

TEST(ExactStep, SizesOfFilesArePredicted) {
  Sag sag;
  sag.biconic = Biconic{{-1.0 / 30.0, -1.0 / 45.0}, {0.0, 0.0}};
  const EntranceSurface surface(FreeformSurface(sag, std::nullopt, {}, {}), Vec3(5.0, 5.0, 3.0));
  for (const auto& [element, arrangement] : {std::pair{Element(HexagonalCube{1.0}), Arrangement::honeycomb},
                                             std::pair{Element(RtpElement{0.5, 0.5, 90.0}), Arrangement::offset}}) {
    const Part part = build_welded_part(test::array_part(element, arrangement, 10.0, 10.0));
    const ExactSolid solid = exact_boundary(part, surface, std::nullopt, 1e-6).solid;
    const double megabytes = 1e-6 * static_cast<double>(step_text(solid, "test").size());
    EXPECT_NEAR(predicted_step_cost(solid).megabytes / megabytes, 1.0, 0.25);
  }
}

TEST(ExactStep, SplinesReproduceCubicPolynomials) {
  const auto cubic = [](const Vec2& p) {
    return 0.3 + p.x() * p.x() * p.y() - 2.0 * p.y() * p.y() * p.y() + 0.5 * p.x() * p.x() * p.x() * p.y() * p.y();
  };
  for (const std::size_t count : {4U, 5U, 9U, 40U}) {
    const SplinePatch patch = interpolated_patch(SplineAxis(-1.0, 2.0, count), SplineAxis(0.5, 1.5, count + 3), cubic);
    for (int k = 0; k <= 100; ++k) {
      const Vec2 at(-1.0 + 0.03 * k, 0.5 + std::fmod(0.618034 * k, 1.0));
      EXPECT_NEAR(patch.height_mm(at), cubic(at), 1e-13 * 20.0);
      EXPECT_NEAR(spline_value(
                      patch.x,
                      [&] {
                        std::vector<double> positions;
                        for (std::size_t i = 0; i < count; ++i) positions.push_back(patch.x.greville(i));
                        return positions;
                      }(),
                      at.x()),
                  at.x(), 1e-14 * 4.0);
    }
  }
}

}  // namespace
}  // namespace retrace::geometry::exact_step_test
