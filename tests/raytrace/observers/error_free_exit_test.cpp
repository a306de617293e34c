// Tests of the far fields of cells with errors of angle. The far fields must be independent of the thickness of the
// plate, conserve power and agree with a pixel model.
#include "raytrace/observers/error_free_exit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/random.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/pixel_cube.h"
#include "tests/support/return_frames.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::error_free_exit_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kWindow_rad = 0.035;

FarField field_of(const PartSpec& spec, const Optics& optics, const Illumination& light = {}) {
  const Part part = build_part(spec);
  FarFieldPolicy policy;
  policy.wavelength_nm = kPixelCubeWaveNm;
  policy.window_rad = 1.5 * kWindow_rad;
  return far_field_of_cells(part, optics, light, policy);
}

PartSpec with(PartSpec spec, const AngleErrors& errors) {
  spec.angle_errors = errors;
  return spec;
}

/// Returns the random number `which` of the set `set`, uniformly distributed from -1 to 1.
double draw(std::uint32_t set, std::uint32_t which) {
  return 2.0 * unit_interval(philox({77, which}, set, 0)[0]) - 1.0;
}

AngleErrors random_errors(std::uint32_t set, double most_arcmin, bool is_prism) {
  AngleErrors errors;
  for (std::uint32_t k = 0; k < 3; ++k) errors.dihedral_error_arcmin[k] = most_arcmin * draw(set, k);
  if (is_prism)
    errors.dihedral_error_arcmin[1] = errors.dihedral_error_arcmin[2] = 0.0;
  else if (set % 2 == 1)
    for (std::uint32_t k = 0; k < 3; ++k) errors.facet_tilt_arcmin[k] = 0.5 * most_arcmin * draw(set, 3 + k);
  return errors;
}

struct Case {
  std::string name;
  PartSpec spec;  ///< part with a plate of 0.5 mm
  bool is_prism = false;
};

std::vector<Case> cases() {
  return {{"bricks", infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 0.5), true},
          {"honeycomb", infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.5)},
          {"prisms", infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 0.5), true},
          {"triangles", infinite(TriangularCube{0.8}, Arrangement::triangular, 0.5)}};
}

// Within the plate, diffraction changes only the phases of the field's angular spectrum. The far field of light that
// has passed through one cell therefore does not depend on the thickness of the plate.
TEST(ErrorFreeExit, ThicknessChangesNoReading) {
  const ApertureKernel kernel({Angle::from_deg(1.0 / 6.0), Angle::from_deg(1.0 / 6.0)});
  for (const Case& one : cases())
    for (const bool mirrors : {true, false}) {
      Optics optics = pmma();
      optics.mirror_facets = mirrors;
      optics.lossless_entrance = true;
      const PartSpec spec = with(one.spec, random_errors(3, 10.0, one.is_prism));
      std::vector<double> of_thin;
      for (const double thickness_mm : {0.01, 1.5, 10.0}) {
        PartSpec plate = spec;
        plate.thickness_mm = thickness_mm;
        const FarField field = field_of(plate, optics);
        std::vector<double> readings;
        for (const double angle_deg : {0.0, 0.2, 0.33, 0.6, 1.5})
          for (const double turn_deg : {0.0, 40.0, 90.0, 200.0})
            readings.push_back(
                field
                    .intensity(frame_at({}).direction(kDeg * angle_deg *
                                                      Vec2(std::cos(kDeg * turn_deg), std::sin(kDeg * turn_deg))),
                               kernel)
                    .per_sr);
        if (of_thin.empty()) of_thin = readings;
        for (std::size_t k = 0; k < readings.size(); ++k)
          EXPECT_NEAR(readings[k] / of_thin[k], 1.0, 1e-3)
              << one.name << " " << mirrors << " " << thickness_mm << " " << k;
      }
    }
}

// Polygons that do not overlap conserve power, whatever waves leave through them (Parseval's theorem).
TEST(ErrorFreeExit, WindowAndOutsideAddUpToTheGeometricPower) {
  const std::vector<Case> all = cases();
  for (std::uint32_t set = 0; set < 50; ++set) {
    const Case& one = all[set % all.size()];
    Optics optics = set % 3 == 0 ? ideal() : pmma();
    if (set % 3 == 1) optics.facet_layers = thin_aluminium();
    optics.lossless_entrance = true;
    PartSpec spec = with(one.spec, random_errors(set, 10.0, one.is_prism));
    spec.thickness_mm = std::pow(10.0, -0.5 + 1.5 * draw(set, 9));
    const Illumination light = from(one.is_prism ? 0.0 : 4.0 + 4.0 * draw(set, 10), 180.0 * draw(set, 11));
    const FarField field = field_of(spec, optics, light);
    const FarField::Split split = field.split(frame_at(light), kWindow_rad);
    EXPECT_NEAR((split.inside + split.outside) / field.total_power(), 1.0, 1e-3)
        << one.name << " " << set << " of " << field.total_power();
  }
}

std::array<Vec3, 3> normals_of(const PartSpec& spec) {
  const Part part = build_part(spec);
  std::array<Vec3, 3> normals;
  std::size_t count = 0;
  for (const PatchFacet& facet : part.patches.front().facets)
    if (facet.role == FacetRole::retro_facet && count < 3) normals[count++] = -facet.normal;
  return normals;
}

// Compares the far fields of cube corners with a pixel model. The cube corners have equal dihedral errors of either
// sign, or unequal dihedral errors and facet tilts. Each case is tested with mirrors and with total reflection.
TEST(ErrorFreeExit, CubeCornersWithErrorsAgreeWithAPixelModel) {
  const std::vector<AngleErrors> lists = {
      {{-5.0, -5.0, -5.0}, {}}, {{5.0, 5.0, 5.0}, {}}, {{2.0, -7.0, 9.0}, {1.0, 3.0, -4.0}}};
  for (const bool mirrors : {true, false})
    for (const AngleErrors& errors : lists) {
      const PartSpec spec = with(infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 3.0), errors);
      Optics optics = pmma();
      optics.mirror_facets = mirrors;
      optics.lossless_entrance = true;
      const FarField field = field_of(spec, optics);
      const PixelCube cube({.wavelength_mm = 1e-6 * kPixelCubeWaveNm, .mirrors = mirrors, .normals = normals_of(spec)});
      const double peak = cube.area_mm2() / std::pow(1e-6 * kPixelCubeWaveNm, 2.0);
      double most = 0.0;
      for (const double angle_deg : {0.0, 0.07, 0.2, 0.33, 0.6})
        for (const double turn_deg : {0.0, 50.0, 90.0, 170.0, 233.0, 300.0}) {
          const Vec2 q = kDeg * angle_deg * Vec2(std::cos(kDeg * turn_deg), std::sin(kDeg * turn_deg));
          const double found = field.diffracted_per_sr({q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm())}) / peak;
          EXPECT_NEAR(found, cube.at(q), 5e-4) << mirrors << " " << angle_deg << " " << turn_deg;
          most = std::max(most, found);
        }
      EXPECT_GT(most, 0.012);
    }
}

}  // namespace
}  // namespace retrace::testing::error_free_exit_test
