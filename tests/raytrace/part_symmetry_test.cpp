// Tests of the mirror symmetry of parts, and of light from mirrored directions.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/faces/part_symmetry.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/designs.h"
#include "tests/support/return_frames.h"

namespace retrace::testing::part_symmetry_test {
namespace {

using namespace geometry;
using namespace raytrace;

struct Question {
  std::string name;
  PartSpec spec;
  bool along_x;
  bool along_y;
  std::size_t maps;  ///< number of symmetries: rotations, and reflections if there are any
};

PartSpec with_errors(PartSpec spec, const std::array<double, 3>& dihedral_arcmin) {
  spec.angle_errors.dihedral_error_arcmin = dihedral_arcmin;
  return spec;
}

PartSpec bricks(PartSpec spec, double overlap_percent) {
  spec.array.overlap_percent = overlap_percent;
  return spec;
}

/// Returns parts with the expected mirror symmetries. A hexagonal cube corner is symmetric across y = 0, which contains
/// one of its dihedral edges, if the errors of the other two edges are equal. Arrays of triangular cube corners are
/// symmetric across both axes, because every second cell is rotated by 180 degrees. Infinite arrays of prisms are
/// symmetric across both axes, if necessary after a shift by one row.
std::vector<Question> questions() {
  const HexagonalCube hexagon{1.0};
  const TriangularCube triangle{1.0};
  const RtpElement prism{0.5, 0.4, 90.0};
  PartSpec tilted = infinite(prism, Arrangement::aligned, 1.0);
  tilted.angle_errors.facet_tilt_arcmin = {10.0, 0.0, 0.0};
  PartSpec slightly_tilted = tilted;
  slightly_tilted.angle_errors.facet_tilt_arcmin = {0.1, 0.0, 0.0};
  PartSpec at_random = finite(prism, Arrangement::aligned, 2.0, 2.0, 1.0);
  at_random.random_tilts = {1.0, 1};
  return {
      {"honeycomb", infinite(hexagon, Arrangement::honeycomb, 1.0), false, true, 6},
      {"errors alike", with_errors(infinite(hexagon, Arrangement::honeycomb, 1.0), {1.0, 2.0, 2.0}), false, true, 2},
      {"unlike errors", with_errors(infinite(hexagon, Arrangement::honeycomb, 1.0), {2.0, 1.0, 2.0}), false, false, 1},
      {"triangles", infinite(triangle, Arrangement::triangular, 1.0), true, true, 12},
      {"prisms", infinite(prism, Arrangement::aligned, 1.0), true, true, 4},
      {"one facet tilted", tilted, false, true, 2},
      {"one facet tilted slightly", slightly_tilted, false, true, 2},
      {"bricks", bricks(infinite(prism, Arrangement::offset, 1.0), 50.0), true, true, 4},
      {"bricks by a quarter", bricks(infinite(prism, Arrangement::offset, 1.0), 25.0), true, true, 4},
      {"one cube", single(hexagon, 1.0), false, true, 6},
      {"finite honeycomb", finite(hexagon, Arrangement::honeycomb, 4.0, 5.0, 1.0), false, true, 2},
      {"rows all of whole prisms", finite(prism, Arrangement::aligned, 2.0, 2.0, 1.0), true, true, 4},
      {"two rows of bricks", finite(prism, Arrangement::offset, 2.0, 0.8, 1.0), true, false, 2},
      {"tilts at random", at_random, false, false, 1},
  };
}

TEST(MirrorSymmetry, IsThatOfElementsErrorsAndBorders) {
  for (const Question& question : questions()) {
    const Part part = build_part(question.spec);
    EXPECT_EQ(is_mirror_symmetric(part, 0), question.along_x) << question.name;
    EXPECT_EQ(is_mirror_symmetric(part, 1), question.along_y) << question.name;
    EXPECT_EQ(symmetries_of(part).size(), question.maps) << question.name;
  }
}

FarField field_of(const Part& part, const Illumination& light) {
  BeamPolicy policy;
  policy.cutoff = 1e-7;
  policy.separate_cells = true;
  FarFieldCollector collector(part, light, {});
  BeamTracer(part).trace(pmma(), light, {0.5}, policy, nullptr, [&](const ReturnedBeam& beam) { collector.add(beam); });
  return collector.finish();
}

/// Light from the mirrored direction must have the mirrored far field. The entrance face is divided for tracing, and
/// this division is not symmetric. The far field must not depend on the division: light that passes through several
/// cells is grouped by the cells through which it passes.
TEST(MirrorSymmetry, MirroredLightHasTheMirroredFarField) {
  PartSpec cubes = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.1, 3.4, 1.0);
  cubes.angle_errors.dihedral_error_arcmin.fill(2.0);
  for (const PartSpec& spec :
       {cubes, finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 2.0, 2.0, 1.0),
        with_errors(infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0), {1.0, 1.0, 1.0})}) {
    const Part part = build_part(spec);
    ASSERT_TRUE(is_mirror_symmetric(part, 1));
    const Illumination light = from(20.0, 14.0);
    const FarField own = field_of(part, light);
    const FarField mirrored = field_of(part, from(20.0, -14.0));
    const ApertureKernel kernel({Angle::from_deg(10.0 / 60.0), Angle::from_deg(10.0 / 60.0)});
    const ReturnFrame frame = frame_at(light);
    for (const Vec2& at_deg : {Vec2(0.0, 0.0), Vec2(0.0, 0.33), Vec2(0.2, -0.3), Vec2(-0.5, 0.1)}) {
      const Vec3 direction = frame.direction(EIGEN_PI / 180.0 * at_deg);
      const double expected = own.intensity(direction, kernel).per_sr;
      EXPECT_GT(expected, 0.0);
      EXPECT_NEAR(mirrored.intensity({direction.x(), -direction.y(), direction.z()}, kernel).per_sr, expected,
                  1e-3 * expected)
          << at_deg.transpose();
    }
  }
}

}  // namespace
}  // namespace retrace::testing::part_symmetry_test
