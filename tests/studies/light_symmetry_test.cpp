// Tests of the symmetries of designs with their light: properties that break the symmetry of a part, and agreement of
// the photometer with these symmetries.
#include "design/light_symmetry.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "materials/io/material_library.h"
#include "studies/photometry/photometer.h"
#include "tests/studies/photometric_requests.h"

namespace retrace::studies::light_symmetry_test {
namespace {

using namespace photometric_requests;

struct Changed {
  std::string name;
  std::function<void(design::Design&)> change;
  std::size_t maps;             ///< number of symmetries
  std::array<bool, 2> mirrors;  ///< reversals of x and y that are symmetries
};

TEST(LightSymmetry, OrientedPropertiesBreakTheSymmetryOfThePart) {
  const std::vector<Changed> all = {
      {"honeycomb", [](design::Design&) {}, 6, {false, true}},
      {"polarised along x", [](design::Design& d) { d.light.polarisation.q = 0.5; }, 2, {false, true}},
      {"obliquely polarised", [](design::Design& d) { d.light.polarisation.u = 0.5; }, 1, {false, false}},
      {"circularly polarised", [](design::Design& d) { d.light.polarisation.v = 0.5; }, 1, {false, false}},
      {"scratches of one azimuth",
       [](design::Design& d) { d.surface.entrance.scratch_azimuth_deg = 30.0; },
       1,
       {false, false}},
      {"height map", [](design::Design& d) { d.surface.texture = design::HeightMapTexture{}; }, 1, {false, false}},
      {"roughness",
       [](design::Design& d) {
         d.surface.texture = design::HarveyShackTexture{.roughness_sq_nm = 5.0, .correlation_length_um = 5.0};
       },
       6,
       {false, true}}};
  const design::Design design = design_of(honeycomb());
  const PhotometrySettings settings = request_of(points_at({0.2}, 1.0));
  for (const Changed& one : all) {
    design::Design changed = design;
    one.change(changed);
    design::Design readable = changed;  // the file of a height map does not exist
    if (std::holds_alternative<design::HeightMapTexture>(changed.surface.texture)) readable = design;
    const design::OpticalModel model = design::make_model(readable, materials::MaterialLibrary::shipped());
    EXPECT_EQ(design::light_symmetries(changed, model).size(), one.maps) << one.name;
    const bool is_model_of_change = one.name != "height map" && one.name != "scratches of one azimuth";
    if (is_model_of_change) {
      EXPECT_EQ(Photometer(changed, settings, 1).mirrors(), one.mirrors) << one.name;
    }
  }
}

}  // namespace
}  // namespace retrace::studies::light_symmetry_test
