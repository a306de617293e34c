#include "geometry/io/facet_planes_reader.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "tests/support/refusals.h"

namespace retrace::studies::facet_planes_reader_test {
namespace {

geometry::PartSpec prisms(geometry::Arrangement arrangement = geometry::Arrangement::aligned) {
  geometry::PartSpec spec;
  spec.element = geometry::RtpElement{0.5, 0.5, 90.0};
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = spec.array.y_length_mm = 1.0;
  spec.thickness_mm = 1.0;
  return spec;
}

const std::string kHead = "# planes\nx_mm,y_mm,facet,height_mm,x_slope,y_slope\n";
const std::string kElement = "0.25,0.25,1,-0.25,-1,0.001\n0.25,0.25,2,-0.2500001,1.0002,0\n";

std::string refused(const std::string& text, geometry::Arrangement arrangement = geometry::Arrangement::aligned) {
  return refusal_of([&] { parse_facet_planes(text, "p.csv", prisms(arrangement)); }, "accepted");
}

TEST(FacetPlanesReader, ReadsWhatItWrites) {
  const geometry::FacetPlanes planes = parse_facet_planes(kHead + "\n" + kElement, "p.csv", prisms());
  ASSERT_EQ(planes.size(), 1U);
  const geometry::ElementPlanes& element = planes.elements()[0];
  EXPECT_EQ(element.centre_mm, geometry::Vec2(0.25, 0.25));
  EXPECT_EQ(element.planes[0].slope, geometry::Vec2(-1, 0.001));
  EXPECT_EQ(element.planes[1].height_mm, -0.2500001);
  EXPECT_EQ(facet_planes_text(planes), "x_mm,y_mm,facet,height_mm,x_slope,y_slope\n" + kElement);
}

TEST(FacetPlanesReader, TurnedElementsOnlyInACheckers) {
  const std::string rotated = kHead + "0.75,0.25,1,-0.25,0,-1\n0.75,0.25,2,-0.25,0,1\n";
  EXPECT_EQ(refused(rotated, geometry::Arrangement::checker), "accepted");
  EXPECT_EQ(refused(rotated), "p.csv:3: x_slope");
}

TEST(FacetPlanesReader, SaysWhereAndWhatIsAllowed) {
  expect_refusals([](const std::string& given) { return refused(given); },
                  {{"", "p.csv"},
                   {"x,y\n", "p.csv:1"},
                   {kHead + "1,2,3\n", "p.csv:3"},
                   {kHead + "1,2,3,4,5,6,7\n", "p.csv:3"},
                   {kHead + "0.25,0.25,1,-0.25,-1,wide\n", "p.csv:3: y_slope"},
                   {kHead + "nan,0.25,1,-0.25,-1,0\n", "p.csv:3: x_mm"},
                   {kHead + "0.25,0.25,3,-0.25,-1,0\n", "p.csv:3: facet"},
                   {kHead + "0.25,0.25,1,0.25,-1,0\n", "p.csv:3: height_mm"},
                   {kHead + "0.25,0.25,1,-0.25,1,0\n", "p.csv:3: x_slope"},
                   {kHead + "0.25,0.25,1,-0.25,-1,0\n", "p.csv:3"},
                   {kHead + "0.25,0.25,1,-0.25,-1,0\n0.25,0.25,1,-0.25,-1,0\n", "p.csv:4"},
                   {kHead + kElement + kElement, "p.csv"}});
}

geometry::PartSpec cubes(const geometry::Element& element) {
  geometry::PartSpec spec;
  spec.element = element;
  spec.array.arrangement = geometry::Arrangement::honeycomb;
  spec.array.x_length_mm = spec.array.y_length_mm = 4.0;
  spec.thickness_mm = 1.0;
  return spec;
}

std::string refused_cube(const std::string& text) {
  return refusal_of([&] { parse_facet_planes(text, "p.csv", cubes(geometry::HexagonalCube{1.0, {}})); }, "accepted");
}

TEST(FacetPlanesReader, CubeCornersHaveThreeFacetsAndFlares) {
  // The apex is at (2, 2), at a depth of 0.70711. From there, the facets rise towards the azimuths 60, 180 and 300
  // degrees. A flare is the part of a machined facet that extends into the area of a missing neighbour.
  const std::string cube = "2,2,1,-0.70711,0.7071,1.2247\n2,2,2,-0.70711,-1.41421,0\n2,2,3,-0.70711,0.7071,-1.2247\n";
  const std::string flare = "2.75,1.57,5,0.3536,0.7071,-1.2247\n";
  EXPECT_EQ(refused_cube(kHead + cube), "accepted");
  const geometry::FacetPlanes planes =
      parse_facet_planes(kHead + cube + flare, "p.csv", cubes(geometry::HexagonalCube{1.0, {}}));
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_EQ(planes.element_count(), 1U);
  EXPECT_TRUE(planes.elements()[1].flares[1].has_value());
  EXPECT_EQ(facet_planes_text(planes), "x_mm,y_mm,facet,height_mm,x_slope,y_slope\n" + cube + flare);
  expect_refusals([](const std::string& given) { return refused_cube(given); },
                  {{kHead + flare, "p.csv"},
                   {kHead + cube + flare + flare, "p.csv:7: facet"},
                   {kHead + "2,2,10,-0.70711,0,0\n", "p.csv:3: facet"},
                   {kHead + "2,2,1.5,-0.70711,0,0\n", "p.csv:3: facet"},
                   {kHead + "2,2,1,-0.70711,0.7071,1.2247\n", "p.csv:3"},
                   {kHead + "2,2,1,-0.70711,0.7071,1.2247\n2,2,4,0.3536,-1.41421,0\n", "p.csv:4"},
                   {kHead + "2,2,2,-0.70711,1.41421,0\n", "p.csv:3: x_slope"}});
}

TEST(FacetPlanesReader, CubeCornersMayHaveCaps) {
  const std::string cube = "2,2,1,-0.70711,0.7071,1.2247\n2,2,2,-0.70711,-1.41421,0\n2,2,3,-0.70711,0.7071,-1.2247\n";
  const std::string caps = "2,2,7,-0.5,-1,-1.7\n2,2,8,-0.5,2,0\n2,2,9,-0.5,-1,1.7\n";
  const geometry::FacetPlanes planes =
      parse_facet_planes(kHead + cube + caps, "p.csv", cubes(geometry::HexagonalCube{1.0, {}}));
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(facet_planes_text(planes), "x_mm,y_mm,facet,height_mm,x_slope,y_slope\n" + cube + caps);
  EXPECT_EQ(refused_cube(kHead + caps), "p.csv:3: facet");
  EXPECT_EQ(refused_cube(kHead + cube + "2,2,8,-0.5,2,0\n"), "p.csv:6: facet");
  EXPECT_EQ(refused_cube(kHead + cube + "2,2,7,0.5,-1,-1.7\n"), "p.csv:6: height_mm");
}

}  // namespace
}  // namespace retrace::studies::facet_planes_reader_test
