// Tests of faces of STEP files as entrance surface, substrate and outline. The files are written by a Python module.
// The same surfaces as formulas give the expected results.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "design/optical_model.h"
#include "geometry/io/step_reader.h"
#include "geometry/outline/plan_region.h"
#include "geometry/surface/step_surface.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/photometry/photometry.h"
#include "tests/studies/photometric_requests.h"
#include "tests/studies/step_faces/step_texts.h"
#include "tests/support/refusals.h"

namespace retrace::testing::step_faces_test {
namespace {

using geometry::StepChoice, geometry::Vec2, geometry::Vec3;

const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\narrangement = \"pins\"\nx_length_mm = 18\n"
    "y_length_mm = 14\n";
const std::string kBody = "[body]\nrefractive_index = 1.49\nthickness_mm = 4\n";
// The surface of write_step.spline().
const std::string kSplineFormula =
    "-x^2/800 - y^2/300 + 1e-5*x^3 + 2e-5*((x + 4 + abs(x + 4))/2)^3 - 3e-5*((y - 3 + abs(y - 3))/2)^3 + 2e-7*x^2*y^2";

/// Surface that is given by keys, and the Python statement that writes it as STEP.
struct SameSurface {
  std::string statement;
  std::string keys;
};
const std::vector<SameSurface>& same_surfaces() {
  static const std::vector<SameSurface> all = {
      {"w.plane(s)", "kind = \"formula\"\nformula = \"0.08*x - 0.05*y\"\n"},
      {"w.cylinder(s)", "kind = \"cylinder\"\nradius_mm = 120\n"},
      {"w.sphere(s)", "kind = \"sphere\"\nradius_mm = 150\n"},
      {"w.spline(s)", "kind = \"formula\"\nformula = \"" + kSplineFormula + "\"\n"}};
  return all;
}

class StepFaces : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string step_keys(const std::string& more = "origin_mm = [0, 0, 0]\n") const {
    return "kind = \"step\"\nfile = \"" + file("lens.step") + "\"\n" + more;
  }
  design::Design read(const std::string& text) const { return design::parse_design(text, "d.toml"); }
  design::OpticalModel model_of(const std::string& text) const {
    return design::make_model(read(text), materials::MaterialLibrary::shipped());
  }
  std::string refused(const std::string& text) const {
    return refusal_of([&] { model_of(text); });
  }
  geometry::StepSurface surface_of(StepChoice choice) const {
    choice.file = file("lens.step");
    return *geometry::read_step_surface(choice);
  }
};

raytrace::ConeResult traced(const design::OpticalModel& model, double incidence_deg) {
  const raytrace::MonteCarlo tracer(model.part, raytrace::MonteCarlo::Engine::embree, &*model.entrance);
  return tracer
      .trace(model.optics, {Angle::from_deg(incidence_deg), Angle::from_deg(20.0), raytrace::kUnpolarised}, {0.5},
             rays(8192), {})
      .cones[0];
}

TEST_F(StepFaces, GiveTheLightOfTheSameFormulas) {
  for (const SameSurface& same : same_surfaces()) {
    write_step(folder_, "lens.step", same.statement);
    const design::OpticalModel of_file = model_of(kCubes + "[entrance_surface]\n" + step_keys() + kBody);
    const design::OpticalModel of_keys = model_of(kCubes + "[entrance_surface]\n" + same.keys + kBody);
    for (const double incidence_deg : {0.0, 25.0}) {
      const raytrace::ConeResult a = traced(of_file, incidence_deg);
      const raytrace::ConeResult b = traced(of_keys, incidence_deg);
      for (std::size_t k = 0; k < raytrace::kAccountCount; ++k)
        EXPECT_NEAR(a.ledger.power[k], b.ledger.power[k], 1e-6) << same.statement << raytrace::kAccountNames[k];
    }
  }
}

TEST_F(StepFaces, GiveThePhotometryOfTheSameFormulas) {
  using namespace studies::photometric_requests;
  studies::PhotometrySettings request = request_of(points_at({0.2, 0.33, 1.0}, 1.0));
  request.diffraction = true;
  for (const SameSurface& same : same_surfaces()) {
    write_step(folder_, "lens.step", same.statement);
    const std::string cubes = kCubes + "[surface]\ndihedral_error_arcmin = 2\n";
    const auto result_of = [&](const std::string& keys) {
      return studies::photometric_requests::run(read(cubes + "[entrance_surface]\n" + keys + kBody), request);
    };
    const studies::PhotometryResult of_file = result_of(step_keys());
    const studies::PhotometryResult of_keys = result_of(same.keys);
    for (std::size_t k = 0; k < of_keys.points.size(); ++k)
      EXPECT_NEAR(of_file.points[k].r_a, of_keys.points[k].r_a, 1e-3 * of_keys.points[k].r_a)
          << same.statement << " point " << k;
  }
}

// The light of elements at the border of the part reaches beyond the face, where its surface continues.
TEST_F(StepFaces, ThatEndAtTheBorderOfThePartGiveTheSamePhotometry) {
  using namespace studies::photometric_requests;
  write_step(folder_, "lens.step",
             "w.face_over(s, w.SPLINE.surface(s, w.LOW, w.HIGH), w.SPLINE, w.rectangle((-9, -7), (9, 7)))");
  studies::PhotometrySettings request = request_of(points_at({0.33}, 1.0));
  request.diffraction = true;
  const auto result_of = [&](const std::string& keys) {
    const std::string cubes = kCubes + "[surface]\ndihedral_error_arcmin = 2\n[entrance_surface]\n";
    return studies::photometric_requests::run(read(cubes + keys + kBody), request);
  };
  const studies::PhotometryResult of_file = result_of(step_keys());
  const studies::PhotometryResult of_keys = result_of("kind = \"formula\"\nformula = \"" + kSplineFormula + "\"\n");
  EXPECT_NEAR(of_file.points[0].r_a, of_keys.points[0].r_a, 1e-3 * of_keys.points[0].r_a);
  EXPECT_EQ(of_file.warnings.size(), of_keys.warnings.size());
}

TEST_F(StepFaces, AreWithinANanometreOfTheirClosedForms) {
  const double radius = 150.0;
  write_step(folder_, "lens.step", "w.sphere(s)");
  const geometry::StepSurface sphere = surface_of({.file = {}, .origin_mm = std::array{0.0, 0.0, 0.0}});
  EXPECT_LE(sphere.deviation_mm, geometry::kMaxStepDeviationMm);
  EXPECT_LE(sphere.deviation_arcsec, geometry::kMaxStepDeviationArcsec);
  for (double x = -19.9; x < 20.0; x += 0.71)
    for (double y = -14.9; y < 15.0; y += 0.63) {
      const double root = std::sqrt(radius * radius - x * x - y * y);
      const jets::Gradient z = sphere.patches.evaluate(jets::Gradient(x, 1.0, 0.0), jets::Gradient(y, 0.0, 1.0));
      ASSERT_NEAR(z.value, root - radius, 1e-6);
      ASSERT_NEAR(z.x, -x / root, 4.8e-7);
      ASSERT_NEAR(z.y, -y / root, 4.8e-7);
    }
}

// The vertex of a surface of revolution is a pole of its parameters. The border of the face is a rectangle around it.
TEST_F(StepFaces, VertexOfASurfaceOfRevolutionIsSmooth) {
  write_step(folder_, "lens.step", R"py(
triples = [(0, 0, 0), (0, 0, 30), (0, 30, 30), (30, 30, 30)]
points = [s.point((sum(t) / 3, 0, -(t[0] * t[1] + t[1] * t[2] + t[2] * t[0]) / 1200)) for t in triples]
numbers = ','.join(f'#{number}' for number in points)
curve = s.write(f"B_SPLINE_CURVE_WITH_KNOTS('',3,({numbers}),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),.UNSPECIFIED.)")
axis = s.write(f"AXIS1_PLACEMENT('',#{s.point((0, 0, 0))},#{s.direction((0, 0, 1))})")
surface = s.write(f"SURFACE_OF_REVOLUTION('',#{curve},#{axis})")
paraboloid = w.Height(lambda x, y: -(x * x + y * y) / 400, lambda x, y: (-x / 200, -y / 200))
w.face_over(s, surface, paraboloid, w.rectangle(w.LOW, w.HIGH)))py");
  const geometry::StepSurface surface = surface_of({.file = {}, .origin_mm = std::array{0.0, 0.0, 0.0}});
  for (const Vec2& p : {Vec2(0, 0), Vec2(1e-7, 0), Vec2(-3, 2), Vec2(19, -14)}) {
    const jets::Gradient z = surface.patches.evaluate(jets::Gradient(p.x(), 1.0, 0.0), jets::Gradient(p.y(), 0.0, 1.0));
    EXPECT_NEAR(z.value, -p.squaredNorm() / 400, 1e-9);
    EXPECT_NEAR(z.x, -p.x() / 200, 1e-9);
    EXPECT_NEAR(z.y, -p.y() / 200, 1e-9);
  }
}

TEST_F(StepFaces, OfAllApplicationProtocolsAreRead) {
  write_step(folder_, "ap214.step", "w.sphere(s)");
  const std::string ap214 = folder_.read("ap214.step");
  const std::string schema = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }";
  for (const std::string other : {"CONFIG_CONTROL_DESIGN", "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"}) {
    folder_.write("lens.step", with_replaced(ap214, schema, other));
    EXPECT_NEAR(surface_of({}).size_mm.x(), 40.0, 1e-9) << other;
  }
}

TEST_F(StepFaces, UnitsAreReadFromTheFile) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const geometry::StepSurface in_mm = surface_of({});
  EXPECT_EQ(in_mm.unit, "millimetre");
  for (const std::string unit : {"m", "inch"}) {
    write_step(folder_, unit + ".step", "w.sphere(s)", unit);
    const geometry::StepSurface other = *geometry::read_step_surface({.file = file(unit + ".step")});
    EXPECT_NEAR(other.size_mm.x(), 40.0, 1e-9);
    EXPECT_NEAR(other.patches.evaluate(7.0, -9.0), in_mm.patches.evaluate(7.0, -9.0), 1e-9) << unit;
  }
}

// A rotation of 90 degrees about z turns the axis of the cylinder into the direction x. Rotated about x, the lens first
// lies on its side, and the second rotation restores it.
TEST_F(StepFaces, RotationsAndOriginPlaceTheFile) {
  write_step(folder_, "lens.step", "w.cylinder(s)");
  const auto height = [](double t) { return std::sqrt(120.0 * 120.0 - t * t) - 120.0; };
  const geometry::StepSurface turned = surface_of({.file = {}, .rotation_deg = {0, 0, 90}});
  EXPECT_NEAR(turned.size_mm.x(), 30.0, 1e-9);
  EXPECT_NEAR(turned.patches.evaluate(3.0, 11.0), height(11.0), 1e-9);
  const geometry::StepSurface moved = surface_of({.file = {}, .origin_mm = std::array{5.0, 1.0, -2.0}});
  EXPECT_NEAR(moved.patches.evaluate(3.0, 11.0), height(8.0) + 2.0, 1e-9);
  EXPECT_EQ(refusal_of([&] { surface_of({.file = {}, .rotation_deg = {90, 0, 0}}); }), "TMP/lens.step");
  const double tilt = 0.3;
  const geometry::StepSurface tilted =
      surface_of({.file = {}, .origin_mm = std::array{0.0, 0.0, 0.0}, .rotation_deg = {0, tilt, 0}});
  // A point (x, z) of the circle has the rotated position (x cos + z sin, -x sin + z cos).
  const double angle = tilt * std::numbers::pi / 180.0;
  const double x = 6.0;
  EXPECT_NEAR(tilted.patches.evaluate(x * std::cos(angle) + height(x) * std::sin(angle), 2.0),
              -x * std::sin(angle) + height(x) * std::cos(angle), 1e-9);
}

TEST_F(StepFaces, AreFoundByNameColourAndNumber) {
  write_step(folder_, "lens.step", "w.roof(s)");
  const auto slope = [&](const std::string& face) {
    return surface_of({.file = {}, .face = face})
        .patches.evaluate(jets::Gradient(0.0, 1.0, 0.0), jets::Gradient(0.0, 0.0, 1.0))
        .x;
  };
  for (const std::string face : {"left", "#ff0000", "#FF0000", "1"}) EXPECT_NEAR(slope(face), 0.1, 1e-12) << face;
  for (const std::string face : {"right", "#0000ff", "2"}) EXPECT_NEAR(slope(face), -0.1, 1e-12) << face;
  for (const std::string face : {"middle", "#00ff00", "3", "0", "#zz"})
    EXPECT_EQ(refusal_of([&] { surface_of({.file = {}, .face = face}); }), "TMP/lens.step") << face;
}

TEST_F(StepFaces, OfSolidsThatFaceDownwardsAreNotTheLargest) {
  write_step(folder_, "lens.step", "w.box(s)", "mm", true);
  for (const std::string face : {"largest", "towards +z", "+z", "#ff0000"}) {
    const geometry::StepSurface surface = surface_of({.file = {}, .face = face});
    EXPECT_NEAR(surface.origin_mm.z(), 5.0, 1e-12) << face;
    EXPECT_NEAR(surface.size_mm.x(), 40.0, 1e-12);
  }
  EXPECT_NEAR(surface_of({.file = {}, .face = "-z"}).origin_mm.z(), 0.0, 1e-12);
  EXPECT_EQ(refusal_of([&] { surface_of({.file = {}, .face = "+x"}); }), "TMP/lens.step");
}

TEST_F(StepFaces, EdgesBetweenFacesStayEdges) {
  write_step(folder_, "lens.step", "w.roof(s)");
  const geometry::StepSurface roof = surface_of({.file = {}, .face = "towards +z"});
  ASSERT_EQ(roof.breaks.size(), 1U);
  EXPECT_NEAR(roof.breaks[0].angle_deg, 2.0 * std::atan(0.1) * 180.0 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(roof.breaks[0].at_mm.x(), 0.0, 1e-9);
  for (const double x : {-15.0, -1e-5, 1e-5, 3.0}) EXPECT_NEAR(roof.patches.evaluate(x, 2.0), -0.1 * std::abs(x), 1e-6);
  const std::string face = "face = \"towards +z\"\norigin_mm = [0, 0, 0]\n";
  const design::OpticalModel of_file = model_of(kCubes + "[entrance_surface]\n" + step_keys(face) + kBody);
  const double half = 0.5 * 18.0;
  EXPECT_NEAR(geometry::height_mm(*of_file.entrance, {half + 3.0, 7.0}), 4.0 - 0.3, 1e-9);
  EXPECT_NEAR(traced(of_file, 0.0).ledger.total(), 1.0, 1e-6);
}

TEST_F(StepFaces, GapsAreSewnUpToTheTolerance) {
  write_step(folder_, "lens.step", "w.roof(s, gap_mm=0.02)");
  const geometry::StepSurface roof = surface_of({.file = {}, .face = "towards +z", .sew_mm = 0.05});
  EXPECT_GE(roof.gap_mm, 0.009);
  EXPECT_LE(roof.gap_mm, 0.05);
  EXPECT_EQ(refusal_of([&] { surface_of({.file = {}, .face = "towards +z", .sew_mm = 0.001}); }), "TMP/lens.step");
}

TEST_F(StepFaces, OutlineIsTheBorderOfTheFace) {
  write_step(folder_, "lens.step", "w.lens(s)");
  const std::string rest = "[body]\nthickness_mm = 3\n";
  const std::string cubes = "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\narrangement = \"pins\"\n";
  const auto plan = [&](const std::string& keys) {
    return read(cubes + "[outline]\n" + keys + rest).part().array.outline;
  };
  const auto of_file = plan("file = \"" + file("lens.step") + "\"\n");
  const auto of_keys = plan("polygon_mm = [[0, 0], [52, 0], [62, 34], [10, 34]]\ncorner_radius_mm = 5\n");
  EXPECT_NEAR(of_file->outline.area_mm2(), of_keys->outline.area_mm2(), 1e-4);
  EXPECT_NEAR(of_file->box_mm.size().x(), of_keys->box_mm.size().x(), 1e-4);
  EXPECT_NEAR(of_file->box_mm.size().y(), of_keys->box_mm.size().y(), 1e-4);
}

TEST_F(StepFaces, SubstrateIsTheSameFormula) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const std::string thick = "[body]\nrefractive_index = 1.49\nthickness_mm = 5\n";
  const auto part = [&](const std::string& keys) { return model_of(kCubes + "[substrate]\n" + keys + thick).part; };
  const geometry::Part of_file = part(step_keys());
  const geometry::Part of_keys = part("kind = \"sphere\"\nradius_mm = 150\n");
  ASSERT_EQ(of_file.placements.size(), of_keys.placements.size());
  for (std::size_t k = 0; k < of_file.placements.size(); ++k)
    EXPECT_NEAR(of_file.placements[k].height_mm, of_keys.placements[k].height_mm, 1e-9);
}

TEST_F(StepFaces, ElementsFollowTheFaceAtAWall) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const std::string below = "[substrate]\nkind = \"offset\"\nwall_mm = 2\n[body]\nrefractive_index = 1.49\n";
  const geometry::Part of_file = model_of(kCubes + "[entrance_surface]\n" + step_keys() + below).part;
  const geometry::Part of_keys =
      model_of(kCubes + "[entrance_surface]\nkind = \"sphere\"\nradius_mm = 150\n" + below).part;
  ASSERT_EQ(of_file.placements.size(), of_keys.placements.size());
  EXPECT_NEAR(of_file.thickness_mm, of_keys.thickness_mm, 1e-9);
  for (std::size_t k = 0; k < of_file.placements.size(); ++k)
    EXPECT_NEAR(of_file.placements[k].height_mm, of_keys.placements[k].height_mm, 1e-8);
}

TEST_F(StepFaces, PartMustBeCovered) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const std::string wide =
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\nx_length_mm = 41\ny_length_mm = 20\n";
  EXPECT_EQ(refused(wide + "[entrance_surface]\n" + step_keys() + kBody), "d.toml:9: entrance_surface.file");
  EXPECT_EQ(refused(wide + "[substrate]\n" + step_keys() + kBody), "d.toml:9: substrate.file");
  EXPECT_EQ(refused(kCubes + "[entrance_surface]\n" + step_keys("origin_mm = [15, 0, 0]\n") + kBody),
            "d.toml:10: entrance_surface.file");
}

TEST_F(StepFaces, DocumentsAreReadAgain) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const std::string text =
      kCubes + "[entrance_surface]\n" +
      step_keys("face = \"front\"\nsew_mm = 0.02\norigin_mm = [1, 2, 3]\nrotation_deg = [0, 0, 90]\n") +
      "[substrate]\n" + step_keys("rotation_deg = [0, 0, 180]\n") + kBody;
  const std::string written = design::design_text(read(text));
  EXPECT_EQ(design::design_text(read(written)), written);
  for (const std::string part : {"sew_mm = 0.02", "origin_mm = [1", "[0", "90", "180", "face = \"front\""})
    EXPECT_NE(written.find(part), std::string::npos) << part;
}

TEST_F(StepFaces, KeysAreChecked) {
  write_step(folder_, "lens.step", "w.sphere(s)");
  const std::string start = kCubes + "[entrance_surface]\n";
  expect_refusals([&](const std::string& keys) { return refused(start + keys + kBody); },
                  {{"kind = \"step\"\n", "d.toml:8: entrance_surface.file"},
                   {"kind = \"step\"\nfile = \"no.step\"\n", "d.toml:10: entrance_surface.file"},
                   {step_keys("sew_mm = 0\n"), "d.toml:11: entrance_surface.sew_mm"},
                   {step_keys("sew_mm = 2\n"), "d.toml:11: entrance_surface.sew_mm"},
                   {step_keys("face = 3\n"), "d.toml:11: entrance_surface.face"},
                   {step_keys("face = \"none\"\n"), "d.toml:10: entrance_surface.file"},
                   {step_keys("origin_mm = [0, 0]\n"), "d.toml:11: entrance_surface.origin_mm"},
                   {step_keys("rotation_deg = 90\n"), "d.toml:11: entrance_surface.rotation_deg"},
                   {step_keys("rotation_deg = [0, 90, 0]\n"), "d.toml:10: entrance_surface.file"},
                   {step_keys("radius_mm = 100\n"), "d.toml:11: entrance_surface.radius_mm"},
                   {"kind = \"sphere\"\nradius_mm = 100\nfile = \"lens.step\"\n", "d.toml:11: entrance_surface.file"}});
}

}  // namespace
}  // namespace retrace::testing::step_faces_test
