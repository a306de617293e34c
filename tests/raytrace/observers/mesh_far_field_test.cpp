// Tests of the far fields of meshes. Each far field must equal that of the design for any division into triangles.
#include <gtest/gtest.h>

#include "geometry/part/mesh_part.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/designs.h"
#include "tests/support/mesh_variants.h"
#include "tests/support/part_specs.h"
#include "tests/support/return_frames.h"

namespace retrace::testing::mesh_far_field_test {
namespace {

using namespace geometry;
using namespace raytrace;

FarField far_field_of(const Part& part, const Optics& optics, const Illumination& light) {
  FarFieldCollector collector(part, light, FarFieldPolicy{});
  BeamPolicy policy;
  policy.cutoff = 1e-5;
  policy.separate_cells = true;
  BeamTracer(part).trace(optics, light, {0.5}, policy, nullptr, [&](const ReturnedBeam& beam) { collector.add(beam); });
  return collector.finish();
}

/// Returns the intensities on a grid of directions around the direction to the source.
std::vector<double> pattern_of(const FarField& field, const Illumination& light) {
  const ReturnFrame frame = frame_at(light);
  std::vector<Vec3> directions;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      directions.push_back((frame.to_source + 6e-4 * (i * frame.right + j * frame.up)).normalized());
  return field.diffracted_per_sr(directions);
}

struct Case {
  const char* name;
  PartSpec spec;
  Optics optics;
  double incidence_deg;
};

std::vector<Case> cases() {
  PartSpec cube = single(HexagonalCube{2.0}, 1.0);
  cube.angle_errors.dihedral_error_arcmin.fill(1.0);
  PartSpec honeycomb = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 2.5, 2.0, 1.0);
  PartSpec walls = honeycomb;
  walls.angle_errors.dihedral_error_arcmin = {1.0, 2.0, 3.0};
  return {{"cube", cube, pmma(), 5.0},
          {"honeycomb", honeycomb, pmma(), 10.0},
          {"honeycomb with walls", walls, ideal(), 10.0},
          {"triangles", finite(TriangularCube{1.0}, Arrangement::triangular, 2.0, 1.7, 1.0), pmma(), 3.0},
          {"bricks", finite(RtpElement{0.5, 0.5, 90.1}, Arrangement::offset, 1.5, 1.0, 1.0), ideal(), 2.0}};
}

// Rounding to single precision tilts facets by about 1e-7 rad, which shifts the pattern by 1e-3 of its width.
TEST(MeshFarField, IsThatOfTheDesignForAllTriangulations) {
  for (const Case& c : cases()) {
    const Illumination light = from(c.incidence_deg, 20.0);
    const std::vector<double> expected = pattern_of(far_field_of(build_part(c.spec), c.optics, light), light);
    const double peak = *std::max_element(expected.begin(), expected.end());
    ASSERT_GT(peak, 0.0);
    for (const MeshVariant& variant : variants_of(stl_mesh_of(c.spec))) {
      const std::vector<double> found = pattern_of(far_field_of(part_of_mesh(variant.mesh), c.optics, light), light);
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 4e-3 * peak) << c.name << ", " << variant.name << ", direction " << k;
    }
  }
}

}  // namespace
}  // namespace retrace::testing::mesh_far_field_test
