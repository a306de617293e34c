// Tests of designs with inclined and curved entrance surfaces: keys and their defaults, the reference axis, the power
// of the incident beam, and elements below a surface.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "design/light_and_index.h"
#include "design/light_symmetry.h"
#include "design/optical_model.h"
#include "raytrace/observers/photometric_geometry.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/photometry/photometer.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::inclined_entrance_test {
namespace {

using geometry::Vec2, geometry::Vec3;
using raytrace::Account, raytrace::ConeResult;

constexpr double kDegree = std::numbers::pi / 180.0;

const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\narrangement = \"pins\"\nx_length_mm = 30\n"
    "y_length_mm = 20\n";
const std::string kBody = "[body]\nrefractive_index = 1.49\n";
const std::string kThick = kBody + "thickness_mm = 12\n";
const std::string kIdeal = "[idealisation]\nfacets = \"mirror\"\n";
const std::string kBelow = "[substrate]\nkind = \"offset\"\nwall_mm = 2\n";

std::string surface(const std::string& keys) {
  return "[entrance_surface]\n" + keys;
}

design::Design read(const std::string& text) {
  return design::parse_design(text, "d.toml");
}

std::string refused(const std::string& text) {
  return refusal_of([&] {
    const design::Design design = read(text);
    design::make_model(design, materials::MaterialLibrary::shipped());
  });
}

design::OpticalModel model_of(const std::string& text) {
  return design::make_model(read(text), materials::MaterialLibrary::shipped());
}

/// Traces light from a direction with the ray engine.
ConeResult traced(const design::OpticalModel& model, const Vec3& to_source, double cone_deg,
                  std::uint64_t rays = 4096) {
  const raytrace::MonteCarlo tracer(model.part, raytrace::MonteCarlo::Engine::embree,
                                    model.entrance ? &*model.entrance : nullptr);
  const raytrace::SourceAngles source = raytrace::source_angles(to_source);
  return tracer
      .trace(model.optics, {source.incidence, source.azimuth, raytrace::kUnpolarised}, {cone_deg},
             retrace::testing::rays(rays), {})
      .cones[0];
}

double fresnel_reflectance(double incidence_rad, double index) {
  const double refracted = std::asin(std::sin(incidence_rad) / index);
  const double s = std::sin(incidence_rad - refracted) / std::sin(incidence_rad + refracted);
  const double p = std::tan(incidence_rad - refracted) / std::tan(incidence_rad + refracted);
  return 0.5 * (s * s + p * p);
}

TEST(InclinedEntrance, PinsAreAlongTheRefractedAxisByDefault) {
  const auto pin_deg = [](const std::string& body, const std::string& light) {
    return read(kCubes + "[entrance_surface]\nkind = \"plane\"\nincidence_deg = 40\n" + body + "thickness_mm = 12\n" +
                light)
        .inclination()
        ->pin_angle_deg;
  };
  EXPECT_NEAR(std::sin(pin_deg(kBody, "") * kDegree), std::sin(40.0 * kDegree) / 1.49, 1e-14);
  const std::string pmma = "[body]\nmaterial = \"PMMA\"\n";
  const double blue = pin_deg(pmma, "[light]\nwavelength_nm = 450\n");
  const double red = pin_deg(pmma, "[light]\nwavelength_nm = 700\n");
  EXPECT_LT(blue, red);
  const design::Design lamp =
      read(kCubes + surface("kind = \"plane\"\nincidence_deg = 40\n") + pmma +
           "thickness_mm = 12\n[light]\nspectrum = [[450, 1], [700, 1]]\nweighting = \"radiant\"\n");
  EXPECT_NEAR(std::sin(lamp.inclination()->pin_angle_deg * kDegree),
              std::sin(40.0 * kDegree) / design::index_at_centroid(lamp), 1e-14);
  const double between = lamp.inclination()->pin_angle_deg;
  EXPECT_GT(between, blue);
  EXPECT_LT(between, red);
  EXPECT_EQ(read(kCubes + surface("kind = \"plane\"\nincidence_deg = 40\npin_angle_deg = 5\n") + kThick)
                .inclination()
                ->pin_angle_deg,
            5.0);
}

TEST(InclinedEntrance, ReferenceAxisIsZForAllOtherDesigns) {
  EXPECT_EQ(read(kCubes + kThick).reference_axis(), Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(read(kCubes + surface("kind = \"sphere\"\nradius_mm = 400\nazimuth_deg = 70\n") + kThick).reference_axis(),
            Vec3(0.0, 0.0, 1.0));
  const Vec3 axis =
      read(kCubes + surface("kind = \"plane\"\nincidence_deg = 40\npin_angle_deg = 10\nazimuth_deg = 90\n") + kThick)
          .reference_axis();
  EXPECT_NEAR(axis.x(), 0.0, 1e-15);
  EXPECT_NEAR(axis.y(), std::sin(30.0 * kDegree), 1e-15);
}

TEST(InclinedEntrance, DocumentsAreReadAgain) {
  for (const std::string& keys :
       {surface("kind = \"plane\"\nincidence_deg = 40\nazimuth_deg = 15\n"),
        surface("kind = \"cylinder\"\nradius_mm = -300\nconic = -0.5\nrotation_deg = 20\ncentre_mm = [10, 9]\n"),
        surface("kind = \"sphere\"\nradius_mm = 250\nincidence_deg = 10\npin_angle_deg = 3\n"),
        surface("kind = \"biconic\"\nradii_mm = [400, -900]\nconics = [0.5, -1]\n"),
        surface("kind = \"formula\"\nformula = \"-r^2/500 + 0.01*cos(2*theta)*y^2\"\n")}) {
    const design::Design first = read(kCubes + keys + kThick);
    const std::string text = design::design_text(first);
    const design::Design second = read(text);
    EXPECT_EQ(design::design_text(second), text);
    EXPECT_EQ(second.reference_axis(), first.reference_axis());
    EXPECT_EQ(second.entrance->surface.index(), first.entrance->surface.index());
    EXPECT_EQ(second.entrance->form()->shape.index(), first.entrance->form()->shape.index());
  }
  const std::string below =
      design::design_text(read(kCubes + surface("kind = \"sphere\"\nradius_mm = 90\n") + kBelow + kBody));
  EXPECT_EQ(design::design_text(read(below)), below);
}

TEST(InclinedEntrance, KeysThatMakeNoSenseAreRefused) {
  const auto at = [](const std::string& keys) { return refused(kCubes + surface(keys) + kThick); };
  EXPECT_EQ(at("kind = \"sphere\"\n"), "d.toml:8: entrance_surface.radius_mm");
  EXPECT_EQ(at("kind = \"sphere\"\nradius_mm = 0\n"), "d.toml:10: entrance_surface.radius_mm");
  EXPECT_EQ(at("kind = \"plane\"\nradius_mm = 9\n"), "d.toml:10: entrance_surface.radius_mm");
  EXPECT_EQ(at("kind = \"biconic\"\nradii_mm = [9, 0]\n"), "d.toml:10: entrance_surface.radii_mm");
  EXPECT_EQ(at("kind = \"formula\"\nformula = \"x +\"\n"), "d.toml:10: entrance_surface.formula");
  EXPECT_EQ(at("kind = \"formula\"\nformula = \"cx\"\n"), "d.toml:10: entrance_surface.formula");
  EXPECT_EQ(at("kind = \"plane\"\nincidence_deg = 61\n"), "d.toml:10: entrance_surface.incidence_deg");
  EXPECT_EQ(at("kind = \"cone\"\n"), "d.toml:9: entrance_surface.kind");
  EXPECT_EQ(at("kind = \"plane\"\nturned_part = \"a.toml\"\n"), "d.toml:9: entrance_surface.kind");
  EXPECT_EQ(at("kind = \"plane\"\nmesh = \"a.stl\"\n"), "d.toml:9: entrance_surface.kind");
  EXPECT_EQ(at("turned_part = \"a.toml\"\nincidence_deg = 3\n"), "d.toml:10: entrance_surface.incidence_deg");
}

TEST(InclinedEntrance, SurfacesThatDoNotFitAreRefused) {
  const auto at = [](const std::string& keys) { return refused(kCubes + surface(keys) + kThick); };
  // Surfaces that pass through the elements, fold, or are not finite.
  EXPECT_EQ(at("kind = \"sphere\"\nradius_mm = 18.2\n"), "d.toml:10: entrance_surface.radius_mm");
  EXPECT_EQ(at("kind = \"plane\"\nincidence_deg = 60\npin_angle_deg = 50\n"), "d.toml:9: entrance_surface.kind");
  EXPECT_EQ(at("kind = \"formula\"\nformula = \"sin(2*x)\"\nincidence_deg = 50\npin_angle_deg = 40\n"),
            "d.toml:10: entrance_surface.formula");
  EXPECT_EQ(at("kind = \"formula\"\nformula = \"log(x)\"\n"), "d.toml:10: entrance_surface.formula");
  EXPECT_EQ(refused(kCubes + kBelow + kBody), "d.toml:9: substrate.kind");
  EXPECT_EQ(refused(kCubes + surface("kind = \"sphere\"\nradius_mm = 90\n") + kBelow + kThick),
            "d.toml:16: body.thickness_mm");
  EXPECT_EQ(refused(kCubes + surface("kind = \"formula\"\nformula = \"sin(2*x)/2\"\n") + kBelow + kBody),
            "d.toml:13: substrate.wall_mm");
}

// A plane receives all light of the beam, whatever its inclination. It reflects the fraction that Fresnel's formulas
// give for the angle between the light and the normal of the plane.
TEST(InclinedEntrance, PlaneReflectsTheBeamAsFresnelSays) {
  const std::string plane = "kind = \"plane\"\nincidence_deg = 35\nazimuth_deg = 20\npin_angle_deg = 22\n";
  const design::OpticalModel model = model_of(kCubes + surface(plane) + kThick + kIdeal);
  const auto& face = std::get<std::shared_ptr<const geometry::EntranceSurface>>(*model.entrance);
  for (const Vec3& to_source : {Vec3(Vec3::UnitZ()), Vec3(0.3, 0.1, 0.9), Vec3(-0.2, -0.4, 0.9), Vec3(0.6, 0.3, 0.7)}) {
    const Vec3 s = to_source.normalized();
    const ConeResult result = traced(model, s, 1e-4);
    EXPECT_NEAR(result.ledger[Account::front_specular],
                fresnel_reflectance(std::acos(face->axis().dot(s)), model.optics.index), 1e-12);
    EXPECT_NEAR(result.ledger.total(), 1.0, 1e-9);
    EXPECT_EQ(result.ledger[Account::lost], 0.0);
  }
}

// Cube corners return light antiparallel to its direction inside the part. When this light leaves, the plane refracts
// it back into the direction of the source, even if the plane is tilted.
TEST(InclinedEntrance, CubesBehindAPlaneReturnLightExactly) {
  for (const std::string& back : {kThick, kBelow + kBody}) {
    const std::string plane = "kind = \"plane\"\nincidence_deg = 45\nazimuth_deg = 20\n";
    const std::string text = kCubes + surface(plane) + back + kIdeal;
    const design::OpticalModel model = model_of(text);
    const Vec3 axis = read(text).reference_axis();
    const ConeResult narrow = traced(model, axis, 1e-5);
    const ConeResult wide = traced(model, axis, 0.2);
    EXPECT_GT(narrow.rre, 0.4);
    EXPECT_NEAR(narrow.rre, wide.rre, 1e-12);
    EXPECT_NEAR(narrow.ledger.total(), 1.0, 1e-9);
    EXPECT_EQ(narrow.ledger[Account::lost], 0.0);
  }
}

// Inside the part, light along the reference axis is parallel to the pins. Full cubes then return nearly all of this
// light. The losses are the Fresnel losses at the plane and those of cut elements at the border.
TEST(InclinedEntrance, PinsReturnTheLightOfTheReferenceAxis) {
  const std::string cubes =
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\narrangement = \"pins\"\nx_length_mm = 60\n"
      "y_length_mm = 40\n";
  const std::string text = cubes + surface("kind = \"plane\"\nincidence_deg = 45\n") + kBelow + kBody + kIdeal;
  const double reflectance = fresnel_reflectance(45.0 * kDegree, 1.49);
  const double rre = traced(model_of(text), read(text).reference_axis(), 0.1, 16384).rre;
  EXPECT_LT(rre, 1.0 - reflectance);
  EXPECT_GT(rre, 0.85 * (1.0 - reflectance) * (1.0 - reflectance));
}

// Curved and inclined surfaces in front of elements lose no light.
TEST(InclinedEntrance, LedgersAddUpToOne) {
  for (const std::string& keys :
       {surface("kind = \"sphere\"\nradius_mm = 60\nincidence_deg = 30\nazimuth_deg = 50\n"),
        surface("kind = \"biconic\"\nradii_mm = [-80, 120]\nincidence_deg = 20\nazimuth_deg = 200\n"),
        surface("kind = \"formula\"\nformula = \"0.2*sin(x/2)*cos(y/3)\"\nincidence_deg = 25\n")}) {
    const std::string text = kCubes + keys + kBelow + kBody + "absorption_per_mm = 0.01\n";
    const design::OpticalModel model = model_of(text);
    for (const Vec3& s : {read(text).reference_axis(), Vec3(0.5, -0.3, 0.8), Vec3(-0.6, 0.2, 0.7)}) {
      const ConeResult result = traced(model, s.normalized(), 0.5);
      EXPECT_NEAR(result.ledger.total(), 1.0, 1e-9) << keys;
      EXPECT_EQ(result.ledger[Account::lost], 0.0) << keys;
    }
  }
}

/// Returns the smallest distance along z between the corners of the retro facets of a cell and the surface.
double wall_of_cell(const geometry::EntranceSurface& face, const geometry::SurfacePatch& patch,
                    const geometry::PatchCell& cell, const geometry::Placement& placement) {
  double thinnest_mm = 1e9;
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const geometry::PatchFacet& facet = patch.facets[f];
    for (std::uint32_t k = 0; k < facet.corner_count && facet.role == geometry::FacetRole::retro_facet; ++k) {
      const Vec3& corner = patch.vertices[patch.corners[facet.first_corner + k]];
      const Vec2 position_mm = corner.head<2>() + placement.offset_mm;
      thinnest_mm = std::min(thinnest_mm, face.at(position_mm).height_mm - corner.z() - placement.height_mm);
    }
  }
  return thinnest_mm;
}

// All rims of a prism are at the same height. Below a convex surface, the wall is therefore thinnest at a corner of the
// prism.
TEST(InclinedEntrance, WallsHaveTheGivenThickness) {
  const std::string prisms =
      "[element]\nkind = \"rtp\"\nbase_mm = 2\nwidth_mm = 2\n[array]\nx_length_mm = 30\ny_length_mm = 20\n";
  const std::string text =
      prisms + surface("kind = \"sphere\"\nradius_mm = 50\nincidence_deg = 20\nazimuth_deg = 30\n") + kBelow + kBody;
  const design::OpticalModel model = model_of(text);
  const auto& face = *std::get<std::shared_ptr<const geometry::EntranceSurface>>(*model.entrance);
  const geometry::EntranceRange range = geometry::entrance_range(*model.entrance, model.part.outline);
  EXPECT_NEAR(range.lowest_mm, 2.0, 1e-2);  // `lowest_mm` is the minimum over 129 x 129 points
  EXPECT_NEAR(model.part.thickness_mm, range.highest_mm, 1e-2);
  int elements = 0;
  for (const geometry::Placement& placement : model.part.placements) {
    const geometry::SurfacePatch& patch = model.part.patches[placement.patch];
    for (const geometry::PatchCell& cell : patch.cells) {
      const double wall_mm = wall_of_cell(face, patch, cell, placement);
      if (wall_mm == 1e9) continue;
      EXPECT_NEAR(wall_mm, 2.0, 1e-6);
      ++elements;
    }
  }
  EXPECT_EQ(elements, 150);
}

// The directions of photometry refer to the reference axis. Conversion to the part frame and back changes nothing.
TEST(InclinedEntrance, PhotometricAnglesReferToTheReferenceAxis) {
  const Vec3 axis = geometry::reference_axis_of({50.0, 35.0, 20.0});
  PhotometerSetting ahead;
  ahead.reference_axis = axis;
  EXPECT_LT((frame_of(ahead).to_source - axis).norm(), 1e-14);
  PhotometerSetting setting;
  setting.v_deg = 7.0;
  setting.h_deg = -13.0;
  setting.rotation_deg = 25.0;
  setting.observation_deg = {0.4};
  setting.reference_axis = axis;
  const raytrace::ReturnFrame frame = frame_of(setting);
  PhotometerSetting plain = setting;
  plain.reference_axis = Vec3::UnitZ();
  EXPECT_NEAR(frame.to_source.dot(axis), frame_of(plain).to_source.z(), 1e-14);
  const Vec3 observer = frame.direction({0.0, 0.4 * kDegree});
  const PhotometerSetting again = setting_of({frame.to_source, observer}, axis);
  EXPECT_NEAR(again.v_deg, 7.0, 1e-10);
  EXPECT_NEAR(again.h_deg, -13.0, 1e-10);
  EXPECT_NEAR(again.rotation_deg, 25.0, 1e-9);
  EXPECT_NEAR(again.observation_deg.front(), 0.4, 1e-10);
}

// A plane that is inclined by the angle p above a plan of the area A has the area A / cos(p). The incident power is
// proportional to the projection of this area perpendicular to the light.
TEST(InclinedEntrance, IncidentPowerIsThatOfTheInclinedPlane) {
  const design::Design design =
      read(kCubes + surface("kind = \"plane\"\nincidence_deg = 50\npin_angle_deg = 30\nazimuth_deg = 0\n") + kThick);
  EXPECT_NEAR(design.incident_fraction(design.reference_axis()), std::cos(50.0 * kDegree) / std::cos(30.0 * kDegree),
              1e-14);
  EXPECT_EQ(design.incident_fraction(Vec3(0.99, 0.0, -0.1).normalized()), 0.0);
  EXPECT_EQ(read(kCubes + kThick).incident_fraction(Vec3(0.6, 0.0, 0.8)), 0.8);
}

TEST(InclinedEntrance, OnlyTheIdentityMapsTheReferenceAxisToItself) {
  const std::string text = kCubes + surface("kind = \"plane\"\nincidence_deg = 20\n") + kThick;
  EXPECT_EQ(design::light_symmetries(read(text), model_of(text)).size(), 1U);
}

}  // namespace
}  // namespace retrace::studies::inclined_entrance_test
