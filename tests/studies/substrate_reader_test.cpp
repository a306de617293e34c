#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "design/io/design_json.h"
#include "design/io/design_reader.h"
#include "tests/support/refusals.h"

// Tests of the table [substrate]: allowed values, and errors at the key of a base that cannot carry the elements.

namespace retrace::studies::substrate_reader_test {
namespace {

std::string design(const std::string& element, const std::string& substrate) {
  return element + "x_length_mm = 6\ny_length_mm = 6\n[substrate]\n" + substrate + "\n[body]\nthickness_mm = 3\n";
}

const std::string kPrisms = "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\n";
const std::string kPins = "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2\n[array]\narrangement = \"pins\"\n";

design::Design read(const std::string& text) {
  return design::parse_design(text, "d.toml", {});
}

std::string complaint(const std::string& text) {
  return refusal_of([&] { read(text); }, "nothing");
}

TEST(SubstrateReader, ReadsEveryKind) {
  const geometry::Substrate plane =
      *read(design(kPrisms, "kind = \"plane\"\nincline_deg = 12\nazimuth_deg = -30")).part().substrate;
  EXPECT_EQ(std::get<geometry::PlaneSubstrate>(plane.shape).incline_deg, 12.0);
  EXPECT_EQ(std::get<geometry::PlaneSubstrate>(plane.shape).azimuth_deg, -30.0);
  EXPECT_EQ(plane.element_axes, geometry::ElementAxes::normal);
  const geometry::Substrate cylinder =
      *read(design(kPrisms, "kind = \"cylinder\"\nradius_mm = -20\naxis = \"x\"\nelement_axes = \"parallel\""))
           .part()
           .substrate;
  EXPECT_EQ(std::get<geometry::CylinderSubstrate>(cylinder.shape).radius_mm, -20.0);
  EXPECT_TRUE(std::get<geometry::CylinderSubstrate>(cylinder.shape).axis_is_x);
  EXPECT_EQ(cylinder.element_axes, geometry::ElementAxes::parallel);
  const geometry::Substrate sphere = *read(design(kPrisms, "kind = \"sphere\"\nradius_mm = 25")).part().substrate;
  EXPECT_EQ(std::get<geometry::SphereSubstrate>(sphere.shape).radius_mm, 25.0);
  const design::Design formula = read(design(kPrisms, "kind = \"formula\"\nsag_mm = \"-x^2 / 50\""));
  EXPECT_EQ(design::to_json(formula)["substrate"]["sag_mm"], "-x^2 / 50");
  EXPECT_EQ(design::to_json(formula)["substrate"]["element_axes"], "normal");
}

TEST(SubstrateReader, PinsShareOneAxis) {
  const design::Design pins = read(design(kPins, "kind = \"plane\"\nincline_deg = 10"));
  EXPECT_TRUE(pins.part().is_pin_bundle);
  EXPECT_EQ(pins.part().array.arrangement, geometry::Arrangement::honeycomb);
  EXPECT_EQ(pins.part().substrate->element_axes, geometry::ElementAxes::parallel);
  EXPECT_EQ(design::to_json(pins)["array"]["arrangement"], "pins");
  EXPECT_EQ(complaint(design(kPins, "kind = \"plane\"\nincline_deg = 10\nelement_axes = \"normal\"")),
            "d.toml:11: substrate.element_axes");
  EXPECT_FALSE(read(kPins + "x_length_mm = 6\ny_length_mm = 6\n[body]\nthickness_mm = 3\n").part().substrate);
}

struct Bad {
  std::string array;
  std::string substrate;
  std::string says;
};

TEST(SubstrateReader, SaysWhatIsWrongAndWhere) {
  const std::vector<Bad> bad = {
      {kPrisms, "incline_deg = 3", "d.toml:8: substrate.kind"},
      {kPrisms, "kind = \"cone\"", "d.toml:9: substrate.kind"},
      {kPrisms, "kind = \"plane\"", "d.toml:8: substrate.incline_deg"},
      {kPrisms, "kind = \"plane\"\nincline_deg = 75", "d.toml:10: substrate.incline_deg"},
      {kPrisms, "kind = \"plane\"\nincline_deg = 50", "d.toml:10: substrate.incline_deg"},
      {kPrisms, "kind = \"plane\"\nincline_deg = 5\nradius_mm = 9", "d.toml:11: substrate.radius_mm"},
      {kPrisms, "kind = \"sphere\"\nradius_mm = 0", "d.toml:10: substrate.radius_mm"},
      {kPrisms, "kind = \"sphere\"\nradius_mm = 5\naxis = \"x\"", "d.toml:11: substrate.axis"},
      {kPrisms, "kind = \"cylinder\"\nradius_mm = 0.6", "d.toml:10: substrate.radius_mm"},
      {kPrisms, "kind = \"sphere\"\nradius_mm = 3.5", "d.toml:10: substrate.radius_mm"},
      {kPrisms, "kind = \"formula\"", "d.toml:8: substrate.sag_mm"},
      {kPrisms, "kind = \"formula\"\nsag_mm = \"x +\"", "d.toml:10: substrate.sag_mm"},
      {kPrisms, "kind = \"formula\"\nsag_mm = \"log(x)\"", "d.toml:10: substrate.sag_mm"},
      {kPrisms, "kind = \"formula\"\nsag_mm = \"0.2*sin(9*x)\"", "d.toml:10: substrate.sag_mm"},
      {kPrisms, "kind = \"plane\"\nincline_deg = 5\nwidth = 1", "d.toml:11: substrate.width"},
      {kPrisms + "x_offset_mm = 1\n", "kind = \"plane\"\nincline_deg = 5", "d.toml:10: substrate.kind"},
      {kPins, "kind = \"plane\"\nincline_deg = 45", "d.toml:10: substrate.incline_deg"},
  };
  for (const Bad& b : bad) {
    const std::string said = complaint(design(b.array, b.substrate));
    EXPECT_EQ(said.substr(0, b.says.size()), b.says) << b.substrate;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
  const std::string endless =
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nextent = \"infinite\"\n"
      "[substrate]\nkind = \"plane\"\nincline_deg = 5\n[body]\nthickness_mm = 2\n";
  EXPECT_EQ(complaint(endless), "d.toml:8: substrate.kind");
}

TEST(SubstrateReader, RefusesWhatASubstrateCannotHave) {
  const std::string balls =
      "[element]\nkind = \"ball\"\ndiameter_mm = 1\n[substrate]\nkind = \"plane\"\nincline_deg = 5\n";
  EXPECT_EQ(complaint(balls).substr(0, 12), "d.toml:4: su") << complaint(balls);
  EXPECT_EQ(complaint(balls), "d.toml:4: substrate");
  const std::string rounded = design(kPrisms, "kind = \"sphere\"\nradius_mm = 30") + "[surface]\nrim_radius_um = 20\n";
  EXPECT_EQ(complaint(rounded), "d.toml:10: substrate.radius_mm");
  const design::Design inclined = read(design(kPrisms, "kind = \"plane\"\nincline_deg = 5"));
  EXPECT_THROW(design::require_supported(inclined, {.what = "x", .substrates = false}), InputError);
  EXPECT_NO_THROW(
      design::require_supported(read(kPrisms + "x_length_mm = 6\ny_length_mm = 6\n[body]\nthickness_mm = 3\n"),
                                {.what = "x", .substrates = false}));
}

}  // namespace
}  // namespace retrace::studies::substrate_reader_test
